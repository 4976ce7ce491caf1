#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "forecast/conventions/hybrid_pressure.h"
#include "forecast/conventions/vertical.h"

namespace nepho::forecast {

// What the ways of vertical.cpp share: levels of one file, and their interfaces.

[[noreturn]] void refuse_levels(const std::string& where, const std::string& found);
// 1 rising, -1 falling; throws Error otherwise.
int direction(const std::vector<double>& values, const std::string& where);
// Of heights, geopotential metres among them.
UnitOf height_unit(const FileVariable& variable);
bool varies(const FileVariable& variable, int dimension);
// Is the first level of most columns above their last? Reads those two.
bool falls(const FieldReader& reader, const FileVariable& variable, int z);
// Heights that are missing, in columns of levels: between neighbours, or in steps from the nearest;
// false where all are.
bool fill_levels(std::vector<double>& level_m);

// Columns of `count` interfaces made to rise; throws Error where more than 1 % had to be lifted.
std::vector<float> rising_interfaces(std::vector<float> interface_m, std::size_t count,
                                     const std::string& where);

// One file's levels; hooks hold it.
struct Levels {
  VerticalRequest request;
  const FileVariable* variable = nullptr;
  int z = -1;  // of `variable`
  bool from_top = false;
  double factor = 1, offset = 0;
  bool geopotential = false;  // of geopotential height, after the factor
  bool above_ground = false;  // rather than above the sea

  const FieldReader& reader() const { return *request.reader; }
  const DataFile& file() const { return *reader().file; }
  int nz() const { return int(file().size(request.z)); }
  std::size_t cells() const { return std::size_t(reader().nx) * std::size_t(reader().ny); }

  double height_m(double value) const;
  // What is added to it; `ground_m` may be NaN.
  double base_m(double ground_m) const {
    return above_ground && !std::isnan(ground_m) ? ground_m : 0;
  }
  // NaN where it is not known.
  std::vector<double> terrain_m(std::size_t time) const;
  // rising_interfaces() of this file.
  std::vector<float> checked(std::vector<float> interface_m) const;
  // [k][j][i] heights of levels, in the file's unit, to interfaces.
  std::vector<float> of_levels(const std::vector<float>& field, std::size_t time) const;
};
// Hydrostatic heights of the air's pressures; `variable` is what they come from. Interfaces stand
// at pressures of their own where either is known.
void set_hydrostatic(const VerticalRequest& request, Vertical& vertical,
                     const FileVariable& variable, std::optional<HybridPressure> hybrid,
                     PressureField interface_Pa = {});

std::shared_ptr<Levels> levels_of(const VerticalRequest& request, const FileVariable& variable,
                                  int z);

// The ways, each in the file that its name says; false: not this one.
using Way = bool(const VerticalRequest&, Vertical&);
Way by_half_levels, by_level_heights, by_geopotential_height, by_geopotential,
    by_height_axis;                                             // height_levels.cpp
Way by_thickness, by_pressure_thickness;                        // layer_thickness.cpp
Way by_hybrid_heights;                                          // hybrid_heights.cpp
Way by_hybrid_pressure, by_pressure_levels, by_pressure_field;  // pressure_levels.cpp

}  // namespace nepho::forecast
