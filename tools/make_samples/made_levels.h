#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "made_grid.h"

namespace nepho::samples {

// What the kinds of levels of made_vertical.cpp and made_pressures.cpp share.

constexpr std::size_t kLevels = 20;
constexpr double kTop_m = 10000, kRadius_m = 6356766, kSea_Pa = 101325, kSea_K = 288.15;
constexpr double kPower = 9.80665 / (287.0529 * 0.0065);

// Geometric and geopotential height, and pressure, of the lowest 11 km.
inline double geopotential_m(double z) {
  return kRadius_m * z / (kRadius_m + z);
}
inline double geometric_m(double h) {
  return kRadius_m * h / (kRadius_m - h);
}
inline double pressure_Pa(double z) {
  return kSea_Pa * std::pow(1 - 0.0065 * geopotential_m(z) / kSea_K, kPower);
}
inline double height_m(double p) {
  return geometric_m(kSea_K / 0.0065 * (1 - std::pow(p / kSea_Pa, 1 / kPower)));
}
inline double temperature_K(double p) {
  return kSea_K * std::pow(p / kSea_Pa, 1 / kPower);
}

inline double ground_m(const MadeCell& cell) {
  const double lat = std::isnan(cell.centre_deg.x) ? 0 : cell.centre_deg.x;
  const double lon = std::isnan(cell.centre_deg.y) ? 0 : cell.centre_deg.y;
  return 350 + 250 * std::sin(0.05 * lat) * std::cos(0.11 * lon);
}

// Uneven steps of 0 to 1, level k's middle at k + 0.5.
inline double part(double k) {
  const double t = k / double(kLevels);
  return 0.35 * t + 0.65 * t * t;
}

// What a vertical is made of: height or pressure of a (fractional) level of a cell.
using OfLevel = std::function<double(const MadeCell&, double k)>;

inline std::vector<double> interfaces(const MadeCell& cell, const OfLevel& height, bool own) {
  std::vector<double> all;
  if (own) {
    for (std::size_t k = 0; k <= kLevels; ++k) all.push_back(height(cell, double(k)));
    return all;
  }
  std::vector<double> level;
  for (std::size_t k = 0; k < kLevels; ++k) level.push_back(height(cell, double(k) + 0.5));
  all.push_back(level[0] - (level[1] - level[0]) / 2);
  for (std::size_t k = 1; k < kLevels; ++k) all.push_back((level[k - 1] + level[k]) / 2);
  all.push_back(level.back() + (level.back() - level[kLevels - 2]) / 2);
  return all;
}

inline std::vector<std::string> with(const std::string& axis, std::vector<std::string> axes) {
  axes.insert(axes.begin(), axis);
  return axes;
}

inline std::vector<NcNote> joined(std::vector<NcNote> a, const std::vector<NcNote>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::vector<double> along(const std::function<double(double k)>& value,
                                 bool halves = false) {
  std::vector<double> all;
  for (std::size_t k = 0; k < kLevels + halves; ++k)
    all.push_back(value(double(k) + (halves ? 0 : 0.5)));
  return all;
}

inline std::vector<double> bounds(const std::function<double(double k)>& value) {
  std::vector<double> all;
  for (std::size_t k = 0; k < kLevels; ++k) {
    all.push_back(value(double(k)));
    all.push_back(value(double(k + 1)));
  }
  return all;
}

// A file's parts.
struct Writing {
  TinyFile& file;
  const MadeGrid& grid;

  void line(const char* name, std::vector<double> values, std::vector<NcNote> notes,
            const char* axis = "lev") const {
    file.add({name, NcValue::kDouble, {axis}, std::move(notes)}, std::move(values));
  }
  void pairs(const char* name, std::vector<double> values, std::vector<NcNote> notes = {}) const {
    if (std::ranges::none_of(file.layout.axes, [](const NcAxis& a) { return a.name == "bnds"; }))
      file.layout.axes.push_back({"bnds", 2});
    file.add({name, NcValue::kDouble, {"lev", "bnds"}, std::move(notes)}, std::move(values));
  }
  void scalar(const char* name, double value, std::vector<NcNote> notes) const {
    file.add({name, NcValue::kDouble, {}, std::move(notes)}, {value});
  }
  void field(const char* name, const OfLevel& value, std::vector<NcNote> notes,
             bool halves = false) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < kLevels + halves; ++k)
      for (std::size_t n = 0; n < grid.nx * grid.ny; ++n)
        all.push_back(value(grid.cell(n), double(k) + (halves ? 0 : 0.5)));
    file.add({name, NcValue::kDouble, with(halves ? "ilev" : "lev", grid.axes),
              joined(std::move(notes), grid.notes)},
             std::move(all));
  }
  void surface(const char* name, const std::function<double(const MadeCell&)>& value,
               std::vector<NcNote> notes) const {
    std::vector<double> all;
    for (std::size_t n = 0; n < grid.nx * grid.ny; ++n) all.push_back(value(grid.cell(n)));
    file.add({name, NcValue::kDouble, grid.axes, joined(std::move(notes), grid.notes)},
             std::move(all));
  }
  void halves() const { file.layout.axes.push_back({"ilev", kLevels + 1}); }
  void orography() const {
    surface("orog", ground_m,
            {text_note("standard_name", "surface_altitude"), text_note("units", "m")});
  }
  void surface_pressure() const {
    surface("ps", [](const MadeCell& cell) { return pressure_Pa(ground_m(cell)); },
            {text_note("standard_name", "surface_air_pressure"), text_note("units", "Pa")});
  }
  void temperature(const OfLevel& p) const {
    field("ta", [&](const MadeCell& cell, double k) { return temperature_K(p(cell, k)); },
          {text_note("standard_name", "air_temperature"), text_note("units", "K")});
  }
};

struct LevelEntry {
  const char* name;
  OfLevel height;  // of the fractional level k + 0.5, and of interfaces k where it has its own
  bool has_interfaces;
  std::function<void(const Writing&)> write;
};

std::vector<LevelEntry> made_pressures();

}  // namespace nepho::samples
