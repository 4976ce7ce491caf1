// CF files: what is read does not depend on how it was written, and is what was written.

#include <glm/glm.hpp>

#include "accuracy_report.h"
#include "cf_twin.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/water/air.h"
#include "geo/geoid.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
namespace {

// All that a picture depends on, by place: extinction of the cell around (lat, lon), by layer.
std::vector<double> extinctions_at(const Forecast& f, const ForecastColumns& c,
                                   const HorizontalGrid& grid, double lat, double lon) {
  (void)f;
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i) {
      const glm::dvec2 here = grid.lat_lon_deg(i + 0.5, j + 0.5);
      if (std::abs(here.x - lat) < 1e-6 && std::abs(std::remainder(here.y - lon, 360)) < 1e-6) {
        const auto* at = &c.extinction_per_m[std::size_t(j * c.nx + i) * std::size_t(c.nz)];
        return {at, at + c.nz};
      }
    }
  ADD_FAILURE() << "no cell at " << lat << " " << lon;
  return std::vector<double>(std::size_t(c.nz), NAN);
}

// Largest difference over the largest value.
double difference(const CfTwin& base, const std::string& a_path, const std::string& b_path,
                  std::size_t time = 0) {
  const auto a = open(a_path), b = open(b_path);
  const ForecastColumns ca = a->columns(time), cb = b->columns(time);
  double worst = 0, largest = 0;
  for (const double lat : base.latitude)
    for (const double lon : base.longitude) {
      const auto ea = extinctions_at(*a, ca, *a->grid(time), lat, lon);
      const auto eb = extinctions_at(*b, cb, *b->grid(time), lat, lon);
      for (std::size_t k = 0; k < ea.size(); ++k) {
        worst = std::max(worst, std::abs(ea[k] - eb[k]));
        largest = std::max(largest, ea[k]);
        if (!std::isfinite(eb[k])) return INFINITY;
      }
    }
  EXPECT_GT(largest, 1e-3);
  EXPECT_EQ(ca.interface_m.size(), cb.interface_m.size());
  return worst / largest;
}

// The clouds of the twin by the formulas of water.h, written out again.
double expected_extinction(double q, double hPa) {
  const double density = hPa * 100 / (287.058 * CfTwin::temperature_K(hPa));
  const double content = q * density;
  const double radius =
      std::clamp(std::cbrt(3 * content / (4 * M_PI * 999.84 * 0.77 * 50.575e6)), 4e-6, 30e-6);
  const double efficiency = 2 + 2.12 * std::pow(2 * M_PI * radius / 550e-9, -2.0 / 3);
  return 3 * content * efficiency / (4 * 999.84 * radius);
}

TEST(Cf, ExtinctionIsTheFormulas) {
  CfTwin twin;
  const auto f = open(twin.write("formula"));
  ASSERT_EQ(f->times_s().size(), 2u);
  EXPECT_EQ(f->times_s()[1], 6 * 3600.0);
  EXPECT_EQ(f->time_origin_ns(), 1583020800000000000);  // 2020-03-01
  for (const std::size_t time : {0u, 1u}) {
    const ForecastColumns c = f->columns(time);
    for (const double lat : twin.latitude)
      for (const double lon : twin.longitude) {
        const auto e = extinctions_at(*f, c, *f->grid(time), lat, lon);
        for (std::size_t k = 0; k < 4; ++k) {
          const double hPa = twin.pressure_hPa[k];
          const double wanted =
              expected_extinction(CfTwin::water(lat, lon, hPa, twin.hours[time]), hPa);
          EXPECT_NEAR(e[k], wanted, 2e-5 * wanted) << lat << " " << lon << " " << hPa;
        }
      }
  }
}

// A forecast that is let go closes its file.
TEST(Cf, FilesAreClosed) {
  const auto descriptors = [] {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
      count += entry.exists();
    return count;
  };
  CfTwin twin;
  const std::string path = twin.write("closed");
  open(path);
  const std::size_t before = descriptors();
  for (int n = 0; n < 3; ++n) open(path);
  EXPECT_EQ(descriptors(), before);
}

TEST(Cf, LayersStandWhereTheirLevelsAre) {
  CfTwin twin;
  const auto f = open(twin.write("layers"));
  const ForecastColumns c = f->columns(0);
  const auto height = [](double hPa) {
    return height_of_geopotential_height_m(CfTwin::geopotential_height_m(hPa));
  };
  const double z0 = height(1000), z1 = height(900), z2 = height(700), z3 = height(500);
  const double wanted[] = {z0 - (z1 - z0) / 2, (z0 + z1) / 2, (z1 + z2) / 2, (z2 + z3) / 2,
                           z3 + (z3 - z2) / 2};
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(double(c.interface_m[std::size_t(k)]), wanted[k], 2e-3);
  EXPECT_NEAR(f->height_range_m().x, wanted[0], 2e-3);
  EXPECT_NEAR(f->height_range_m().y, wanted[4], 2e-3);
  EXPECT_NEAR(f->thinnest_layer_m(), wanted[1] - wanted[0], 0.006 * (wanted[1] - wanted[0]));
}

TEST(Cf, OrderAndDirectionOfAxesDoNotMatter) {
  const CfTwin base;
  const std::string path = base.write("order_base");
  for (const char* order : {"tyxz", "xyzt", "ztyx", "zxyt", "yxtz"}) {
    CfTwin twin;
    twin.order = order;
    EXPECT_EQ(difference(base, path, twin.write(std::string("order_") + order), 1), 0) << order;
  }
  CfTwin south = base;
  std::ranges::reverse(south.latitude);
  EXPECT_EQ(difference(base, path, south.write("descending")), 0);
  CfTwin top = base;
  std::ranges::reverse(top.pressure_hPa);
  EXPECT_EQ(difference(base, path, top.write("from_top")), 0);
  CfTwin west = base;
  for (double& lon : west.longitude) lon = lon > 180 ? lon - 360 : lon;
  EXPECT_EQ(difference(base, path, west.write("west")), 0);
}

TEST(Cf, UnitsAndPackingDoNotMatter) {
  const CfTwin base;
  const std::string path = base.write("units_base");
  struct Case {
    const char* units;
    double scale;
  };
  for (const Case& c : {Case{"g/kg", 1e3}, {"g kg**-1", 1e3}, {"kg kg**-1", 1}, {"1", 1}}) {
    CfTwin twin;
    twin.water_units = c.units;
    twin.water_scale = c.scale;
    EXPECT_LT(difference(base, path, twin.write("units")), 1e-6) << c.units;
  }
  CfTwin pascal = base;
  pascal.level_units = "Pa";
  pascal.level_scale = 100;
  EXPECT_LT(difference(base, path, pascal.write("pascal")), 1e-6);
  CfTwin millibars = base;
  millibars.level_units = "millibars";
  EXPECT_LT(difference(base, path, millibars.write("millibars")), 1e-6);
  CfTwin doubles = base;
  doubles.type = NC_DOUBLE;
  doubles.format = NC_64BIT_OFFSET;
  EXPECT_LT(difference(base, path, doubles.write("doubles")), 1e-6);
  CfTwin packed = base;
  packed.packed = true;
  const double rounding = difference(base, path, packed.write("packed"));
  EXPECT_LT(rounding, 5e-5);  // half of 1.2e-8 kg/kg in 3e-4
  EXPECT_GT(rounding, 0);
}

TEST(Cf, PackedZeroAndFillAreClear) {
  CfTwin twin;
  twin.packed = true;
  twin.fill = -32767 * 1.2e-8 + 3.7e-4 + 1e-19;  // packed: _FillValue
  const auto f = open(twin.write("packed_fill"));
  const ForecastColumns c = f->columns(0);
  for (int k = 0; k < c.nz; ++k) EXPECT_EQ(c.extinction_per_m[std::size_t(k)], 0.0f);
  for (const float e : c.extinction_per_m) EXPECT_TRUE(e >= 0 && std::isfinite(e));
  std::string facts;
  for (const auto& fact : f->facts()) facts += fact + "\n";
  EXPECT_NE(facts.find("4 of 120 water values are missing"), std::string::npos) << facts;
}

// One cell with cloud: its place by the grid, and the layer by its height.
TEST(Cf, OneCellStaysInItsPlace) {
  CfTwin twin;
  twin.latitude = {60, 40, 20, 0, -20};
  const auto f = open(twin.write("place"));
  const ForecastColumns c = f->columns(0);
  // Where the water is most: by the formula at 60 N, 200 E and 1000 hPa.
  std::size_t most = 0;
  for (std::size_t n = 0; n < c.extinction_per_m.size(); ++n)
    if (c.extinction_per_m[n] > c.extinction_per_m[most]) most = n;
  const std::size_t cell = most / std::size_t(c.nz), k = most % std::size_t(c.nz);
  const auto grid = f->grid(0);
  const glm::dvec2 place =
      grid->lat_lon_deg(double(int(cell) % c.nx) + 0.5, double(int(cell) / c.nx) + 0.5);
  EXPECT_NEAR(place.x, 60, 1e-9);
  EXPECT_NEAR(std::remainder(place.y - 200, 360.0), 0, 1e-9);
  const float* z = &c.interface_m[cell * (std::size_t(c.nz) + 1) + k];
  const double level = height_of_geopotential_height_m(CfTwin::geopotential_height_m(1000));
  EXPECT_LT(double(z[0]), level);
  EXPECT_GT(double(z[1]), level);
}

TEST(Cf, GlobeGoesAround) {
  CfTwin twin;
  twin.latitude = {90, 45, 0, -45, -90};
  twin.longitude = {0, 60, 120, 180, 240, 300};
  auto f = open(twin.write("globe"));
  EXPECT_TRUE(f->grid(0)->around());
  EXPECT_EQ(f->grid(0)->lat_lon_deg(0, 0).x, 90);  // the polar row is half a row
  EXPECT_EQ(f->grid(0)->lat_lon_deg(0, 1).x, 67.5);
  EXPECT_EQ(f->grid(0)->lat_lon_deg(0, 5).x, -90);
  const ForecastColumns columns = f->columns(0);
  twin.longitude.push_back(360);  // a repeated column is left out
  f = open(twin.write("repeated"));
  EXPECT_TRUE(f->grid(0)->around());
  EXPECT_EQ(f->grid(0)->nx(), 6);
  EXPECT_EQ(f->columns(0).extinction_per_m, columns.extinction_per_m);
  twin.longitude = {0, 60, 120, 180, 240, 295};  // nearly
  EXPECT_FALSE(open(twin.write("gap"))->grid(0)->around());
  twin.latitude = {84, 42, 0, -42, -84};  // Gaussian rows do not touch the poles
  twin.longitude = {0, 60, 120, 180, 240, 300};
  EXPECT_EQ(open(twin.write("gaussian"))->grid(0)->lat_lon_deg(0, 0).x, 90);
}

// A file with levels in metres, 2-D coordinates and water per volume.
std::string write_heights(const std::string& name, const std::vector<double>& levels,
                          const std::string& coordinates, double lat_shift = 0) {
  const std::string path = folder() / (name + ".nc");
  NcWriter nc(path);
  nc.dimension("z", levels.size());
  nc.dimension("y", 3);
  nc.dimension("x", 4);
  nc.variable("z", NC_FLOAT, {"z"}, levels,
              {{"units", "m"}, {"axis", "Z"}, {"standard_name", "altitude"}});
  if (coordinates == "fields") {
    std::vector<double> lat, lon;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        lat.push_back(50 + 0.1 * j + lat_shift);
        lon.push_back(179.9 + 0.1 * i > 180 ? 179.9 + 0.1 * i - 360 : 179.9 + 0.1 * i);
      }
    nc.variable("lat", NC_DOUBLE, {"y", "x"}, lat, {{"units", "degrees_north"}});
    nc.variable("lon", NC_DOUBLE, {"y", "x"}, lon, {{"units", "degrees_east"}});
  } else if (coordinates == "metres") {
    nc.variable("y", NC_DOUBLE, {"y"}, {0, 0.1, 0.2}, {{"units", "km"}});
    nc.variable("x", NC_DOUBLE, {"x"}, {0, 100, 200, 300}, {{"units", "m"}});
  }
  std::vector<double> water(levels.size() * 12, 0.0);
  for (std::size_t n = 0; n < 12; ++n) water[n] = 0.5;
  nc.variable("lwc", NC_FLOAT, {"z", "y", "x"}, water,
              {{"units", "g m-3"}, {"coordinates", "lat lon"}});
  return path;
}

TEST(Cf, HeightsAndTwoDimensionalCoordinates) {
  const auto f = open(write_heights("fields", {100, 300, 700}, "fields"));
  const ForecastColumns c = f->columns(0);
  EXPECT_EQ(c.interface_m[0], 0.0f);  // not below the sea
  EXPECT_EQ(c.interface_m[1], 200.0f);
  EXPECT_EQ(c.interface_m[3], 900.0f);
  // 0.5 g/m3: the radius over the sea is that of its content, 2 % of 157 m2/kg per 10 um.
  const double radius = std::cbrt(3 * 5e-4 / (4 * M_PI * 999.84 * 0.77 * 50.575e6));
  EXPECT_NEAR(double(c.extinction_per_m[0]), 5e-4 * 0.157 * 1e3 * 10e-6 / radius,
              0.02 * double(c.extinction_per_m[0]));
  const auto grid = f->grid(0);
  const glm::dvec2 a = grid->lat_lon_deg(0, 0), b = grid->lat_lon_deg(4, 3);
  EXPECT_NEAR(a.x, 49.95, 1e-4);
  EXPECT_NEAR(a.y, 179.85, 1e-4);
  EXPECT_NEAR(b.x, 50.25, 1e-4);
  EXPECT_NEAR(b.y, 180.25, 1e-4);  // continuous across the antimeridian
}

TEST(Cf, MetresWithoutAPlaceAreSaid) {
  const auto f = open(write_heights("metres", {100, 300, 700}, "metres"));
  const glm::dvec2 a = f->grid(0)->lat_lon_deg(0, 0), b = f->grid(0)->lat_lon_deg(4, 3);
  EXPECT_NEAR((b.y - a.y) * M_PI / 180 * 6378137, 400, 0.01);
  EXPECT_NEAR((b.x - a.x) * M_PI / 180 * 6335439, 300, 0.01);
  bool said = false;
  for (const auto& text : f->assumptions()) said = said || text.find("0 N 0 E") < text.size();
  EXPECT_TRUE(said);
}

// Hypsometric heights in the US Standard Atmosphere 1976 on the 26 levels of GFS, against its
// published geopotential heights (5574.4 and 31055 m), both made geometric.
TEST(Cf, HydrostaticHeightsInTheStandardAtmosphere) {
  const std::vector<double> hPa = {1000, 975, 950, 925, 900, 850, 800, 750, 700, 650, 600, 550, 500,
                                   450,  400, 350, 300, 250, 200, 150, 100, 70,  50,  30,  20,  10};
  std::vector<double> p, t, z(hPa.size());
  for (const double level : hPa) {
    p.push_back(level * 100);
    t.push_back(standard_temperature_K(standard_geopotential_height_m(level * 100)));
  }
  hypsometric_heights_m(p, t, kStandardSurfacePressure_Pa, 0, z);
  const auto error = [&](std::size_t k, double published_m) {
    return std::abs(height_of_geopotential_height_m(z[k]) -
                    height_of_geopotential_height_m(published_m));
  };
  const double at_500 = error(12, 5574.4), at_10 = error(25, 31055);
  report_accuracy("netcdf", "hydrostatic height at 500 hPa, standard atmosphere", at_500, 1, "m");
  report_accuracy("netcdf", "hydrostatic height at 10 hPa, standard atmosphere", at_10, 10, "m");
  EXPECT_LT(at_500, 1);
  EXPECT_LT(at_10, 10);
}

// The corner of a map, half a cell beyond the outermost centre, against the map itself.
TEST(Grid, CornersOfPointsAreTheMaps) {
  constexpr double kRadius = 6370000, kStep = 10000;
  std::vector<double> lat, lon;
  const auto latitude = [&](double j) {
    return (2 * std::atan(std::exp((4e6 + j * kStep) / kRadius)) - M_PI / 2) * 180 / M_PI;
  };
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 30; ++i) {
      lat.push_back(latitude(j));
      lon.push_back(170 + i * kStep / kRadius * 180 / M_PI);
    }
  const auto grid = points_grid(30, 20, lat, lon, "test");
  double worst_m = 0;
  for (const double j : {0.0, 20.0})
    for (const double i : {0.0, 30.0}) {
      const glm::dvec2 place = grid->lat_lon_deg(i, j);
      worst_m = std::max(worst_m, std::abs(place.x - latitude(j - 0.5)) * 111195);
      const double wanted = 170 + (i - 0.5) * kStep / kRadius * 180 / M_PI;
      worst_m = std::max(worst_m, std::abs(place.y - wanted) * 111195 * std::cos(place.x / 57.3));
    }
  report_accuracy("netcdf", "corner of a 10 km Mercator grid from its centres", worst_m, 20, "m");
  EXPECT_LT(worst_m, 20);
}

#ifdef NEPHO_HAS_PROJ

// With `geoid` egm96 layers and ground stand as much higher as the sea does.
TEST(Cf, HeightsStandOnTheGeoid) {
  const GeoidHeight geoid = egm96_m();
  OpenRequest request;
  request.files = {CfTwin().write("geoid")};
  const auto plain = netcdf::open_netcdf(request);
  request.geoid = true;
  const auto shifted = netcdf::open_netcdf(request);
  for (const std::size_t time : {0u, 1u}) {
    const ForecastColumns a = plain->columns(time), b = shifted->columns(time);
    double worst = 0, largest = 0;
    for (std::size_t n = 0; n < a.interface_m.size(); ++n) {
      const auto cell = int(n / std::size_t(a.nz + 1));
      const double sea_m =
          geoid(plain->grid(time)->lat_lon_deg(cell % a.nx + 0.5, cell / a.nx + 0.5));
      largest = std::max(largest, std::abs(sea_m));
      worst =
          std::max(worst, std::abs(double(b.interface_m[n]) - double(a.interface_m[n]) - sea_m));
    }
    EXPECT_GT(largest, 20);
    EXPECT_LT(worst, 0.01);
    EXPECT_EQ(a.extinction_per_m, b.extinction_per_m);
  }
  const glm::dvec2 range = shifted->height_range_m();
  const ForecastColumns last = shifted->columns(1);
  for (const float z : last.interface_m) {
    EXPECT_GE(z, range.x - 0.01);
    EXPECT_LE(z, range.y + 0.01);
  }
}

#endif

}  // namespace
}  // namespace nepho::forecast::test
