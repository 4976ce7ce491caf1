#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "forecast/conventions/user_names.h"
#include "sources/grib/message.h"

namespace nepho::grib {

// What a level's number is. Both editions' codes: GRIB2 table 4.5, GRIB1 table 3.
enum class LevelKind {
  kSurface,
  kIsobaric,         // Pa
  kAboveSea,         // m
  kAboveGround,      // m
  kHybrid,           // number of the level; pressure a + b * surface pressure where `pv` says so
  kGeneralVertical,  // number of the level; heights are a field (COSMO, ICON)
  kOther
};

struct Level {
  LevelKind kind = LevelKind::kOther;
  bool layer = false;  // between the level and the next
  std::string name;    // of the axis: isobaric, hybrid, hybridLayer, tropopause
  double value = 0;    // in the kind's unit; a layer's first
};
Level level_of(const Message& message);
// Of layers that a cloud is made of.
bool is_vertical(LevelKind kind);

enum class Change { kNone, kExponential, kPerGravity };  // to the value in `units`

// What a field is called in CF. Our own table for what clouds need, by the numbers of the WMO's
// tables and those of centres with their own; all else by ecCodes.
struct Parameter {
  std::string name, standard_name, units, long_name;
  bool water = false;     // condensate
  bool constant = false;  // the same at all times: the ground, the heights of levels
  Change change = Change::kNone;
  bool known = false;  // of our table, or a user's
  // Further attributes of the variable: what a user says of it, or that the row is untested.
  std::vector<std::pair<std::string, std::string>> said;
};
// A user's names come first.
Parameter parameter_of(const Message& message, const Level& level,
                       const forecast::UserNames& names = {});
// Geopotential of the ground, as its height: of a field that does not say that it is the ground's.
Parameter surface_geopotential();

}  // namespace nepho::grib
