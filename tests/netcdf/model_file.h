#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "forecast/conventions/names.h"
#include "nc_writer.h"

namespace nepho::forecast::test {

// A small file as a model writes it: its names, units, dimensions and their order, by the model's
// own documentation or source, around one air. Each kind of water has a cell of its own.
struct ModelFile {
  static constexpr int kNx = 4, kNy = 3, kNz = 4, kCloudLevel = 1;
  // The air: temperature falls by 5 K a level, and is half way between SAM's ice and water at 1.
  static double height_m(int k) { return 500.0 * (k + 1); }
  static double pressure_Pa(int k) { return 95000.0 - 5000 * k; }
  static double temperature_K(int k) { return 268.16 - 5 * k; }
  static double theta_K(int k) {
    return temperature_K(k) * std::pow(1e5 / pressure_Pa(k), 2.0 / 7);
  }
  static double base_density_kg_per_m3(int k) { return 1.5 - 0.1 * k; }
  static constexpr double kVapour = 1e-3;  // kg per kg of moist air

  struct Variable {
    std::string name, units;
    Quantity is;
    enum Shape { kWater, kField, kProfile, kSurface, kHalf } shape;
    std::function<double(int k)> value;  // as written; of water: in its cell at the cloud's level
    std::string standard_name = {};
  };

  std::string model;  // as model_of_file() tells it; "" where it cannot
  std::string file;
  std::string z = "z", y = "y", x = "x", z_units = "m", order = "tzyx";
  std::vector<Variable> variables;
  std::vector<std::pair<std::string, std::string>> globals = {};

  // Kinds of water in the order of the list; the n-th has cell n.
  int cell_of(const std::string& name) const {
    int cell = 0;
    for (const Variable& v : variables) {
      if (v.name == name) return cell;
      cell += v.shape == Variable::kWater;
    }
    return -1;
  }

  std::string write() const {
    const std::string path = folder() / (file + ".nc");
    NcWriter nc(path);
    const bool by_pressure = z_units == "hPa";
    for (const auto& [name, size] : {std::pair<std::string, int>{"time", 1},
                                     {z, kNz},
                                     {z + "_half", kNz + 1},
                                     {y, kNy},
                                     {x, kNx}})
      nc.dimension(name, std::size_t(size));
    for (const auto& [name, text] : globals) nc.global(name, text);
    nc.variable("time", NC_DOUBLE, {"time"}, {0}, {{"units", "hours since 2020-03-01"}});
    std::vector<double> levels, across;
    for (int k = 0; k < kNz; ++k)
      levels.push_back(by_pressure ? pressure_Pa(k) / 100 : height_m(k));
    if (!z_units.empty()) nc.variable(z, NC_DOUBLE, {z}, levels, {{"units", z_units}});
    for (int i = 0; i < kNx; ++i) across.push_back(1000.0 * i);
    nc.variable(x, NC_DOUBLE, {x}, across, {{"units", "m"}});
    across.pop_back();
    nc.variable(y, NC_DOUBLE, {y}, across, {{"units", "m"}});
    for (const Variable& v : variables) write(nc, v);
    return path;
  }

 private:
  void write(NcWriter& nc, const Variable& v) const {
    Attributes attributes;
    if (!v.units.empty()) attributes["units"] = v.units;
    if (!v.standard_name.empty()) attributes["standard_name"] = v.standard_name;
    const bool half = v.shape == Variable::kHalf;
    std::string axes = v.shape == Variable::kProfile ? "z" : order;
    if (v.shape == Variable::kSurface) axes.erase(axes.find('z'), 1);
    std::vector<std::string> names;
    std::vector<int> sizes;
    for (const char a : axes) {
      names.push_back(a == 't' ? "time" : a == 'z' ? z + (half ? "_half" : "") : a == 'y' ? y : x);
      sizes.push_back(a == 't' ? 1 : a == 'z' ? kNz + half : a == 'y' ? kNy : kNx);
    }
    std::size_t total = 1;
    for (const int size : sizes) total *= std::size_t(size);
    std::vector<double> values;
    for (std::size_t n = 0; n < total; ++n) {
      int at[4] = {0, 0, 0, 0};  // t z y x
      std::size_t rest = n;
      for (std::size_t d = axes.size(); d-- > 0; rest /= std::size_t(sizes[d]))
        at[std::string("tzyx").find(axes[d])] = int(rest % std::size_t(sizes[d]));
      const bool here = at[1] == kCloudLevel && at[2] * kNx + at[3] == cell_of(v.name);
      values.push_back(v.shape != Variable::kWater || here ? v.value(at[1]) : 0);
    }
    nc.variable(v.name, NC_DOUBLE, names, values, attributes);
  }
};

}  // namespace nepho::forecast::test
