#pragma once

#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/model.h"
#include "forecast/water/condensate.h"

namespace nepho::forecast {

// Sizes of droplets and crystals that a file holds: effective radii, else numbers of droplets.

// As models write units of numbers: "m-3", "cm-3", "kg-1", "#/kg", "  kg(-1)". Value times factor
// is per kg or per m3. Nothing where they are neither.
struct NumberUnit {
  double factor = 1;
  bool per_kg = true;
};
std::optional<NumberUnit> number_unit(const FileVariable& variable);

// To m; micrometres as "um", "micron" and "mkm" too. Nothing where it is no length.
std::optional<double> radius_factor(const FileVariable& variable);

// Those of the variables that `accept` takes whose units are understood; others are named among the
// assumptions.
void find_sizes(const Accept& accept, Model& model);
// Of one time, in SI.
void read_sizes(const Model& model, std::size_t time, CloudSetting& setting);
// What droplets' and crystals' radii come from, and how cloud fraction counts: sentences for
// `info`.
struct SaidOfSizes {
  const char* what;  // "droplets"
  std::string how;
};
std::vector<SaidOfSizes> said_of_sizes(const Model& model, const WaterStatistics& statistics);

}  // namespace nepho::forecast
