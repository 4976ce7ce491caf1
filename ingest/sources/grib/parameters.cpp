#include "sources/grib/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace nepho::grib {
namespace {

constexpr const char* kLayerFraction = "cloud_area_fraction_in_atmosphere_layer";

// One row: the numbers of a table, and what they mean on levels.
struct Row {
  int a, b, c;  // GRIB2: discipline, category, number; GRIB1: centre or -1, table or -1, number
  const char *name, *standard_name, *units;
  bool water = false;
};

// GRIB2 tables 4.2: specific contents are per mass of moist air, mixing ratios per dry air.
constexpr std::array kGrib2 = {
    Row{0, 0, 0, "t", "air_temperature", "K"},
    Row{0, 1, 0, "q", "specific_humidity", "kg kg-1"},
    Row{0, 1, 1, "r", "relative_humidity", "%"},
    Row{0, 1, 2, "mixr", "humidity_mixing_ratio", "kg kg-1"},
    Row{0, 1, 22, "clwmr", "", "kg kg-1", true},
    Row{0, 1, 23, "icmr", "", "kg kg-1", true},
    Row{0, 1, 24, "rwmr", "", "kg kg-1", true},
    Row{0, 1, 25, "snmr", "", "kg kg-1", true},
    Row{0, 1, 32, "grle", "", "kg kg-1", true},
    Row{0, 1, 82, "icmr", "", "kg kg-1", true},
    Row{0, 1, 83, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true},
    Row{0, 1, 84, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true},
    Row{0, 1, 85, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true},
    Row{0, 1, 86, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true},
    Row{0, 6, 1, "tcc", kLayerFraction, "%"},
    Row{0, 6, 22, "clc", kLayerFraction, "%"},
    Row{0, 6, 23, "icmr", "", "kg kg-1", true},
    Row{0, 6, 28, "qndrop", "", "kg-1"},
    Row{0, 6, 30, "qndrop", "number_concentration_of_cloud_liquid_water_particles_in_air", "m-3"},
    Row{0, 6, 32, "cc", kLayerFraction, "1"},
    Row{0, 6, 38, "lwc", "mass_concentration_of_cloud_liquid_water_in_air", "kg m-3", true},
    Row{0, 6, 39, "iwc", "mass_concentration_of_cloud_ice_in_air", "kg m-3", true},
    Row{0, 3, 0, "pres", "air_pressure", "Pa"},
    Row{0, 3, 4, "z", "geopotential", "m2 s-2"},
    Row{0, 3, 5, "gh", "geopotential_height", "gpm"},
    Row{0, 3, 6, "altitude", "altitude", "m"},
    Row{0, 3, 25, "lnsp", "", "1"},
    Row{2, 0, 0, "lsm", "", "1"},
    Row{0, 191, 1, "clat", "", "degrees_north"},
    Row{0, 191, 2, "clon", "", "degrees_east"},
};

// DWD's names of the same numbers: contents per moist air (COSMO documentation part II; ICON).
constexpr std::array kGrib2Dwd = {
    Row{0, 1, 22, "qc", "", "kg kg-1", true}, Row{0, 1, 82, "qi", "", "kg kg-1", true},
    Row{0, 1, 24, "qr", "", "kg kg-1", true}, Row{0, 1, 25, "qs", "", "kg kg-1", true},
    Row{0, 1, 32, "qg", "", "kg kg-1", true}};

// Tables of centres first, the WMO's table (numbers below 128) last.
constexpr std::array kGrib1 = {
    // ECMWF, table 128
    Row{98, 128, 54, "pres", "air_pressure", "Pa"},
    Row{98, 128, 75, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true},
    Row{98, 128, 76, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true},
    Row{98, 128, 129, "z", "geopotential", "m2 s-2"},
    Row{98, 128, 130, "t", "air_temperature", "K"},
    Row{98, 128, 133, "q", "specific_humidity", "kg kg-1"},
    Row{98, 128, 134, "pres", "air_pressure", "Pa"},
    Row{98, 128, 152, "lnsp", "", "1"},
    Row{98, 128, 156, "gh", "geopotential_height", "gpm"},
    Row{98, 128, 157, "r", "relative_humidity", "%"},
    Row{98, 128, 172, "lsm", "", "1"},
    Row{98, 128, 246, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true},
    Row{98, 128, 247, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true},
    Row{98, 128, 248, "cc", kLayerFraction, "1"},
    // NCEP, table 2 (Office Note 388)
    Row{7, 2, 153, "clwmr", "", "kg kg-1", true},
    Row{7, 2, 170, "rwmr", "", "kg kg-1", true},
    Row{7, 2, 171, "snmr", "", "kg kg-1", true},
    Row{7, 2, 178, "icmr", "", "kg kg-1", true},
    Row{7, 2, 179, "grle", "", "kg kg-1", true},
    // COSMO, table 201
    Row{-1, 201, 29, "clc", kLayerFraction, "%"},
    Row{-1, 201, 31, "qc", "", "kg kg-1", true},
    Row{-1, 201, 33, "qi", "", "kg kg-1", true},
    Row{-1, 201, 35, "qr", "", "kg kg-1", true},
    Row{-1, 201, 36, "qs", "", "kg kg-1", true},
    Row{-1, 201, 39, "qg", "", "kg kg-1", true},
    // HIRLAM and HARMONIE, table 253: contents, where they are on levels
    Row{-1, 253, 58, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true},
    Row{-1, 253, 76, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true},
    Row{-1, 253, 181, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true},
    Row{-1, 253, 184, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true},
    Row{-1, 253, 201, "grle", "mass_fraction_of_graupel_in_air", "kg kg-1", true},
    // All: the numbers that every table shares
    Row{-1, -1, 1, "pres", "air_pressure", "Pa"},
    Row{-1, -1, 6, "z", "geopotential", "m2 s-2"},
    Row{-1, -1, 7, "gh", "geopotential_height", "gpm"},
    Row{-1, -1, 8, "altitude", "altitude", "m"},
    Row{-1, -1, 11, "t", "air_temperature", "K"},
    Row{-1, -1, 51, "q", "specific_humidity", "kg kg-1"},
    Row{-1, -1, 52, "r", "relative_humidity", "%"},
    Row{-1, -1, 53, "mixr", "humidity_mixing_ratio", "kg kg-1"},
    Row{-1, -1, 81, "lsm", "", "1"},
};

const Row* find(std::span<const Row> rows, long a, long b, long c) {
  const auto fits = [](int wanted, long is) { return wanted < 0 || wanted == is; };
  const auto at = std::ranges::find_if(
      rows, [&](const Row& r) { return fits(r.a, a) && fits(r.b, b) && r.c == c; });
  return at == rows.end() ? nullptr : &*at;
}

bool uses_dwd_names(long centre) {
  return centre == 78 || centre == 215 || centre == 250;  // DWD, MeteoSwiss, the COSMO consortium
}

const Row* row_of(const Message& message) {
  const long centre = message.integer("centre").value_or(-1);
  if (message.need_integer("editionNumber") == 2) {
    const long a = message.need_integer("discipline"),
               b = message.need_integer("parameterCategory"),
               c = message.need_integer("parameterNumber");
    if (uses_dwd_names(centre))
      if (const Row* row = find(kGrib2Dwd, a, b, c)) return row;
    return find(kGrib2, a, b, c);
  }
  const long table = message.need_integer("table2Version");
  const long number = message.need_integer("indicatorOfParameter");
  // Below 128 tables of version 128 and more are a centre's own, but for those that keep the WMO's.
  const bool shared = table < 128 || table == 253;
  const Row* row = find(kGrib1, centre, table, number);
  return row && row->b < 0 && !shared ? nullptr : row;
}

// Fields of one level that clouds need are others than the same numbers on levels.
void at_surface(Parameter& p) {
  const auto rename = [&](const char* name, const char* standard_name, const char* units) {
    p.name = name;
    p.standard_name = standard_name;
    p.units = units;
  };
  if (p.name == "pres") {
    rename("sp", "surface_air_pressure", "Pa");
  } else if (p.name == "gh" || p.name == "altitude") {
    rename("orog", "surface_altitude", "m");
    p.constant = true;
  } else if (p.name == "z") {
    rename("orog", "surface_altitude", "m");
    p.constant = true;
    p.change = Change::kPerGravity;
  } else if (p.name == "lsm") {
    p.standard_name = "land_area_fraction";
    p.constant = true;
  }
}

// Levels between layers: HHL stands there, COSMO's in edition 1 under the code of hybrid levels.
bool limits_layers(const Message& message, const Level& level) {
  if (level.layer) return false;
  return level.name == "generalVertical" ||
         (level.name == "hybrid" && message.integer("editionNumber") == 1);
}

struct NamedLevel {
  long code;
  LevelKind kind;
  const char* name;
};
constexpr std::array kLevels2 = {NamedLevel{1, LevelKind::kSurface, "surface"},
                                 NamedLevel{100, LevelKind::kIsobaric, "isobaric"},
                                 NamedLevel{102, LevelKind::kAboveSea, "heightAboveSea"},
                                 NamedLevel{103, LevelKind::kAboveGround, "heightAboveGround"},
                                 NamedLevel{105, LevelKind::kHybrid, "hybrid"},
                                 NamedLevel{118, LevelKind::kGeneralVertical, "hybridHeight"},
                                 NamedLevel{119, LevelKind::kHybrid, "hybridPressure"},
                                 NamedLevel{150, LevelKind::kGeneralVertical, "generalVertical"}};
constexpr std::array kLevels1 = {NamedLevel{1, LevelKind::kSurface, "surface"},
                                 NamedLevel{100, LevelKind::kIsobaric, "isobaric"},
                                 NamedLevel{210, LevelKind::kIsobaric, "isobaric"},  // in Pa
                                 NamedLevel{103, LevelKind::kAboveSea, "heightAboveSea"},
                                 NamedLevel{105, LevelKind::kAboveGround, "heightAboveGround"},
                                 NamedLevel{109, LevelKind::kHybrid, "hybrid"},
                                 NamedLevel{110, LevelKind::kHybrid, "hybridLayer"}};

#ifdef NEPHO_MUTANT_UNITS_HPA
constexpr double kPaPerHpa = 1;
#else
constexpr double kPaPerHpa = 100;
#endif

}  // namespace

Parameter surface_geopotential() {
  Parameter p;
  p.name = "z";
  p.known = true;
  at_surface(p);
  return p;
}

bool is_vertical(LevelKind kind) {
  return kind != LevelKind::kSurface && kind != LevelKind::kOther;
}

Level level_of(const Message& message) {
  const bool second = message.need_integer("editionNumber") == 2;
  const long code =
      message.integer(second ? "typeOfFirstFixedSurface" : "indicatorOfTypeOfLevel").value_or(255);
  const std::span<const NamedLevel> known =
      second ? std::span<const NamedLevel>(kLevels2) : std::span<const NamedLevel>(kLevels1);
  Level level;
  const auto at = std::ranges::find(known, code, &NamedLevel::code);
  if (at == known.end()) {
    level.name = message.text("typeOfLevel");
    if (level.name.empty() || level.name == "unknown") level.name = "level" + std::to_string(code);
    level.value = double(message.integer("level").value_or(0));
    return level;
  }
  level.kind = at->kind;
  level.name = at->name;
  if (second) {
    level.layer = message.integer("typeOfSecondFixedSurface") == code;
    // 10 to the power of the factor: missing where it is 0, for some centres.
    const double scaled = double(message.integer("scaledValueOfFirstFixedSurface").value_or(0));
    const long power = message.integer("scaleFactorOfFirstFixedSurface").value_or(0);
    level.value = scaled * std::pow(10.0, double(-power));
    if (level.layer) level.name += "Layer";
  } else {
    level.layer = code == 110;
    level.value = double(message.integer(level.layer ? "topLevel" : "level").value_or(0));
    if (code == 100) level.value *= kPaPerHpa;
  }
  if (level.kind == LevelKind::kSurface) level.value = 0;
  return level;
}

Parameter parameter_of(const Message& message, const Level& level) {
  Parameter p;
  p.long_name = message.text("name");
  if (const Row* row = row_of(message)) {
    p.name = row->name;
    p.standard_name = row->standard_name;
    p.units = row->units;
    p.known = true;
    p.water = row->water && is_vertical(level.kind);
    p.constant = p.name == "clat" || p.name == "clon";
    if (row->water && !p.water) p.name += "_" + level.name;  // a column's, or a cloud top's
    if (p.name == "lnsp") {                                  // on level 1, as ECMWF writes it
      p.name = "sp";
      p.standard_name = "surface_air_pressure";
      p.units = "Pa";
      p.change = Change::kExponential;
    } else if (level.kind == LevelKind::kSurface) {
      at_surface(p);
    } else if (!is_vertical(level.kind)) {
      p.standard_name = "";
    } else if (p.name == "altitude" && limits_layers(message, level)) {
      p.name = "hhl";
      p.standard_name = "geometric_height_at_half_level_center";
      p.constant = true;
    }
    return p;
  }
  p.name = message.text("shortName");
  if (p.name.empty() || p.name == "unknown") p.name = "param" + message.text("paramId");
  p.units = message.text("units");
  return p;
}

}  // namespace nepho::grib
