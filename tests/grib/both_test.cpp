// NetCDF and GRIB together: domains of two formats, and triangles whose places another file has.

#include <gtest/gtest.h>

#include "../netcdf/cf_twin.h"
#include "../netcdf/nests.h"
#include "accuracy_report.h"
#include "grib_twin.h"
#include "sources/forecast/open_both.h"

namespace nepho::grib::test {
namespace {

using forecast::test::CfTwin;
using forecast::test::NcWriter;

std::shared_ptr<const forecast::Forecast> open_files(const std::vector<std::string>& files,
                                                     const std::string& grid = "") {
  forecast::OpenRequest request;
  request.files = files;
  request.grid_file = grid;
  return open_both(request);
}

std::vector<double> axis(double first, double last, double step) {
  std::vector<double> values;
  for (double value = first; value < last + 1e-9; value += step) values.push_back(value);
  return values;
}

TEST(Both, DomainsOfBothFormatsNest) {
  CfTwin coarse;
  GribTwin fine, finest;
  fine.latitude = axis(-8, 22, 3);
  fine.longitude = axis(128, 161, 3);
  finest.latitude = axis(-1, 9, 1);
  finest.longitude = axis(140, 149, 1);
  const auto nests =
      open_files({finest.write("finest.grib2"), coarse.write("coarse"), fine.write("fine.grib2")});
  nepho::test::Together together(nests);
  ASSERT_EQ(together.grids.size(), 3u);
  EXPECT_EQ(together.grids[0]->nx(), 10);
  EXPECT_EQ(together.grids[1]->nx(), 12);
  EXPECT_EQ(together.grids[2]->nx(), 6);
  together.points = 120;  // walls of all run along meridians
  const double drift = std::abs(together.all().total() / together.files_total() - 1);
  nepho::test::report_accuracy("Forecasts in GRIB",
                               "optical depth of NetCDF and GRIB nested, bricks against files",
                               drift, 2e-3, "1");
  EXPECT_LT(drift, 2e-3);
}

// Two triangles for each square of 2 degrees, from 10 N 20 E on.
struct Triangles {
  static constexpr int kSquares = 6;
  std::vector<double> lat, lon, lat_corners, lon_corners;
  Triangles() {
    for (int n = 0; n < 2 * kSquares * kSquares; ++n) {
      const double south = 10 + 2 * (n / 2 / kSquares), west = 20 + 2 * (n / 2 % kSquares);
      const double y[2][3] = {{0, 0, 2}, {0, 2, 2}}, x[2][3] = {{0, 2, 2}, {0, 2, 0}};
      double middle[2] = {};
      for (int c = 0; c < 3; ++c) {
        lat_corners.push_back((south + y[n % 2][c]) * M_PI / 180);
        lon_corners.push_back((west + x[n % 2][c]) * M_PI / 180);
        middle[0] += lat_corners.back() / 3;
        middle[1] += lon_corners.back() / 3;
      }
      lat.push_back(middle[0]);
      lon.push_back(middle[1]);
    }
  }
  // As ICON's grid files have it.
  std::string write_grid(bool corners = true) const {
    const std::string path = forecast::test::folder() / (corners ? "grid.nc" : "centres.nc");
    NcWriter nc(path);
    nc.dimension("cell", lat.size());
    nc.dimension("nv", 3);
    using forecast::test::Attributes;
    const auto put = [&](const std::string& name, const std::vector<double>& middle,
                         const std::vector<double>& edges) {
      Attributes a = {{"units", std::string("radian")}};
      if (corners) a["bounds"] = name + "_vertices";
      nc.variable(name, NC_DOUBLE, {"cell"}, middle, a);
      if (corners)
        nc.variable(name + "_vertices", NC_DOUBLE, {"cell", "nv"}, edges,
                    {{"units", std::string("radian")}});
    };
    put("clat", lat, lat_corners);
    put("clon", lon, lon_corners);
    return path;
  }
  std::string write_grib(int wet) const {
    std::string bytes;
    for (const double hPa : {900.0, 800.0, 700.0})
      for (const char* name : {"clwmr", "t", "gh"}) {
        Made made(2, {{"gridType", "unstructured_grid"}, {"numberOfDataPoints", long(lat.size())}});
        made.set(parameter(2, name)).set(isobaric(2, hPa)).set(at_hour(2, 0));
        made.set({{"bitsPerValue", 16}});
        std::vector<double> values(lat.size(), name[0] == 't' ? GribTwin::temperature_K(hPa)
                                               : name[0] == 'g'
                                                   ? GribTwin::geopotential_height_m(hPa)
                                                   : 0);
        if (name[0] == 'c') values[std::size_t(wet)] = 1e-3;
        bytes += made.values(values).bytes();
      }
    return write_bytes("triangles.grib2", bytes);
  }
};

TEST(Both, TrianglesStandWhereTheGridFileSays) {
  const Triangles triangles;
  const int wet = 31;
  const auto f = open_files({triangles.write_grib(wet)}, triangles.write_grid());
  const auto grid = f->grid(0);
  ASSERT_TRUE(grid->polygons());
  const forecast::ForecastColumns c = f->columns(0);
  ASSERT_EQ(c.nx, int(triangles.lat.size()));
  double worst = 0;
  for (int n = 0; n < c.nx; ++n) {
    double depth = 0;
    for (int k = 0; k < c.nz; ++k) depth += double(c.extinction_per_m[std::size_t(n * c.nz + k)]);
    EXPECT_EQ(depth > 0, n == wet) << n;
    for (int corner = 0; corner < 3; ++corner) {
      const auto at = std::size_t(3 * n + corner);
      const glm::dvec2 place =
          grid->polygons()
              ->corner_deg[grid->polygons()->first[std::size_t(n)] + std::uint32_t(corner)];
      worst = std::max({worst, std::abs(place.x - triangles.lat_corners[at] * 180 / M_PI),
                        std::abs(place.y - triangles.lon_corners[at] * 180 / M_PI)});
    }
  }
  EXPECT_LT(worst, 1e-10);
}

}  // namespace
}  // namespace nepho::grib::test
