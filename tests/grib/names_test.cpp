// Numbers of parameters and levels to names, units and vertical coordinates.

#include <gtest/gtest.h>

#include <algorithm>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <span>

#include "forecast/water/water.h"
#include "grib_twin.h"
#include "sources/grib/parameter_table.h"

namespace nepho::grib::test {
namespace {

std::string one(int edition, const Keys& what, const Keys& where, double value,
                const Keys& more = {}) {
  GribTwin here;
  here.edition = edition;
  Made made(edition, here.grid());
  made.set(at_hour(edition, 0)).set(what).set(where).set(more);
  made.set({{"bitsPerValue", 24}});
  return made.values(std::vector<double>(30, value)).bytes();
}

Keys grib2(long centre, int discipline, int category, int number) {
  return {{"centre", centre},
          {"discipline", discipline},
          {"parameterCategory", category},
          {"parameterNumber", number}};
}
Keys grib1(long centre, int table, int number) {
  return {{"centre", centre}, {"table2Version", table}, {"indicatorOfParameter", number}};
}

std::string at(const GribFile& file, const std::string& name, const std::string& attribute) {
  const forecast::FileVariable* v = file.find(name);
  return v ? v->text(attribute) : "no variable " + name;
}

// What centres send, by their own numbers: name and standard_name that conventions look for. `a`,
// `b`, `c`: discipline, category and number; centre, table and number.
struct Case {
  int edition;
  std::array<int, 3> row;
  Keys what;
  const char *name, *standard_name;
};
Case second(long centre, int discipline, int category, int number, const char* name,
            const char* standard_name) {
  return {2,
          {discipline, category, number},
          grib2(centre, discipline, category, number),
          name,
          standard_name};
}
Case first(long centre, int table, int number, const char* name, const char* standard_name) {
  return {1, {int(centre), table, number}, grib1(centre, table, number), name, standard_name};
}

std::vector<Case> all_cases() {
  constexpr const char* kLiquid = "mass_fraction_of_cloud_liquid_water_in_air";
  constexpr const char* kIce = "mass_fraction_of_cloud_ice_in_air";
  constexpr const char* kRain = "mass_fraction_of_rain_in_air";
  constexpr const char* kSnow = "mass_fraction_of_snow_in_air";
  constexpr const char* kFraction = "cloud_area_fraction_in_atmosphere_layer";
  return {
      // NCEP
      second(7, 0, 1, 22, "clwmr", ""), second(7, 0, 1, 23, "icmr", ""),
      second(7, 0, 1, 24, "rwmr", ""), second(7, 0, 1, 25, "snmr", ""),
      second(7, 0, 1, 32, "grle", ""), second(7, 0, 1, 82, "icmr", ""),
      second(7, 0, 6, 23, "icmr", ""), second(7, 0, 6, 1, "tcc", kFraction),
      first(7, 2, 153, "clwmr", ""), first(7, 2, 170, "rwmr", ""), first(7, 2, 171, "snmr", ""),
      first(7, 2, 178, "icmr", ""), first(7, 2, 179, "grle", ""),
      // ECMWF
      second(98, 0, 1, 83, "clwc", kLiquid), second(98, 0, 1, 84, "ciwc", kIce),
      second(98, 0, 1, 85, "crwc", kRain), second(98, 0, 1, 86, "cswc", kSnow),
      second(98, 0, 6, 32, "cc", kFraction), first(98, 128, 246, "clwc", kLiquid),
      first(98, 128, 247, "ciwc", kIce), first(98, 128, 75, "crwc", kRain),
      first(98, 128, 76, "cswc", kSnow), first(98, 128, 130, "t", "air_temperature"),
      first(98, 128, 133, "q", "specific_humidity"), first(98, 128, 248, "cc", kFraction),
      first(98, 128, 54, "pres", "air_pressure"), first(98, 128, 129, "z", "geopotential"),
      first(98, 128, 156, "gh", "geopotential_height"),
      first(98, 128, 157, "r", "relative_humidity"),
      // DWD
      second(78, 0, 1, 22, "qc", ""), second(78, 0, 1, 82, "qi", ""),
      second(78, 0, 1, 24, "qr", ""), second(78, 0, 1, 25, "qs", ""),
      second(78, 0, 1, 32, "qg", ""), second(78, 0, 6, 22, "clc", kFraction),
      first(78, 201, 31, "qc", ""), first(78, 201, 33, "qi", ""), first(78, 201, 35, "qr", ""),
      first(78, 201, 36, "qs", ""), first(78, 201, 39, "qg", ""),
      first(78, 201, 29, "clc", kFraction),
      // HIRLAM and HARMONIE
      first(82, 253, 76, "clwc", kLiquid), first(82, 253, 58, "ciwc", kIce),
      first(82, 253, 181, "crwc", kRain), first(82, 253, 184, "cswc", kSnow),
      first(82, 253, 201, "grle", "mass_fraction_of_graupel_in_air"),
      // All
      second(34, 0, 0, 0, "t", "air_temperature"), second(34, 0, 1, 0, "q", "specific_humidity"),
      second(34, 0, 1, 1, "r", "relative_humidity"),
      second(34, 0, 1, 2, "mixr", "humidity_mixing_ratio"),
      second(34, 0, 3, 0, "pres", "air_pressure"), second(34, 0, 3, 5, "gh", "geopotential_height"),
      second(34, 0, 3, 4, "z", "geopotential"), second(34, 0, 3, 6, "altitude", "altitude"),
      second(34, 0, 6, 28, "qndrop", ""),
      second(34, 0, 6, 30, "qndrop", "number_concentration_of_cloud_liquid_water_particles_in_air"),
      second(34, 0, 6, 38, "lwc", "mass_concentration_of_cloud_liquid_water_in_air"),
      second(34, 0, 6, 39, "iwc", "mass_concentration_of_cloud_ice_in_air"),
      first(34, 2, 11, "t", "air_temperature"), first(34, 2, 7, "gh", "geopotential_height"),
      first(34, 2, 1, "pres", "air_pressure"), first(34, 2, 6, "z", "geopotential"),
      first(34, 2, 8, "altitude", "altitude"), first(34, 2, 51, "q", "specific_humidity"),
      first(34, 2, 52, "r", "relative_humidity"),
      first(34, 2, 53, "mixr", "humidity_mixing_ratio")};
}

TEST(GribNames, CentresHaveTheirNumbers) {
  for (const Case& c : all_cases()) {
    const GribFile file(
        {write_bytes("name.grib", one(c.edition, c.what, isobaric(c.edition, 500), 1e-4))}, {});
    EXPECT_EQ(at(file, c.name, "standard_name"), c.standard_name) << c.name;
    EXPECT_EQ(file.shape_text(*file.find(c.name)),
              std::string(c.name) + "(time 1, isobaric 1, lat 5, lon 6)");
    EXPECT_FALSE(at(file, c.name, "units").empty());
  }
  // Not a centre's number under the WMO's name: 11 of ECMWF's own table is no temperature.
  const GribFile own({write_bytes("own.grib", one(1, grib1(98, 128, 11), isobaric(1, 500), 1))},
                     {});
  EXPECT_EQ(own.find("t"), nullptr);
}

// Rows marked as behind made files are those of the cases above, and of the tests of the ground, of
// hybrid levels and of ICON's cells.
TEST(GribNames, MarksAreTrue) {
  const std::vector<Case> cases = all_cases();
  const auto is_elsewhere = [](const ParameterRow& row) {
    for (const char* name : {"lnsp", "lsm", "clat", "clon"})
      if (row.name == std::string(name)) return true;
    return false;
  };
  const auto check = [&](int edition, std::span<const ParameterRow> rows) {
    ASSERT_FALSE(rows.empty());
    for (const ParameterRow& row : rows) {
      const auto fits = [](int wanted, int is) { return wanted < 0 || wanted == is; };
      const bool made = std::ranges::any_of(cases, [&](const Case& c) {
        return c.edition == edition && fits(row.a, c.row[0]) && fits(row.b, c.row[1]) &&
               row.c == c.row[2] && row.name == std::string(c.name);
      });
      const bool marked = row.evidence == forecast::Evidence::kMade;
      EXPECT_TRUE(!marked || made || is_elsewhere(row)) << text_of(row) << " is marked only";
    }
  };
  check(1, parameter_table(1));
  check(2, parameter_table(2));
  check(2, parameter_table_of_dwd());
}

// A local number that no table knows, in g/kg; a known number that is something else here.
TEST(GribNames, AUserTellsWhatNumbersAre) {
  const std::string path = folder() / "model.names";
  std::ofstream(path) << "cloud_water grib2:0/1/200 units=g/kg per=dry_air\n"
                         "temperature grib2:0/0/201 units=K\n"
                         "rain clwmr\n";
  std::string bytes;
  for (const double hPa : {900, 800, 700}) {
    bytes += one(2, grib2(34, 0, 1, 200), isobaric(2, hPa), hPa == 800 ? 0.4 : 0);
    bytes += one(2, grib2(34, 0, 0, 201), isobaric(2, hPa), 280);
    bytes += one(2, grib2(34, 0, 1, 22), isobaric(2, hPa), hPa == 900 ? 1e-4 : 0);
    bytes += one(2, grib2(34, 0, 1, 0), isobaric(2, hPa), 0.02);
  }
  forecast::OpenRequest request;
  request.files = {write_bytes("user.grib2", bytes)};
  request.names_file = path;
  const auto f = open_grib(request);
  EXPECT_TRUE(says(f->facts(), "3 of 3 rows of " + path + " are of this file."));
  const forecast::ForecastColumns c = f->columns(0);
  const auto density = [](double Pa) { return Pa / (287.058 * 280 * (1 + 0.608 * 0.02)); };
  const double content = 4e-4 * 0.98 * density(80000);
  const double radius = forecast::droplet_radius_m(content, forecast::droplets_over(0));
  EXPECT_NEAR(
      double(c.extinction_per_m[1]) / (content * forecast::droplet_extinction_m2_per_kg(radius)), 1,
      2e-3);
  const double rain = 1e-4 * density(90000);
  EXPECT_NEAR(double(c.extinction_per_m[0]) / (rain * forecast::precipitation_extinction_m2_per_kg(
                                                          forecast::Species::kRain, rain, 280)),
              1, 2e-3);
}

// Cloud fraction on levels and nothing else: a stated water.
TEST(GribNames, FractionAloneHasAStatedWater) {
  std::string bytes;
  for (const double hPa : {900, 800, 700}) {
    bytes += one(2, grib2(98, 0, 6, 32), isobaric(2, hPa), hPa == 800 ? 0.5 : 0);
    bytes += one(2, grib2(98, 0, 0, 0), isobaric(2, hPa), 280);
  }
  const auto f = open({write_bytes("fraction.grib2", bytes)});
  EXPECT_TRUE(says(f->assumptions(), "There is no cloud water, only the cloud fraction cc"));
  const forecast::ForecastColumns c = f->columns(0);
  EXPECT_EQ(c.extinction_per_m[0], 0);
  EXPECT_GT(c.extinction_per_m[1], 1e-3f);
  EXPECT_EQ(c.extinction_per_m[2], 0);
}

TEST(GribNames, GroundIsNamedAsGround) {
  for (const int edition : {1, 2}) {
    const Keys ground = level(edition, 1, 1, 0);
    std::string bytes = one(edition, parameter(edition, "clwmr"), isobaric(edition, 500), 1e-4);
    bytes += one(edition, parameter(edition, "pres"), ground, 98000);
    bytes += one(edition, parameter(edition, "z"), ground, 9806.65);
    bytes += one(edition, parameter(edition, "lsm"), ground, 1);
    bytes += one(edition, parameter(edition, "t"), ground, 300);
    const GribFile file({write_bytes("ground.grib", bytes)}, {});
    EXPECT_EQ(at(file, "sp", "standard_name"), "surface_air_pressure");
    EXPECT_NEAR(all_of(file, "sp")[7], 98000, 0.1);
    EXPECT_EQ(at(file, "orog", "standard_name"), "surface_altitude");
    EXPECT_NEAR(all_of(file, "orog")[7], 1000, 1e-3);
    EXPECT_EQ(at(file, "lsm", "standard_name"), "land_area_fraction");
    EXPECT_EQ(file.shape(*file.find("orog")), (std::vector<std::size_t>{5, 6}));  // of no time
  }
}

// One axis in Pa, whether a level is told in hPa or Pa.
TEST(GribNames, PressuresAreOneAxis) {
  std::string bytes = one(2, parameter(2, "clwmr"), isobaric(2, 850), 1e-4);
  Keys fine = isobaric(2, 0.4);
  bytes += one(2, parameter(2, "clwmr"), fine, 2e-4);
  Keys tenth = level(2, 100, 100, 5);
  for (Key& key : tenth)
    if (key.name == "scaleFactorOfFirstFixedSurface") key.number = 1;
  bytes += one(2, parameter(2, "clwmr"), tenth, 3e-4);
  const GribFile file({write_bytes("pressures.grib2", bytes)}, {});
  EXPECT_EQ(all_of(file, "isobaric"), (std::vector<double>{0.5, 40, 85000}));
  EXPECT_EQ(at(file, "isobaric", "units"), "Pa");
  const GribFile first(
      {write_bytes("pressures.grib1", one(1, parameter(1, "clwmr"), isobaric(1, 850), 1e-4))}, {});
  EXPECT_EQ(all_of(first, "isobaric"), (std::vector<double>{85000}));
}

// Half levels k = 0 ... 4 from the top; levels 2 and 3 of 4 are in the file.
TEST(GribNames, HybridLevelsHaveTheirPressures) {
  const std::vector<double> a = {0, 5000, 10000, 5000, 0}, b = {0, 0, 0.2, 0.7, 1};
  std::vector<double> pv = a;
  pv.insert(pv.end(), b.begin(), b.end());
  const double pressure_Pa = 97000;
  for (const int edition : {1, 2}) {
    const auto on = [&](const char* name, long number, double value) {
      GribTwin here;
      here.edition = edition;
      Made made(edition, here.grid());
      made.set(at_hour(edition, 0)).set(parameter(edition, name));
      made.set(level(edition, 105, 109, number)).set({{"PVPresent", 1}}).set("pv", pv);
      made.set({{"bitsPerValue", 24}});
      return made.values(std::vector<double>(30, value)).bytes();
    };
    const auto ecmwf = [&](int category, int number, int number1, double value) {
      const Keys what = edition == 2 ? grib2(98, 0, category, number) : grib1(98, 128, number1);
      return one(edition, what, level(edition, 105, 109, 1), value);
    };
    std::string bytes = on("clwmr", 2, 1e-4) + on("clwmr", 3, 2e-4);
    bytes += on("t", 2, 250) + on("t", 3, 280);
    bytes += ecmwf(3, 25, 152, std::log(pressure_Pa));  // lnsp, on level 1
    bytes += ecmwf(3, 4, 129, 4903.325);                // the ground's geopotential, likewise
    const GribFile file({write_bytes("hybrid.grib", bytes)}, {});
    EXPECT_EQ(all_of(file, "hybrid"), (std::vector<double>{2, 3}));
    EXPECT_EQ(at(file, "hybrid", "standard_name"), "atmosphere_hybrid_sigma_pressure_coordinate");
    EXPECT_EQ(at(file, "hybrid", "formula_terms"), "ap: ap_hybrid b: b_hybrid ps: sp");
    EXPECT_EQ(at(file, "hybrid_bnds", "formula_terms"),
              "ap: ap_hybrid_bnds b: b_hybrid_bnds ps: sp");
    const std::vector<double> ap = all_of(file, "ap_hybrid"), bb = all_of(file, "b_hybrid"),
                              ap2 = all_of(file, "ap_hybrid_bnds"),
                              b2 = all_of(file, "b_hybrid_bnds"), sp = all_of(file, "sp");
    ASSERT_EQ(sp.size(), 30u);
    EXPECT_NEAR(sp[3], pressure_Pa, 1);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(ap[k], 0.5 * (a[k + 1] + a[k + 2]), 1e-2);
      EXPECT_NEAR(bb[k], 0.5 * (b[k + 1] + b[k + 2]), 1e-6);
      for (std::size_t edge = 0; edge < 2; ++edge) {
        EXPECT_NEAR(ap2[2 * k + edge], a[k + 1 + edge], 1e-2);
        EXPECT_NEAR(b2[2 * k + edge], b[k + 1 + edge], 1e-6);
      }
    }
    EXPECT_NEAR(all_of(file, "orog")[0], 500, 1e-2);
    EXPECT_EQ(file.find("z"), nullptr);
  }
}

// Levels of a and b over the ground, isothermal: hypsometric by hand.
TEST(GribNames, HybridLevelsStandAtTheirHeights) {
  const std::vector<double> a = {0, 5000, 10000, 5000, 0}, b = {0, 0, 0.2, 0.7, 1};
  std::vector<double> pv = a;
  pv.insert(pv.end(), b.begin(), b.end());
  constexpr double kSurface_Pa = 97000, kGround_m = 500, kTemperature_K = 280;
  std::string bytes;
  for (long number = 2; number <= 4; ++number)
    for (const char* name : {"clwmr", "t"}) {
      Made made(2, GribTwin().grid());
      made.set(at_hour(2, 0)).set(parameter(2, name)).set(level(2, 105, 109, number));
      made.set({{"PVPresent", 1}}).set("pv", pv).set({{"bitsPerValue", 24}});
      made.values(std::vector<double>(30, name[0] == 't' ? kTemperature_K
                                          : number == 3  ? 2e-4
                                                         : 0));
      bytes += made.bytes();
    }
  const Keys first = level(2, 105, 109, 1);
  bytes += one(2, grib2(98, 0, 3, 25), first, std::log(kSurface_Pa));
  bytes += one(2, grib2(98, 0, 3, 4), first, kGround_m * 9.80665);
  const auto forecast = open({write_bytes("levels.grib2", bytes)});
  const forecast::ForecastColumns c = forecast->columns(0);
  ASSERT_EQ(c.nz, 3);
  // Half levels 4, 3, 2, 1 from the ground up.
  double height_m = kGround_m;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t half = 4 - k;
    const double pressure_Pa = a[half] + b[half] * kSurface_Pa;
    if (k > 0) {
      const double below_Pa = a[half + 1] + b[half + 1] * kSurface_Pa;
      height_m += 287.05 * kTemperature_K / 9.80665 * std::log(below_Pa / pressure_Pa);
    }
    constexpr double kRadius_m = 6356766;  // of the standard atmosphere's geopotential metre
    EXPECT_NEAR(double(c.interface_m[k]), kRadius_m * height_m / (kRadius_m - height_m), 2) << k;
  }
  EXPECT_EQ(c.extinction_per_m[0], 0);
  EXPECT_GT(c.extinction_per_m[1], 1e-3f);  // level 3 of 4
  EXPECT_EQ(c.extinction_per_m[2], 0);
}

// Layers between HHL's levels, top down: cloud in the second layer of three.
TEST(GribNames, HeightsOfLayersAreAField) {
  const std::vector<double> limits_m = {3000, 2000, 800, 100};
  const auto on_limit = [](long number) {
    return Keys{{"typeOfLevel", "generalVertical"},
                {"typeOfSecondFixedSurface", 101},
                {"scaleFactorOfFirstFixedSurface", 0},
                {"scaledValueOfFirstFixedSurface", number}};
  };
  const auto on_layer = [](long number) {
    return Keys{{"typeOfLevel", "generalVerticalLayer"},
                {"scaleFactorOfFirstFixedSurface", 0},
                {"scaledValueOfFirstFixedSurface", number},
                {"scaleFactorOfSecondFixedSurface", 0},
                {"scaledValueOfSecondFixedSurface", number + 1}};
  };
  std::string bytes;
  for (std::size_t k = 0; k < 4; ++k)
    bytes += one(2, grib2(78, 0, 3, 6), on_limit(long(k) + 1), limits_m[k]);
  for (long k = 1; k <= 3; ++k) {
    bytes += one(2, grib2(78, 0, 1, 22), on_layer(k), k == 2 ? 3e-4 : 0);
    bytes += one(2, grib2(78, 0, 0, 0), on_layer(k), 280);
    bytes += one(2, grib2(78, 0, 3, 0), on_layer(k), 90000);
  }
  const auto forecast = open({write_bytes("cosmo.grib2", bytes)});
  const forecast::ForecastColumns c = forecast->columns(0);
  ASSERT_EQ(c.nz, 3);
  for (std::size_t n = 0; n < 30; ++n) {
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(double(c.interface_m[n * 4 + k]), limits_m[3 - k], 0.1);
    EXPECT_EQ(c.extinction_per_m[n * 3], 0);
    EXPECT_GT(c.extinction_per_m[n * 3 + 1], 1e-3f);
    EXPECT_EQ(c.extinction_per_m[n * 3 + 2], 0);
  }
  EXPECT_TRUE(std::ranges::any_of(forecast->recognised(), [](const DataFacts::Recognised& r) {
    return r.what == "levels" && r.text.find("half levels hhl") != std::string::npos;
  }));
}

TEST(GribNames, ColumnsAreNoLevels) {
  const Keys whole = level(2, 10, 200, 0);
  const std::string text =
      refusal(write_bytes("column.grib2", one(2, grib2(7, 0, 1, 22), whole, 1e-4) +
                                              one(2, parameter(2, "t"), isobaric(2, 500), 250)));
  EXPECT_NE(text.find("no cloud water on levels"), std::string::npos) << text;
  EXPECT_NE(text.find("t(time 1, isobaric 1"), std::string::npos) << text;
}

}  // namespace
}  // namespace nepho::grib::test
