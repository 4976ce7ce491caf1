#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/model.h"
#include "units/parse_unit.h"

namespace nepho::forecast {

// Where the levels of a CF-like file stand. The ways that are known are the rows of a table in
// vertical.cpp, tried in order: heights of half levels; heights of levels; geopotential height;
// geopotential; thickness of layers; heights by a formula of the ground's; pressures, by a formula
// of the surface's, one per level, a field or thickness of layers, with temperature, hydrostatic;
// one height per level.
struct Vertical {
  bool from_top = false;                   // the file's first level is the highest
  std::vector<double> level_pressure_Pa;   // from the ground up, where levels are pressures
  const FileVariable* pressure = nullptr;  // as a field, or
  // by a formula, [k][j][i] from the ground up.
  std::function<std::vector<float>(std::size_t time)> pressure_Pa;
  bool heights_change = false;  // with time
  bool has_interfaces = false;  // the file's own, so that one level has a thickness
  bool on_ellipsoid = false;    // heights over the ellipsoid rather than the sea
  std::string how;              // "heights from z_ifc"
  // As Model's.
  std::function<std::vector<float>(std::size_t time, const Air*)> interfaces_m;
  std::function<glm::dvec2(std::size_t time)> height_range_m;
  std::vector<std::string> assumptions, facts;
};

struct VerticalRequest {
  std::shared_ptr<const FieldReader> reader;
  const FileVariable* water = nullptr;
  int z = -1;                                 // its level dimension
  const FileVariable* temperature = nullptr;  // on it
  std::function<Air(std::size_t time)> air;   // may be asked for in interfaces_m
  std::function<std::vector<float>(std::size_t time)> terrain_m;  // empty: not known
};

// Throws Error: levels that neither rise nor fall, levels that are no heights and no pressures.
Vertical find_vertical(const VerticalRequest& request);

// The pressure of levels where levels are pressures; empty where they are not. From the ground up.
struct PressureLevels {
  std::vector<double> pressure_Pa;
  std::vector<double> interface_Pa;  // by the axis' bounds; empty: not known
  bool from_top = false;
};
PressureLevels pressure_levels(const DataFile& file, int z);

// [k][j][i] of a time, from the ground up.
using PressureField = std::function<std::vector<float>(std::size_t time)>;

// Pressures of levels, and of the nz + 1 interfaces between them, of the layers' thickness in
// pressure (`dpres` of FV3) below the surface's; empty: not known.
struct LayerPressures {
  PressureField level_Pa, interface_Pa;
};
LayerPressures pressure_of_thickness(const VerticalRequest& request);

inline constexpr Dimension kGeopotentialUnit{.m = 2, .s = -2};

// Unit of a variable where it is of the wanted kind: SI value = value * factor + offset.
struct UnitOf {
  bool fits = false;
  double factor = 1, offset = 0;
};
UnitOf unit_of(const FileVariable& variable, const Dimension& wanted);

}  // namespace nepho::forecast
