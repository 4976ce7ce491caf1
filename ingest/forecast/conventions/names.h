#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"
#include "forecast/water/water.h"

namespace nepho::forecast {

// What models call things. A new model's names are words more in the tables of names.cpp.

struct VariableNames {
  std::vector<std::string> standard_names;  // CF: asked for first
  std::vector<std::string> names;           // as written by models, compared without case
};

namespace names {
extern const VariableNames kTemperature, kPressure, kSurfacePressure, kLogSurfacePressure,
    kSpecificHumidity, kVapourMixingRatio, kRelativeHumidity, kCloudFraction, kDropletNumber,
    kTerrain, kSurfaceGeopotential, kLandFraction, kHalfLevelHeight, kFullLevelHeight,
    kGeopotentialHeight, kGeopotential, kLatitude, kLongitude;
}

// The first variable that answers to the names, standard names before names, and that `accept`
// takes; null where there is none.
const FileVariable* find_named(const DataFile& file, const VariableNames& wanted,
                               const std::function<bool(const FileVariable&)>& accept);

// Per what a mixing ratio counts; contents are kg/m3 and need no air.
enum class Basis { kDryAir, kMoistAir, kVolume };

struct WaterVariable {
  Species species = Species::kCloudWater;
  const FileVariable* variable = nullptr;
  Basis basis = Basis::kMoistAir;
  double to_si = 1;
  // Schemes with one condensate: below this it is the ice of its kind. 0: never.
  double freezes_below_K = 0;
};

// Condensate among the numeric variables that `accept` takes, each kind at most once, cloud before
// precipitation. Throws Error on units that are missing, unknown, or of no water content.
std::vector<WaterVariable> find_water(const DataFile& file,
                                      const std::function<bool(const FileVariable&)>& accept);
// Liquid and ice in one variable, where the file has no ice of its own: clwmr of models with the
// scheme of Zhao & Carr (1997), doi:10.1175/1520-0493(1997)125<1931:APCSFO>2.0.CO;2.
bool is_whole_condensate(const WaterVariable& water);
inline constexpr double kWholeCondensateFreezes_K = 258.15;

// Refuses a file without cloud water: lists its variables of three dimensions and more, and the
// names known. Triangles and profiles are named as such.
void require_water(const DataFile& file, const std::vector<WaterVariable>& water);

}  // namespace nepho::forecast
