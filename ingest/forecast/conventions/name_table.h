#pragma once

#include <span>
#include <string>

#include "forecast/files/data_file.h"

namespace nepho::forecast {

// What models call things: one table of rows in name_table.cpp. A model's names are rows more
// there; a user's own are rows of a file (user_names.h).

enum class Quantity {
  kCloudWater,
  kRain,
  kCloudIce,
  kSnow,
  kGraupel,
  kCloudFraction,
  kDropletNumber,
  kDropletRadius,
  kIceRadius,
  kTemperature,
  kPotentialTemperature,
  kLiquidPotentialTemperature,
  kPressure,
  kDensity,
  kSurfacePressure,
  kLogSurfacePressure,
  kSpecificHumidity,
  kVapourMixingRatio,
  kRelativeHumidity,
  kTerrain,
  kSurfaceGeopotential,
  kLandFraction,
  kHalfLevelHeight,
  kFullLevelHeight,
  kGeopotentialHeight,
  kGeopotential,
  kLatitude,
  kLongitude,
  kOther  // a name that looks like one of the above, and is not
};
inline constexpr int kQuantities = int(Quantity::kOther) + 1;

// As a names file writes it: "cloud_water".
const char* word_of(Quantity quantity);
// Cloud water, rain, cloud ice, snow and graupel, which come first.
constexpr bool is_condensate(Quantity quantity) {
  return quantity <= Quantity::kGraupel;
}

// Per what a mixing ratio counts; contents are kg/m3 and need no air.
enum class Basis { kDryAir, kMoistAir, kVolume };

// What stands behind a row: a file that its model wrote, one that a test writes as the model's own
// documentation or source says, or nothing.
enum class Evidence { kReal, kMade, kNone };

inline constexpr const char* kAnyModel = "any model";

struct NameRow {
  Quantity quantity;
  const char* model;          // whose name this is
  const char* name;           // of the variable, compared without case; "": by standard_name only
  const char* standard_name;  // "": by name only
  Evidence evidence = Evidence::kNone;
  Basis basis = Basis::kMoistAir;  // of a ratio; contents per volume tell themselves by their unit
  // In place of the unit that stands in the file; "": the file's.
  const char* units = "";
  // Only in files that are known to be this model's: the name means other things elsewhere.
  bool only_there = false;
  // Adds to the other parts of the same quantity (large-scale and convective clouds).
  bool part = false;
  // Liquid and ice in one variable, where the file has no ice of its kind: all ice below the first,
  // all liquid above the second, linear between. 0: one phase.
  double all_ice_K = 0, all_liquid_K = 0;
};

// In the order in which they are tried.
std::span<const NameRow> name_table();

// The model that wrote the file, as far as its attributes, variables and dimensions tell: one of
// the models of the table, or "".
std::string model_of_file(const DataFile& file);

}  // namespace nepho::forecast
