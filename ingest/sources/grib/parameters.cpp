#include "sources/grib/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "forecast/conventions/names.h"
#include "sources/grib/parameter_table.h"

namespace nepho::grib {
namespace {

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

Codes codes_of(const Message& message) {
  const long centre = message.integer("centre").value_or(-1);
  if (message.need_integer("editionNumber") == 2)
    return {2, centre, message.need_integer("discipline"),
            message.need_integer("parameterCategory"), message.need_integer("parameterNumber")};
  return {1, centre, centre, message.need_integer("table2Version"),
          message.need_integer("indicatorOfParameter")};
}

void name_if_unknown(const Message& message, Parameter& p) {
  if (p.name.empty() || p.name == "unknown") p.name = "param" + message.text("paramId");
}

// What a user says of a field, in words that the conventions look for. Numbers that ecCodes does
// not know are told apart by the numbers themselves.
Parameter by_user(const forecast::UserName& user, const Message& message, const Level& level,
                  Parameter p) {
  if (user.kind != forecast::UserName::Kind::kName) {
    p.name = user.kind == forecast::UserName::Kind::kGrib2 ? "grib2" : "grib1";
    for (const int number : user.code) p.name += "_" + std::to_string(number);
  }
  p.units = user.units.empty() ? message.text("units") : user.units;
#ifdef NEPHO_MUTANT_USER_NUMBER
  p.units = "kg kg-1";
#endif
  p.known = true;
  p.water = forecast::is_condensate(user.quantity) && is_vertical(level.kind);
  p.said.emplace_back(forecast::kRowAttribute, user.where);
  p.said.emplace_back(forecast::kQuantityAttribute, forecast::word_of(user.quantity));
  if (!user.per.empty()) p.said.emplace_back(forecast::kPerAttribute, user.per);
  return p;
}

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

Parameter parameter_of(const Message& message, const Level& level,
                       const forecast::UserNames& names) {
  Parameter p;
  p.long_name = message.text("name");
  const Codes codes = codes_of(message);
  p.name = message.text("shortName");
  if (const forecast::UserName* user =
          names.of_grib(codes.edition, codes.a, codes.b, codes.c, p.name))
    return by_user(*user, message, level, std::move(p));
  if (const ParameterRow* row = parameter_row(codes)) {
    p.name = row->name;
    p.standard_name = row->standard_name;
    p.units = row->units;
    p.known = true;
    p.water = row->water && is_vertical(level.kind);
    p.constant = p.name == "clat" || p.name == "clon";
    p.said.emplace_back(forecast::kRowAttribute, text_of(*row));
    if (row->evidence == forecast::Evidence::kNone)
      p.said.emplace_back(forecast::kUntestedAttribute, text_of(*row));
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
  name_if_unknown(message, p);
  p.units = message.text("units");
  return p;
}

}  // namespace nepho::grib
