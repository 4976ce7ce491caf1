// Heights of pressures against the US Standard Atmosphere 1976 in closed form, from the ground to
// 5 hPa; and what is refused for want of heights, with its cure.

#include <cmath>

#include "accuracy_report.h"
#include "nc_writer.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
namespace {

constexpr std::size_t kCells = 4;  // 2 x 2

// Seven layers: base (geopotential m), temperature there (K), lapse (K/m); written out again.
struct Layer {
  double base_m, base_K, lapse;
};
constexpr Layer kLayers[] = {{0, 288.15, -6.5e-3},    {11000, 216.65, 0}, {20000, 216.65, 1e-3},
                             {32000, 228.65, 2.8e-3}, {47000, 270.65, 0}, {51000, 270.65, -2.8e-3},
                             {71000, 214.65, -2e-3}};
constexpr double kGravityOverGas = 9.80665 / 287.058;

struct Standard {
  double height_m, temperature_K;  // geometric
};
Standard standard(double p_Pa) {
  double base_Pa = 101325;
  for (std::size_t n = 0;; ++n) {
    const Layer& layer = kLayers[n];
    const double r = layer.lapse == 0 ? 0 : -kGravityOverGas / layer.lapse;
    const double rise = layer.lapse == 0
                            ? std::log(base_Pa / p_Pa) * layer.base_K / kGravityOverGas
                            : layer.base_K / layer.lapse * (std::pow(p_Pa / base_Pa, 1 / r) - 1);
    if (n == 6 || layer.base_m + rise <= kLayers[n + 1].base_m) {
      const double h = layer.base_m + rise;
      return {6356766 * h / (6356766 - h), layer.base_K + layer.lapse * rise};
    }
    const double step = kLayers[n + 1].base_m - layer.base_m;
    base_Pa *= layer.lapse == 0 ? std::exp(-step * kGravityOverGas / layer.base_K)
                                : std::pow(1 + layer.lapse * step / layer.base_K, r);
  }
}

void add_grid(NcWriter& nc, std::size_t levels) {
  nc.dimension("lev", levels);
  nc.dimension("lat", 2);
  nc.dimension("lon", 2);
  nc.variable("lat", NC_DOUBLE, {"lat"}, {10, 10.1}, {{"units", "degrees_north"}});
  nc.variable("lon", NC_DOUBLE, {"lon"}, {10, 10.1}, {{"units", "degrees_east"}});
}
void add_field(NcWriter& nc, const char* name, const std::vector<double>& of_level,
               const Attributes& attributes) {
  std::vector<double> all;
  for (const double value : of_level) all.insert(all.end(), kCells, value);
  nc.variable(name, NC_DOUBLE, {"lev", "lat", "lon"}, all, attributes);
}
void add_water(NcWriter& nc, std::size_t levels) {
  add_field(nc, "clw", std::vector<double>(levels, 1e-6), {{"units", "kg kg-1"}});
}

// 90 layers of a hybrid coordinate, from the top down, as ECMWF writes them: no formula_terms.
std::string hybrid_file(bool with_surface) {
  constexpr std::size_t kLayersInAll = 90;
  const std::string path = folder() / (with_surface ? "hybrid.nc" : "hybrid_bare.nc");
  NcWriter nc(path);
  add_grid(nc, kLayersInAll);
  nc.dimension("nhyi", kLayersInAll + 1);
  std::vector<double> a, b, t;
  for (std::size_t k = 0; k <= kLayersInAll; ++k) {
    const double s = double(k) / kLayersInAll, p = 101325 * std::exp(-11 * std::pow(1 - s, 1.3));
    b.push_back(s * s * s);
    a.push_back(k == 0 ? 0 : p - 101325 * b.back());
  }
  for (std::size_t k = 0; k < kLayersInAll; ++k)
    t.push_back(standard((a[k] + a[k + 1] + 101325 * (b[k] + b[k + 1])) / 2).temperature_K);
  nc.variable("hyai", NC_DOUBLE, {"nhyi"}, a, {{"units", "Pa"}});
  nc.variable("hybi", NC_DOUBLE, {"nhyi"}, b, {{"units", "1"}});
  add_field(nc, "t", t, {{"units", "K"}});
  add_water(nc, kLayersInAll);
  if (with_surface) {
    const std::vector<double> log_ps(kCells, std::log(101325.0)), flat(kCells, 0.0);
    nc.variable("lnsp", NC_DOUBLE, {"lat", "lon"}, log_ps);
    nc.variable("orog", NC_DOUBLE, {"lat", "lon"}, flat, {{"units", "m"}});
  }
  return path;
}

TEST(Vertical, HybridInterfacesStandAtTheirPressures) {
  const auto forecast = open(hybrid_file(true));
  const ForecastColumns columns = forecast->columns(0);
  double to_500_m = 0, to_10_m = 0;
  for (int k = 1; k < 90; ++k) {
    const double s = double(90 - k) / 90, p = 101325 * std::exp(-11 * std::pow(1 - s, 1.3));
    const double off = std::abs(double(columns.interface_m[std::size_t(k)]) - standard(p).height_m);
    if (p >= 500e2) to_500_m = std::max(to_500_m, off);
    if (p >= 10e2) to_10_m = std::max(to_10_m, off);
  }
  EXPECT_NEAR(columns.interface_m[0], 0, 0.01);
  report_accuracy("grids", "hybrid half levels to 500 hPa: off the standard atmosphere", to_500_m,
                  1, "m");
  report_accuracy("grids", "hybrid half levels to 10 hPa: off the standard atmosphere", to_10_m, 10,
                  "m");
  EXPECT_LE(to_500_m, 1);
  EXPECT_LE(to_10_m, 10);
}

// FV3's history files: layers from the top down, ak and bk as global attributes, an axis of
// reference pressures, thickness in m (below 0) and Pa, over ground of 700 m.
struct Fv3Twin {
  static constexpr std::size_t kLayers = 64;
  bool coefficients = true, metres = false, pascals = false;
  double ground_m = 700;
  static double a(std::size_t k) {
    const double s = double(k) / kLayers;
    return 101325 * std::exp(-9 * std::pow(1 - s, 1.3)) - 101325 * b(k);
  }
  static double b(std::size_t k) { return std::pow(double(k) / kLayers, 3); }
  double surface_Pa() const { return pressure_Pa(ground_m); }
  static double pressure_Pa(double height_m) {  // of standard()
    double low = 1e3, high = 1.2e5;
    for (int n = 0; n < 80; ++n) {
      const double p = std::sqrt(low * high);
      (standard(p).height_m > height_m ? low : high) = p;
    }
    return low;
  }
  double interface_Pa(std::size_t k) const { return a(k) + b(k) * surface_Pa(); }
  double interface_m(std::size_t k) const { return standard(interface_Pa(k)).height_m; }

  std::string write() const {
    const std::string path = folder() / "fv3.nc";
    NcWriter nc(path);
    nc.dimension("pfull", kLayers);
    nc.dimension("lat", 3);
    nc.dimension("lon", 4);
    std::vector<double> ak, bk, reference, t, metre, pascal, water;
    for (std::size_t k = 0; k <= kLayers; ++k) {
      ak.push_back(a(k));
      bk.push_back(b(k));
    }
    if (coefficients) {
      nc.global("ak", ak);
      nc.global("bk", bk);
    }
    for (std::size_t k = 0; k < kLayers; ++k) {
      reference.push_back((a(k) + a(k + 1) + (b(k) + b(k + 1)) * 1e5) / 200);
      const double thick = interface_m(k) - interface_m(k + 1);
      for (int n = 0; n < 12; ++n) {
        t.push_back(standard((interface_Pa(k) + interface_Pa(k + 1)) / 2).temperature_K);
        metre.push_back(-thick);
        pascal.push_back(interface_Pa(k + 1) - interface_Pa(k));
        water.push_back(k == 40 ? 1e-4 : 0);
      }
    }
    nc.variable("pfull", NC_DOUBLE, {"pfull"}, reference, {{"units", std::string("mb")}});
    nc.variable("lat", NC_DOUBLE, {"lat"}, {10, 11, 12}, {{"units", std::string("degrees_north")}});
    nc.variable("lon", NC_DOUBLE, {"lon"}, {1, 2, 3, 4}, {{"units", std::string("degrees_east")}});
    const std::vector<std::string> field = {"pfull", "lat", "lon"};
    nc.variable("tmp", NC_DOUBLE, field, t, {{"units", std::string("K")}});
    nc.variable("clwmr", NC_DOUBLE, field, water, {{"units", std::string("kg/kg")}});
    nc.variable("icmr", NC_DOUBLE, field, std::vector<double>(water.size(), 0.0),
                {{"units", std::string("kg/kg")}});
    if (metres) nc.variable("delz", NC_DOUBLE, field, metre, {{"units", std::string("m")}});
    if (pascals) nc.variable("dpres", NC_DOUBLE, field, pascal, {{"units", std::string("Pa")}});
    const auto surface = [&](const char* name, double value, const char* unit) {
      nc.variable(name, NC_DOUBLE, {"lat", "lon"}, std::vector<double>(12, value),
                  {{"units", std::string(unit)}});
    };
    surface("hgtsfc", ground_m, "m");
    surface("pressfc", surface_Pa(), "Pa");
    return path;
  }
  // Farthest interface from its height, up to 500 hPa.
  double off_m() const {
    const ForecastColumns c = open(write())->columns(0);
    double worst = 0;
    for (std::size_t k = 0; k <= kLayers; ++k)
      if (interface_Pa(kLayers - k) >= 500e2)
        worst = std::max(worst, std::abs(double(c.interface_m[k]) - interface_m(kLayers - k)));
    // The cloud is in its own layer.
    for (std::size_t k = 0; k < kLayers; ++k)
      EXPECT_EQ(c.extinction_per_m[k] > 0, k == kLayers - 1 - 40) << k;
    return worst;
  }
};

TEST(Vertical, Fv3LayersStandAtTheirHeights) {
  Fv3Twin twin;
  const double hybrid_m = twin.off_m();
  twin.metres = true;
  const double metres_m = twin.off_m();
  twin.coefficients = false;
  const double alone_m = twin.off_m();
  twin.metres = false;
  twin.pascals = true;
  const double pascals_m = twin.off_m();
  report_accuracy("grids", "FV3's ak and bk to 500 hPa: off the standard atmosphere", hybrid_m, 1,
                  "m");
  report_accuracy("grids", "FV3's delz to 500 hPa: off the standard atmosphere",
                  std::max(metres_m, alone_m), 0.01, "m");
  report_accuracy("grids", "FV3's dpres to 500 hPa: off the standard atmosphere", pascals_m, 1,
                  "m");
  EXPECT_LE(hybrid_m, 1);
  EXPECT_LE(std::max(metres_m, alone_m), 0.01);
  EXPECT_LE(pascals_m, 1);
  // Reference pressures alone are said to be what they are.
  twin.pascals = false;
  const auto said = open(twin.write())->assumptions();
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& text) {
    return text.find("pfull holds reference pressures") != std::string::npos;
  }));
}

// The 37 levels that analyses are given on, with bounds half way in pressure.
TEST(Vertical, PressureLevelsStandAtTheirHeights) {
  const std::vector<double> hPa = {1000, 975, 950, 925, 900, 875, 850, 825, 800, 775, 750, 700, 650,
                                   600,  550, 500, 450, 400, 350, 300, 250, 225, 200, 175, 150, 125,
                                   100,  70,  50,  30,  20,  10,  7,   5,   3,   2,   1};
  const std::string path = folder() / "pressures.nc";
  std::vector<double> bounds, t;
  {
    NcWriter nc(path);
    add_grid(nc, hPa.size());
    nc.dimension("bnds", 2);
    nc.variable("lev", NC_DOUBLE, {"lev"}, hPa, {{"units", "hPa"}, {"bounds", "lev_bnds"}});
    for (std::size_t k = 0; k < hPa.size(); ++k) {
      bounds.push_back(k == 0 ? 1013.25 : (hPa[k - 1] + hPa[k]) / 2);
      bounds.push_back(k + 1 == hPa.size() ? 0.5 : (hPa[k] + hPa[k + 1]) / 2);
      t.push_back(standard(hPa[k] * 100).temperature_K);
    }
    nc.variable("lev_bnds", NC_DOUBLE, {"lev", "bnds"}, bounds);
    add_field(nc, "t", t, {{"units", "K"}});
    add_water(nc, hPa.size());
  }
  const auto forecast = open(path);
  const ForecastColumns columns = forecast->columns(0);
  double to_500_m = 0, to_10_m = 0;
  for (std::size_t k = 0; k + 1 < hPa.size(); ++k) {
    const double p = bounds[2 * k];
    const double off = std::abs(double(columns.interface_m[k]) - standard(p * 100).height_m);
    if (p >= 500) to_500_m = std::max(to_500_m, off);
    if (p >= 10) to_10_m = std::max(to_10_m, off);
  }
  report_accuracy("grids", "37 pressures to 500 hPa: off the standard atmosphere", to_500_m, 1,
                  "m");
  report_accuracy("grids", "37 pressures to 10 hPa: off the standard atmosphere", to_10_m, 10, "m");
  EXPECT_LE(to_500_m, 1);
  EXPECT_LE(to_10_m, 10);
}

// One level has a thickness where its bounds say so.
TEST(Vertical, OneLevelWithBounds) {
  const std::string path = folder() / "one_level.nc";
  {
    NcWriter nc(path);
    add_grid(nc, 1);
    nc.dimension("bnds", 2);
    nc.variable("lev", NC_DOUBLE, {"lev"}, {1000},
                {{"units", "m"}, {"standard_name", "altitude"}, {"bounds", "lev_bnds"}});
    nc.variable("lev_bnds", NC_DOUBLE, {"lev", "bnds"}, {700, 1400});
    add_field(nc, "clw", {1e-4}, {{"units", "kg m-3"}});
  }
  const ForecastColumns columns = open(path)->columns(0);
  EXPECT_EQ(columns.interface_m[0], 700);
  EXPECT_EQ(columns.interface_m[1], 1400);
}

void expect_says(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in: " << text;
}

TEST(Vertical, WhatIsMissingIsNamedWithItsCure) {
  expect_says(refusal(hybrid_file(false)),
              {"hybrid levels without surface pressure", "surface_air_pressure", "lnsp"});
  const std::string path = folder() / "numbers.nc";
  {
    NcWriter nc(path);
    add_grid(nc, 3);
    nc.variable("lev", NC_DOUBLE, {"lev"}, {1, 2, 3}, {{"units", "1"}});
    add_water(nc, 3);
  }
  expect_says(refusal(path), {"neither heights nor pressures", "formula_terms"});
  const std::string orog = folder() / "no_orog.nc";
  {
    NcWriter nc(orog);
    add_grid(nc, 3);
    nc.variable("lev", NC_DOUBLE, {"lev"}, {10, 200, 500},
                {{"units", "m"},
                 {"standard_name", "atmosphere_hybrid_height_coordinate"},
                 {"formula_terms", "a: lev b: b orog: orog"}});
    nc.variable("b", NC_DOUBLE, {"lev"}, {1, 0.5, 0});
    add_water(nc, 3);
  }
  expect_says(refusal(orog), {"a term of the levels' formula is missing", "orog: orog"});
}

std::string map_file(const std::string& name, const Attributes& mapping) {
  const std::string path = folder() / (name + ".nc");
  NcWriter nc(path);
  nc.dimension("lev", 3);
  nc.dimension("y", 4);
  nc.dimension("x", 5);
  nc.variable("lev", NC_DOUBLE, {"lev"}, {100, 300, 500},
              {{"units", "m"}, {"standard_name", "altitude"}});
  nc.variable("y", NC_DOUBLE, {"y"}, {0, 2e4, 4e4, 6e4}, {{"units", "m"}});
  nc.variable("x", NC_DOUBLE, {"x"}, {0, 2e4, 4e4, 6e4, 8e4}, {{"units", "m"}});
  nc.variable("crs", NC_INT, {}, {0}, mapping);
  nc.variable("clw", NC_DOUBLE, {"lev", "y", "x"}, std::vector<double>(60, 1e-4),
              {{"units", "kg m-3"}, {"grid_mapping", "crs"}});
  return path;
}

TEST(Maps, WhatIsNotKnownIsNamed) {
  expect_says(refusal(map_file("unknown", {{"grid_mapping_name", "peirce_quincuncial"}})),
              {"this map projection is not known", "peirce_quincuncial", "geostationary",
               "lambert_azimuthal_equal_area", "crs_wkt"});
  expect_says(refusal(map_file("no_height", {{"grid_mapping_name", "geostationary"}})),
              {"the satellite's height is missing", "perspective_point_height"});
  expect_says(refusal(map_file("bad_wkt", {{"crs_wkt", "PROJCRS[\"nothing\"]"}})),
              {"PROJ does not understand this map"});
  // What is written for another variable does not move longitudes and latitudes.
  const std::string path = folder() / "stray.nc";
  {
    NcWriter nc(path);
    add_grid(nc, 2);
    nc.variable("lev", NC_DOUBLE, {"lev"}, {100, 300},
                {{"units", "m"}, {"standard_name", "altitude"}});
    nc.variable("crs", NC_INT, {}, {0}, {{"grid_mapping_name", "lambert_conformal_conic"}});
    add_field(nc, "clw", {1e-4, 1e-4}, {{"units", "kg m-3"}});
  }
  EXPECT_NEAR(open(path)->grid(0)->lat_lon_deg(0.5, 0.5).x, 10, 1e-9);
  // A sphere of GRIB's size is taken, and said.
  const auto forecast = open(map_file("bare", {{"grid_mapping_name", "mercator"}}));
  bool said = false;
  for (const std::string& text : forecast->assumptions())
    said |= text.find("6371.229") != std::string::npos;
  EXPECT_TRUE(said);
}

}  // namespace
}  // namespace nepho::forecast::test
