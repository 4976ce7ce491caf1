#pragma once

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace nepho::gdal::test {

// A GeoTIFF written with GDAL, without the reader's tables and transforms.

struct MadeBand {
  std::string name, unit;
  std::vector<double> values;  // as stored, [line * nx + column]
  std::optional<double> nodata, scale, offset;
};

struct MadeRaster {
  int nx = 40, ny = 30;
  std::array<double, 6> transform{10, 0.1, 0, 50, 0, -0.1};
  std::string system = "EPSG:4326";  // what OGRSpatialReference::SetFromUserInput reads; "": none
  GDALDataType type = GDT_Float32;
  std::vector<MadeBand> bands;
  int control_points = 0;  // instead of the transform

  std::vector<double> constant(double value) const {
    return std::vector<double>(std::size_t(nx) * std::size_t(ny), value);
  }
  std::vector<double> planted(int i, int j, double value, double otherwise = 0) const {
    std::vector<double> values = constant(otherwise);
    values[std::size_t(j) * std::size_t(nx) + std::size_t(i)] = value;
    return values;
  }
  // By OGR: latitude and longitude (deg) of a place in pixels.
  std::array<double, 2> lat_lon_deg(double x, double y) const {
    static std::map<std::string, std::unique_ptr<OGRCoordinateTransformation>> ways;
    std::unique_ptr<OGRCoordinateTransformation>& way = ways[system];
    if (!way) {
      OGRSpatialReference from, to;
      from.SetFromUserInput(system.c_str());
      from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      if (from.IsGeographic()) return {on(3, x, y), on(0, x, y)};
      to.CopyGeogCSFrom(&from);
      to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      way.reset(OGRCreateCoordinateTransformation(&from, &to));
    }
    double east = on(0, x, y), north = on(3, x, y);
    EXPECT_TRUE(way && way->Transform(1, &east, &north)) << system;
    return {north, east};
  }
  void write(const std::string& path) const;

 private:
  double on(std::size_t row, double x, double y) const {
    return transform[row] + transform[row + 1] * x + transform[row + 2] * y;
  }
};

inline void MadeRaster::write(const std::string& path) const {
  GDALRegister_GTiff();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> data(
      driver->Create(path.c_str(), nx, ny, int(bands.size()), type, nullptr));
  OGRSpatialReference from;
  if (!system.empty()) from.SetFromUserInput(system.c_str());
  if (control_points > 0) {
    std::vector<GDAL_GCP> points(static_cast<std::size_t>(control_points));
    GDALInitGCPs(control_points, points.data());
    for (int n = 0; n < control_points; ++n) {
      points[std::size_t(n)].dfGCPPixel = n % 2 * nx;
      points[std::size_t(n)].dfGCPLine = n / 2 * ny;
      points[std::size_t(n)].dfGCPX = 10 + n % 2;
      points[std::size_t(n)].dfGCPY = 50 - n / 2;
    }
    data->SetGCPs(control_points, points.data(), &from);
    GDALDeinitGCPs(control_points, points.data());
  } else {
    std::array<double, 6> copy = transform;
    data->SetGeoTransform(copy.data());
    if (!system.empty()) data->SetSpatialRef(&from);
  }
  for (std::size_t n = 0; n < bands.size(); ++n) {
    GDALRasterBand* band = data->GetRasterBand(int(n) + 1);
    const MadeBand& of = bands[n];
    if (!of.name.empty()) band->SetDescription(of.name.c_str());
    if (!of.unit.empty()) band->SetUnitType(of.unit.c_str());
    if (of.nodata) band->SetNoDataValue(*of.nodata);
    if (of.scale) band->SetScale(*of.scale);
    if (of.offset) band->SetOffset(*of.offset);
    std::vector<double> values = of.values;
    EXPECT_EQ(
        band->RasterIO(GF_Write, 0, 0, nx, ny, values.data(), nx, ny, GDT_Float64, 0, 0, nullptr),
        CE_None);
  }
}

}  // namespace nepho::gdal::test
