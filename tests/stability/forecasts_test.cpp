// Stiff cases of forecasts: each computes its naive form beside the project's.
#include <cmath>
#include <limits>

#include "expect_stable.h"
#include "forecast/files/file_time.h"
#include "forecast/water/condensate.h"
#include "forecast/water/level_heights.h"
#include "forecast/water/water.h"
#include "geo/map_projection.h"
#include "made_source.h"
#include "nc_writer.h"
#include "remapped.h"
#include "sources/netcdf/nc_file.h"

namespace nepho::forecast::test {
using nepho::test::expect_stable;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Fills, values outside of their range and NaN, one in a thousand each, in every kind of packing.
TEST(Forecasts, MissingValuesNeverComeThrough) {
  constexpr std::size_t n = 20000;
  struct Kind {
    const char* name;
    int type;
    double missing;
    Attributes attributes;
    double scale, offset;
  };
  const std::vector<Kind> kinds = {
      {"packed",
       NC_SHORT,
       -32767,
       {{"_FillValue", -32767.0}, {"scale_factor", 0.5}, {"add_offset", 10.0}},
       0.5,
       10},
      {"missing", NC_FLOAT, -9999, {{"missing_value", -9999.0}}, 1, 0},
      {"default", NC_FLOAT, double(NC_FILL_FLOAT), {}, 1, 0},
      {"ranged", NC_SHORT, 9000, {{"valid_max", 5000.0}, {"scale_factor", 1e-6}}, 1e-6, 0},
      {"not_finite", NC_FLOAT, NAN, {}, 1, 0}};
  const std::string path = folder() / "missing.nc";
  std::vector<double> values(n);
  {
    NcWriter nc(path);
    nc.dimension("n", n);
    for (const Kind& kind : kinds) {
      for (std::size_t i = 0; i < n; ++i) values[i] = i % 1000 == 7 ? kind.missing : double(i % 50);
      nc.variable(kind.name, kind.type, {"n"}, values, kind.attributes);
    }
  }
  const netcdf::NcFile file(path, {});
  std::size_t wrong = 0, naive = 0, injected = 0;
  for (const Kind& kind : kinds) {
    const std::vector<double> read = file.read_all(*file.find(kind.name));
    for (std::size_t i = 0; i < n; ++i) {
      const bool lost = i % 1000 == 7;
      injected += lost;
      const double wanted = double(i % 50) * kind.scale + kind.offset;
      wrong += lost ? !std::isnan(read[i]) : !(std::abs(read[i] - wanted) < 1e-9);
      // Unpacked first, then compared with the fill of the file.
      const double unpacked = kind.missing * kind.scale + kind.offset;
      naive += lost && !(unpacked == kind.missing && std::abs(kind.missing) < 1e30);
    }
  }
  EXPECT_EQ(injected, 100u);
  expect_stable("25", double(wrong), 0, double(naive), "of 100 missing values come through");
}

// Water of cells that are half, a tenth and hardly cloudy: the column holds what the file says.
TEST(Forecasts, CloudFractionKeepsTheWaterPath) {
  constexpr int nz = 5;
  constexpr double content = 2e-4, layer_m = 300;
  FileVariable variable;
  variable.name = "clw";
  double worst = 0, naive = 0;
  for (const float fraction : {1.0f, 0.5f, 0.1f, 1e-3f, 1e-6f, 0.0f}) {
    WaterVariable water;
    water.variable = &variable;
    water.species = Species::kCloudWater;
    water.basis = Basis::kVolume;
    ForecastColumns columns;
    columns.nx = columns.ny = 1;
    columns.nz = nz;
    for (int k = 0; k <= nz; ++k) columns.interface_m.push_back(float(layer_m * k));
    columns.extinction_per_m.assign(nz, 0.0f);
    Air air;
    air.level_pressure_Pa.assign(nz, 9e4);
    air.temperature_K.assign(nz, 280.0f);
    CloudSetting setting;
    setting.fraction.assign(nz, fraction);
    std::vector<float> path(1, 0.0f);
    WaterStatistics statistics;
    const std::vector<float> values(nz, float(content));
    add_water(water, values, air, setting, columns, {path, path}, statistics);
    worst = std::max(worst, std::abs(double(path[0]) / (content * layer_m * nz) - 1));
    for (const float k : columns.extinction_per_m) EXPECT_TRUE(std::isfinite(k) && k > 0);
    // The cloud's own water taken for the cell's.
    const double in_cloud = content / double(fraction);
    naive = std::isfinite(in_cloud) ? std::max(naive, std::abs(in_cloud / content - 1)) : kInfinity;
  }
  expect_stable("27", worst, 1e-6, naive, "of the water path");
}

// Columns over steep ground whose levels cross.
TEST(Forecasts, CrossingLevelsRise) {
  constexpr std::size_t columns = 500, nz = 40;
  std::vector<float> interfaces;
  std::size_t naive = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<double> level(nz);
    for (std::size_t k = 0; k < nz; ++k)
      level[k] = 100.0 * double(k) + 80 * std::sin(double(c + 7 * k));
    if (c % 50 == 3) level[5] = NAN;
    std::vector<float> made(nz + 1);
    interfaces_of_levels_m(level, 0, made);
    for (std::size_t k = 0; k < nz; ++k) naive += !(made[k + 1] > made[k]);
    interfaces.insert(interfaces.end(), made.begin(), made.end());
  }
  const std::size_t lifted = make_rising(interfaces, nz + 1);
  std::size_t negative = 0;
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t k = 0; k < nz; ++k)
      negative += !(interfaces[c * (nz + 1) + k + 1] > interfaces[c * (nz + 1) + k]);
  EXPECT_GT(lifted, 0u);
  const double layers = columns * nz;
  expect_stable("29", double(negative) / layers, 0, double(naive) / layers,
                "of the layers have no positive thickness");
}

// One column, one row, one layer of a model: its optical depth arrives.
TEST(Forecasts, SmallestGrids) {
  using nepho::test::RotatedGrid;
  double worst = 0, naive = 0;
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(12, 1), glm::ivec2(1, 9)}) {
    auto forecast = nepho::test::synthetic_forecast("layer");
    forecast->cells = std::make_shared<RotatedGrid>(size.x, size.y, glm::dvec2(-20, 44), 30, 1);
    forecast->nz = 1;
    forecast->level_m = [](double t) { return 800 * t; };
    forecast->extinction_per_m = [](glm::dvec2, double, double) { return 2e-3; };
    const nepho::test::Remapped remapped(forecast);
    worst = std::max(worst, std::abs(remapped.total() / nepho::test::file_total(remapped) - 1));
    // Spacing from the ends of a grid of values: of one there is none.
    for (const int count : {size.x, size.y, forecast->nz})
      naive = std::max(naive, std::abs(double(count) / (count - 1) - 1));
  }
  expect_stable("31", worst, 1e-4, naive, "of the optical depth");
}

TEST(Forecasts, TimesKeepTheirSeconds) {
  constexpr std::size_t n = 200;
  std::vector<double> hours(n);
  for (std::size_t i = 0; i < n; ++i) hours[i] = 973356 + double(i) / 60;  // minutes of 2011
  const std::string path = folder() / "times.nc";
  {
    NcWriter nc(path);
    nc.dimension("time", n);
    nc.variable("time", NC_DOUBLE, {"time"}, hours,
                {{"units", std::string("hours since 1900-01-01 00:00:00.0")}});
  }
  const netcdf::NcFile file(path, {});
  const std::vector<std::int64_t> found = read_times(file, *file.find("time")).utc_ns;
  const std::int64_t first = *parse_date_ns("2011-01-15 12:00:00");
  double worst = 0, naive = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double wanted_s = 60.0 * double(i);
    worst = std::max(worst, std::abs(double(found[i] - first) * 1e-9 - wanted_s));
    naive = std::max(naive, std::abs(double(float(hours[i]) - float(hours[0])) * 3600 - wanted_s));
  }
  expect_stable("45", worst, 1e-3, naive, "s");
}

// Corners of a map of 3000 km, against Snyder's (1987) inverse of the conical map of a sphere.
TEST(Forecasts, MapsHaveTheirPlaces) {
  constexpr double kDegree = std::numbers::pi / 180, kSphere_m = 6370000;
  MapSpec spec;
  spec.true_latitude1_deg = 30;
  spec.true_latitude2_deg = 60;
  spec.central_longitude_deg = -97;
  spec.origin_latitude_deg = 40;
  const MapProjection map(spec);
  const auto tan_half = [](double lat) { return std::tan((45 + lat / 2) * kDegree); };
  const double n = std::log(std::cos(30 * kDegree) / std::cos(60 * kDegree)) /
                   std::log(tan_half(60) / tan_half(30));
  const double f = std::cos(30 * kDegree) * std::pow(tan_half(30), n) / n;
  const double rho0 = kSphere_m * f / std::pow(tan_half(40), n);
  double worst = 0, naive = 0;
  for (const double x : {-1.5e6, 0.0, 1.5e6})
    for (const double y : {-1.5e6, 1.5e6}) {
      const double rho = std::hypot(x, rho0 - y), theta = std::atan2(x, rho0 - y);
      const glm::dvec2 exact(2 * std::atan(std::pow(kSphere_m * f / rho, 1 / n)) / kDegree - 90,
                             -97 + theta / n / kDegree);
      worst = std::max(worst, glm::length(map.lat_lon_deg({x, y}) - exact));
      const double lat = 40 + y / kSphere_m / kDegree;
      const glm::dvec2 flat(lat, -97 + x / (kSphere_m * std::cos(40 * kDegree)) / kDegree);
      naive = std::max(naive, glm::length(flat - exact));
    }
  expect_stable("48", worst, 1e-3, naive, "deg");
}

// No water, no drops, no number of drops: a radius all the same, and finite extinction.
TEST(Forecasts, RadiiAreNeverZero) {
  int bad = 0, naive = 0, asked = 0;
  for (const double content : {0.0, 1e-30, 1e-12, 1e-4, 1e-2})
    for (const double number : {0.0, 1e3, 1e8, 1e12}) {
      const double radius = droplet_radius_m(content, {number, 0.77});
      const double per_kg = droplet_extinction_m2_per_kg(radius);
      bad += !(radius >= 4e-6 && radius <= 30e-6 && std::isfinite(per_kg) && per_kg > 0);
      const double usual = std::cbrt(3 * content / (4 * std::numbers::pi * 1000 * 0.77 * number));
      naive += !std::isfinite(3 / (2 * 1000 * usual));
      ++asked;
    }
  expect_stable("49", double(bad) / asked, 0, double(naive) / asked, "of the radii");
}

}  // namespace
}  // namespace nepho::forecast::test
