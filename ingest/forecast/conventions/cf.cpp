// CF files and what is near to them: coordinates by units and attributes, grids of latitude and
// longitude or of a map, levels of height or pressure. CF Conventions 1.11.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/cf_air.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/dimension_roles.h"
#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/grid_mapping.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/particle_sizes.h"
#include "forecast/conventions/plain_times.h"
#include "forecast/conventions/unstructured.h"
#include "forecast/conventions/vertical.h"
#include "forecast/files/file_time.h"
#include "forecast/water/assumed_water.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

// All that the hooks of the Model share.
struct CfFile {
  std::shared_ptr<const DataFile> file;
  DimensionRoles roles;
  std::shared_ptr<FieldReader> reader = std::make_shared<FieldReader>();
  Vertical vertical;
  std::shared_ptr<const HorizontalGrid> grid;
  std::optional<CfAir> air;
  const FileVariable *terrain = nullptr, *land = nullptr;
  UnitOf terrain_unit;  // to m: of a height, or of a geopotential

  std::vector<float> field(const FileVariable& variable, std::size_t time) const {
    return reader->field(variable, roles.z, vertical.from_top, time);
  }
  ForecastGround ground(std::size_t time) const;
  std::vector<float> terrain_m(std::size_t time) const;
  void restrict_to(const Region& region, Model& model);
  void find_water_in(Model& model) const;
  void find_ground();
  std::vector<std::int64_t> times_ns(Model& model) const;
};

void scale(std::vector<float>& values, const UnitOf& unit) {
  if (unit.factor == 1 && unit.offset == 0) return;
  for (float& value : values) value = float(double(value) * unit.factor + unit.offset);
}

std::vector<float> CfFile::terrain_m(std::size_t time) const {
  std::vector<float> height = reader->surface(*terrain, time);
  scale(height, terrain_unit);
  return height;
}

ForecastGround CfFile::ground(std::size_t time) const {
  ForecastGround ground;
  if (terrain) ground.height_m = terrain_m(time);
  if (land) {
    const bool percent = land->text("units") == "%";
    ground.water = reader->surface(*land, time);
    for (float& value : ground.water) value = 1 - (percent ? value / 100 : value);
  }
  return ground;
}

void CfFile::restrict_to(const Region& region, Model& model) {
  const CellWindow window = window_of({&grid, 1}, region, file->path());
  model.facts.push_back(window_fact(region, window, *grid));
  reader->restrict_to(window, grid->around());
  grid = windowed(grid, window);
}

void CfFile::find_water_in(Model& model) const {
  const auto accept = [this](const FileVariable& v) { return reader->is_field(v, roles.z); };
  model.water = find_water(*file, accept);
  divide_phases(model.water, model.assumptions);
  model.cloud_fraction = find_named(*file, names::kCloudFraction, accept);
  find_sizes(accept, model);
  if (!model.water.empty()) return;
  WaterVariable assumed;
  assumed.variable = model.cloud_fraction;
  assumed.basis = Basis::kVolume;
  assumed.freezes_below_K = kAssumedIce_K;
  assumed.liquid_above_K = kAssumedLiquid_K;
  assumed.from_fraction = true;
  model.water.push_back(assumed);
  model.assumptions.push_back(
      "There is no cloud water, only the cloud fraction " + model.cloud_fraction->name +
      ": a cell's cloudy part is assumed to hold 0.21 g/m3 exp(-z / h) of water at the height z "
      "over "
      "the ground, h = 700 m ln(1 + column vapour in kg/m2), ice from -10 degC to -30 degC (Kiehl "
      "et "
      "al. 1998)" +
      (air->has_vapour() ? "." : "; there is no vapour, 25 kg/m2 are taken."));
}

void CfFile::find_ground() {
  terrain = find_named(*file, names::kTerrain, [&](const FileVariable& v) {
    return reader->is_surface(v) && unit_of(v, kLength).fits;
  });
  if (terrain) {
    terrain_unit = unit_of(*terrain, kLength);
  } else {
    terrain = find_named(*file, names::kSurfaceGeopotential, [&](const FileVariable& v) {
      return reader->is_surface(v) && unit_of(v, kGeopotentialUnit).fits;
    });
    if (terrain) {
      terrain_unit = unit_of(*terrain, kGeopotentialUnit);
      terrain_unit.factor /= constants::kStandardGravity_m_per_s2;
    }
  }
  land = find_named(*file, names::kLandFraction,
                    [&](const FileVariable& v) { return reader->is_surface(v); });
}

std::vector<std::int64_t> CfFile::times_ns(Model& model) const {
  const auto no_time = [&] {
    model.assumptions.push_back("The file does not say its time: 1970-01-01 00:00 UTC is taken.");
    return std::vector<std::int64_t>{0};
  };
  const FileVariable* axis = roles.time >= 0 ? file->find(file->name(roles.time)) : nullptr;
  if (roles.time >= 0 && file->size(roles.time) == 0)
    throw Error({"the file has no times", file->path(), "at least one",
                 file->name(roles.time) + " = 0", ""});
  const auto is_axis = [&](const FileVariable& v) {
    return v.numeric && is_time_unit(v.text("units")) &&
           (roles.time >= 0 ? v.dimensions == std::vector<int>{roles.time} : v.dimensions.empty());
  };
  if (!axis || !is_axis(*axis)) {
    // A coordinate of another name, or a scalar.
    const auto at = std::ranges::find_if(file->variables(), is_axis);
    axis = at == file->variables().end() ? nullptr : &*at;
  }
  if (axis) return read_times_ns(*file, *axis);
  if (roles.time >= 0)
    if (const auto plain = plain_times_ns(*file, roles.time)) {
      model.assumptions.push_back("The times count from no date: from 1970-01-01 00:00 UTC on.");
      return *plain;
    }
  if (roles.time >= 0 && file->size(roles.time) > 1)
    throw Error({"the file does not say which times it holds",
                 file->path() + " [" + file->name(roles.time) + "]",
                 "a coordinate with units such as \"hours since 2000-01-01\"", "none", ""});
  return no_time();
}

// A cloud fraction on levels, for files without water; null where there is none.
const FileVariable* first_fraction(const DataFile& file) {
  return find_named(file, names::kCloudFraction, [&](const FileVariable& v) {
    if (!v.numeric || v.dimensions.size() < 2) return false;
    try {
      return dimension_roles(file, v).z >= 0;
    } catch (const Error&) {
      return false;  // the cover of columns
    }
  });
}

// The variable whose dimensions stand for all: the first water that has any grid.
const FileVariable* first_water(const DataFile& file) {
  const auto found =
      find_water(file, [](const FileVariable& v) { return v.dimensions.size() >= 2; });
  if (found.empty())
    if (const FileVariable* fraction = first_fraction(file)) return fraction;
  require_water(file, found);
  return found.front().variable;
}

void check_dimensions(const CfFile& cf, const FileVariable& water) {
  for (const int d : water.dimensions)
    if (d != cf.roles.time && d != cf.roles.z && d != cf.roles.y && d != cf.roles.x &&
        cf.file->size(d) > 1)
      throw Error({"the cloud water has a dimension too many", cf.file->where(water),
                   "time, level, y and x", cf.file->shape_text(water),
                   "choose one index first, for example with ncks -d " + cf.file->name(d) + ",0"});
}

Model model_of(const std::shared_ptr<CfFile>& cf, const std::optional<Region>& region,
               const DataFile* grid_file) {
  const DataFile& file = *cf->file;
  const FileVariable& first = *first_water(file);
  cf->roles = dimension_roles(file, first);
  Model model;
  model.convention = "CF";
  model.file = cf->file;
  check_dimensions(*cf, first);
  FieldReader& reader = *cf->reader;
  reader.file = cf->file;
  reader.time = cf->roles.time;
  reader.y = cf->roles.y;
  reader.x = cf->roles.x;
  std::string how;
  if (grid_file && cf->roles.cells < 0)
    model.facts.push_back("The grid file " + grid_file->path() +
                          " is not used: the data have rows and columns.");
  cf->grid = cf->roles.cells >= 0 ? unstructured_grid(file, grid_file, first, cf->roles.cells,
                                                      model.assumptions, how)
                                  : cf_grid(file, cf->roles, reader, first, model.assumptions, how);
  model.facts.push_back("Grid: " + std::to_string(cf->grid->nx()) + " x " +
                        std::to_string(cf->grid->ny()) + " cells, " + how + ".");
  reader.nx = cf->grid->nx();
  reader.ny = cf->grid->ny();
  if (region) cf->restrict_to(*region, model);
  model.nx = reader.nx;
  model.ny = reader.ny;
  model.nz = int(file.size(cf->roles.z));
  model.utc_ns = cf->times_ns(model);
  cf->air.emplace(cf->reader, cf->roles.z);
  cf->find_water_in(model);
  cf->find_ground();
  // `vertical` is part of the CfFile that these ask: a shared pointer would never let go.
  const CfFile* self = cf.get();
  VerticalRequest request{cf->reader,
                          &first,
                          cf->roles.z,
                          cf->air->temperature(),
                          [self](std::size_t time) { return self->air->at(time, self->vertical); },
                          {}};
  if (cf->terrain) request.terrain_m = [self](std::size_t time) { return self->terrain_m(time); };
  cf->vertical = find_vertical(request);
  cf->air->choose_pressure(cf->vertical, model.water, model.assumptions, model.facts);
  const auto say = [](std::vector<std::string>& to, const std::vector<std::string>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  say(model.assumptions, cf->vertical.assumptions);
  say(model.facts, cf->vertical.facts);
  say(model.assumptions, cf->air->untested_names(cf->vertical));
  model.heights_change = cf->vertical.heights_change;
  model.heights_on_ellipsoid = cf->vertical.on_ellipsoid;
  model.field = [cf](const FileVariable& v, std::size_t time) { return cf->field(v, time); };
  model.grid = [cf](std::size_t) { return cf->grid; };
  model.air = [cf](std::size_t time) { return cf->air->at(time, cf->vertical); };
  model.interfaces_m = cf->vertical.interfaces_m;
  model.height_range_m = cf->vertical.height_range_m;
  model.has_land_mask = cf->land;
  if (cf->terrain || cf->land) model.ground = [cf](std::size_t time) { return cf->ground(time); };
  return model;
}

// Whatever no other convention claims.
int recognise(const DataFile&) {
  return 1;
}

std::unique_ptr<Forecast> open_cf(std::shared_ptr<const DataFile> file,
                                  const OpenRequest& request) {
  auto cf = std::make_shared<CfFile>();
  cf->file = std::move(file);
  std::shared_ptr<const DataFile> grid_file;
  if (!request.grid_file.empty()) grid_file = request.open_file(request.grid_file);
  return make_forecast(model_of(cf, request.region, grid_file.get()), request.force);
}

}  // namespace

const Convention kCf = {"CF", recognise, open_cf};

}  // namespace nepho::forecast
