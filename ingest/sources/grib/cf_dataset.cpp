#include "sources/grib/cf_dataset.h"

#include <cmath>
#include <map>
#include <set>

#include "core/error.h"

namespace nepho::grib {
namespace {

using forecast::FileAttribute;
using forecast::FileVariable;

FileAttribute text(const char* name, const std::string& value) {
  return {name, value, {}};
}

// Fields of one parameter on one kind of level.
struct Group {
  Parameter parameter;
  Level level;  // of any of them
  std::vector<int> fields;
};

class Builder {
 public:
  explicit Builder(const FieldTable& table) : table_(table), choice_(usable_fields(table)) {
    out_.facts = choice_.facts;
    out_.assumptions = choice_.assumptions;
    group();
    find_times();
    add_grid();
    find_levels();
    // Plain names to what stands on the cloud water's levels.
    std::set<std::string> of_water;
    for (const auto& [key, group] : groups_)
      if (group.parameter.water) of_water.insert(group.level.name);
    for (const bool first : {true, false})
      for (const auto& [key, group] : groups_)
        if (of_water.contains(group.level.name) == first) add_fields(group);
  }
  CfDataset take() { return std::move(out_); }

 private:
  void group();
  void find_times();
  void find_levels();
  void add_grid();
  void add_level_axis(const Level& level, const std::vector<double>& values);
  void add_hybrid(const std::string& name, const std::vector<double>& levels, int dimension);
  void add_fields(const Group& group);
  void add_mapping(const Grid& grid);

  const Field& field(int n) const { return table_.fields[std::size_t(n)]; }
  bool has_water() const {
    return std::ranges::any_of(groups_, [](const auto& g) { return g.second.parameter.water; });
  }
  // Does it decide which times and levels there are?
  bool decides(const Group& group) const { return group.parameter.known || !has_water(); }
  int dimension(const std::string& name, std::size_t size) {
    out_.dimensions.push_back({name, size});
    return int(out_.dimensions.size()) - 1;
  }
  FileVariable& variable(const std::string& name, std::vector<int> dimensions,
                         std::vector<FileAttribute> attributes, VariableValues values) {
    FileVariable v;
    v.name = name;
    v.id = int(out_.variables.size());
    v.value_bytes = sizeof(double);
    v.dimensions = std::move(dimensions);
    v.attributes = std::move(attributes);
    out_.variables.push_back(std::move(v));
    out_.values.push_back(std::move(values));
    return out_.variables.back();
  }
  void in_memory(const std::string& name, std::vector<int> dimensions, std::vector<double> values,
                 std::vector<FileAttribute> attributes) {
    variable(name, std::move(dimensions), std::move(attributes), {std::move(values), {}, {}});
  }

  const FieldTable& table_;
  Choice choice_;
  CfDataset out_;
  std::map<std::string, Group> groups_;  // by "name@level"
  std::vector<std::int64_t> times_ns_;
  std::vector<int> places_;  // dimensions of place, slowest first
  struct Axis {
    std::vector<double> values;
    int dimension = -1;
  };
  std::map<std::string, Axis> axes_;  // by the level's name
};

void Builder::group() {
  for (const int n : choice_.fields) {
    const FieldHeader& header = field(n).header;
    Group& group = groups_[header.parameter.name + "@" + header.level.name];
    if (group.fields.empty()) {
      group.parameter = header.parameter;
      group.level = header.level;
    }
    group.fields.push_back(n);
  }
  // The ground's geopotential on level 1, as ECMWF writes it among fields of many levels.
  const auto z = groups_.find("z@hybrid");
  if (z == groups_.end() || !std::ranges::all_of(z->second.fields, [&](int n) {
        return field(n).header.level.value == 1;
      }))
    return;
  Group ground = std::move(z->second);
  groups_.erase(z);
  ground.level = {LevelKind::kSurface, false, "surface", 0};
  ground.parameter = surface_geopotential();
  ground.fields.resize(1);
  if (!groups_.contains("orog@surface")) groups_["orog@surface"] = std::move(ground);
}

void Builder::find_times() {
  std::set<std::int64_t> water, all;
  for (const auto& [key, group] : groups_)
    for (const int n : group.fields) {
      const std::int64_t ns = *field(n).header.valid_ns;
      if (group.parameter.water) water.insert(ns);
      if (!group.parameter.constant) all.insert(ns);
    }
  const std::set<std::int64_t>& used = water.empty() ? all : water;
  times_ns_.assign(used.begin(), used.end());
  if (times_ns_.empty()) times_ns_.push_back(0);
  std::vector<double> seconds;
  for (const std::int64_t ns : times_ns_) seconds.push_back(double(ns / 1'000'000'000));
  const int time = dimension("time", seconds.size());
  in_memory("time", {time}, std::move(seconds),
            {text("units", "seconds since 1970-01-01 00:00:00"), text("standard_name", "time"),
             text("calendar", "standard"), text("axis", "T")});
}

void Builder::add_mapping(const Grid& grid) {
  if (!grid.mapping.empty()) in_memory("crs", {}, {0}, grid.mapping);
}

void Builder::add_grid() {
  const Grid& grid = table_.grids[std::size_t(choice_.grid)];
  const auto axis = [&](const char* name, const std::vector<double>& values, const char* standard,
                        const char* units, const char* letter) {
    const int d = dimension(name, values.size());
    places_.push_back(d);
    in_memory(name, {d}, values,
              {text("units", units), text("standard_name", standard), text("axis", letter)});
  };
  switch (grid.kind) {
    case Grid::Kind::kLatLon:
      axis("lat", grid.y, "latitude", "degrees_north", "Y");
      axis("lon", grid.x, "longitude", "degrees_east", "X");
      break;
    case Grid::Kind::kRotated:
      axis("rlat", grid.y, "grid_latitude", "degrees", "Y");
      axis("rlon", grid.x, "grid_longitude", "degrees", "X");
      break;
    case Grid::Kind::kMap:
      axis("y", grid.y, "projection_y_coordinate", "m", "Y");
      axis("x", grid.x, "projection_x_coordinate", "m", "X");
      break;
    case Grid::Kind::kPlaces:
      places_ = {dimension("y", grid.ny), dimension("x", grid.nx)};
      in_memory("latitude", places_, grid.latitude_deg,
                {text("units", "degrees_north"), text("standard_name", "latitude")});
      in_memory("longitude", places_, grid.longitude_deg,
                {text("units", "degrees_east"), text("standard_name", "longitude")});
      break;
    case Grid::Kind::kCells:
      places_ = {dimension("ncells", grid.nx)};
      break;
    case Grid::Kind::kUnknown:  // without water: variables are named, and none is read
      places_ = {dimension("values", 1)};
      break;
  }
  add_mapping(grid);
}

void Builder::find_levels() {
  std::map<std::string, std::pair<Level, std::set<double>>> found;
  for (const auto& [key, group] : groups_) {
    if (!decides(group) || group.level.kind == LevelKind::kSurface || group.parameter.name == "sp")
      continue;
    auto& [level, values] = found[group.level.name];
    level = group.level;
    for (const int n : group.fields) values.insert(field(n).header.level.value);
  }
  for (const auto& [name, of] : found)
    if (is_vertical(of.first.kind) || of.second.size() > 1)
      add_level_axis(of.first, {of.second.begin(), of.second.end()});
}

void Builder::add_level_axis(const Level& level, const std::vector<double>& values) {
  const int d = dimension(level.name, values.size());
  axes_[level.name] = {values, d};
  const auto axis = [&](const char* standard, const char* units, const char* positive) {
    std::vector<FileAttribute> attributes = {text("axis", "Z"), text("units", units),
                                             text("positive", positive)};
    if (*standard) attributes.push_back(text("standard_name", standard));
    in_memory(level.name, {d}, values, std::move(attributes));
  };
  switch (level.kind) {
    case LevelKind::kIsobaric:
      return axis("air_pressure", "Pa", "down");
    case LevelKind::kAboveSea:
      return axis("altitude", "m", "up");
    case LevelKind::kAboveGround:
      return axis("height", "m", "up");
    case LevelKind::kHybrid:
      return add_hybrid(level.name, values, d);
    default:
      return axis("", "1", "down");
  }
}

// Two numbers for each half level from the top down: pressure rises from one to the next, and the
// last is the surface's. COSMO's `pv` says other things.
bool are_half_levels(const std::vector<double>& pv, const std::vector<double>& levels) {
  const std::size_t half = pv.size() / 2;
  if (pv.size() % 2 || half < 2 || levels.front() < 1 || levels.back() > double(half - 1))
    return false;
  constexpr double kSurface_Pa = 101325;
  double before = -1;
  for (std::size_t k = 0; k < half; ++k) {
    const double pressure_Pa = pv[k] + pv[half + k] * kSurface_Pa;
    if (!(pv[k] >= 0 && pv[half + k] >= 0 && pv[half + k] <= 1 && pressure_Pa > before))
      return false;
    before = pressure_Pa;
  }
  return std::abs(before - kSurface_Pa) < 1;
}

void Builder::add_hybrid(const std::string& name, const std::vector<double>& levels,
                         int dimension_of_levels) {
  const std::vector<double>& pv = table_.pv;
  std::vector<FileAttribute> attributes = {text("axis", "Z"), text("units", "1"),
                                           text("positive", "down")};
  if (!are_half_levels(pv, levels)) {
    in_memory(name, {dimension_of_levels}, levels, std::move(attributes));
    if (!pv.empty())
      out_.facts.push_back("The vertical numbers (pv) are no a and b of half levels: not used.");
    return;
  }
  const std::size_t half = pv.size() / 2;
  // Level n lies between half levels n - 1 and n, counted from the top.
  std::vector<double> a, b, a_bounds, b_bounds, bounds;
  for (const double level : levels) {
#ifdef NEPHO_MUTANT_HALF_LEVELS
    const std::size_t above = std::size_t(level), below = above + 1;
#else
    const std::size_t below = std::size_t(level), above = below - 1;
#endif
    a.push_back(0.5 * (pv[above] + pv[below]));
    b.push_back(0.5 * (pv[half + above] + pv[half + below]));
    for (const std::size_t edge : {above, below}) {
      a_bounds.push_back(pv[edge]);
      b_bounds.push_back(pv[half + edge]);
      bounds.push_back(double(edge) + 0.5);
    }
  }
  const std::string ap = "ap_" + name, b_name = "b_" + name;
  attributes.push_back(text("standard_name", "atmosphere_hybrid_sigma_pressure_coordinate"));
  attributes.push_back(text("formula_terms", "ap: " + ap + " b: " + b_name + " ps: sp"));
  attributes.push_back(text("bounds", name + "_bnds"));
  in_memory(name, {dimension_of_levels}, levels, std::move(attributes));
  in_memory(ap, {dimension_of_levels}, std::move(a), {text("units", "Pa")});
  in_memory(b_name, {dimension_of_levels}, std::move(b), {text("units", "1")});
  const int two = dimension(name + "_edges", 2);
  const std::vector<int> edges = {dimension_of_levels, two};
  in_memory(name + "_bnds", edges, std::move(bounds),
            {text("formula_terms", "ap: " + ap + "_bnds b: " + b_name + "_bnds ps: sp")});
  in_memory(ap + "_bnds", edges, std::move(a_bounds), {text("units", "Pa")});
  in_memory(b_name + "_bnds", edges, std::move(b_bounds), {text("units", "1")});
}

void Builder::add_fields(const Group& group) {
  const auto axis = axes_.find(group.level.name);
  const bool on_axis = axis != axes_.end() && group.parameter.name != "sp";
  const bool constant = group.parameter.constant;
  const std::size_t levels = on_axis ? axis->second.values.size() : 1;
  const std::size_t times = constant ? 1 : times_ns_.size();
  VariableValues values;
  values.change = group.parameter.change;
  values.fields.assign(times * levels, -1);
  std::size_t present = 0;
  for (const int n : group.fields) {
    const FieldHeader& header = field(n).header;
    std::size_t t = 0, k = 0;
    if (!constant) {
      const auto at = std::ranges::find(times_ns_, *header.valid_ns);
      if (at == times_ns_.end()) continue;
      t = std::size_t(at - times_ns_.begin());
    }
    if (on_axis) {
      const auto at = std::ranges::find(axis->second.values, header.level.value);
      if (at == axis->second.values.end()) continue;
      k = std::size_t(at - axis->second.values.begin());
    }
    present += values.fields[t * levels + k] < 0;
    values.fields[t * levels + k] = n;
  }
  if (present == 0) return;
  if (group.parameter.water && present < times * levels)
    out_.facts.push_back(group.parameter.name + " is in the file for " + std::to_string(present) +
                         " of " + std::to_string(times * levels) + " times and levels.");
  std::vector<int> dimensions;
  if (!constant) dimensions.push_back(0);  // time
  if (on_axis) dimensions.push_back(axis->second.dimension);
  dimensions.insert(dimensions.end(), places_.begin(), places_.end());
  // The plain name where clouds look for it.
  const bool plain = is_vertical(group.level.kind) || group.level.kind == LevelKind::kSurface ||
                     group.parameter.name == "sp";
  std::string name = group.parameter.name;
  const auto taken = [&] {
    return std::ranges::find(out_.variables, name, &FileVariable::name) != out_.variables.end();
  };
  if (!plain || taken()) name += "_" + group.level.name;
  if (taken()) return;
  std::vector<FileAttribute> attributes = {text("units", group.parameter.units),
                                           text("long_name", group.parameter.long_name)};
  if (!group.parameter.standard_name.empty())
    attributes.push_back(text("standard_name", group.parameter.standard_name));
  for (const auto& [key, value] : group.parameter.said)
    attributes.push_back(text(key.c_str(), value));
  const Grid& grid = table_.grids[std::size_t(choice_.grid)];
  if (!grid.mapping.empty()) attributes.push_back(text("grid_mapping", "crs"));
  if (grid.kind == Grid::Kind::kCells) attributes.push_back(text("grid_type", "unstructured"));
  if (grid.kind == Grid::Kind::kPlaces)
    attributes.push_back(text("coordinates", "latitude longitude"));
  variable(name, std::move(dimensions), std::move(attributes), std::move(values));
}

}  // namespace

CfDataset cf_dataset(const FieldTable& table) {
  return Builder(table).take();
}

}  // namespace nepho::grib
