// CF files and what is near to them: coordinates by units and attributes, grids of latitude and
// longitude or of a map, levels of height or pressure. CF Conventions 1.11.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/dimension_roles.h"
#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/grid_mapping.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/unstructured.h"
#include "forecast/conventions/vertical.h"
#include "forecast/files/file_time.h"
#include "forecast/water/air.h"
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
  const FileVariable *temperature = nullptr, *vapour = nullptr, *terrain = nullptr, *land = nullptr;
  UnitOf terrain_unit;  // to m: of a height, or of a geopotential
  Vapour vapour_is = Vapour::kNone;
  double pressure_factor = 1;
  std::optional<std::vector<float>> standard_Pa;  // of heights, where no pressure is known

  std::vector<float> field(const FileVariable& variable, std::size_t time) const {
    return reader->field(variable, roles.z, vertical.from_top, time);
  }
  Air air(std::size_t time) const;
  ForecastGround ground(std::size_t time) const;
  std::vector<float> terrain_m(std::size_t time) const;
  void restrict_to(const Region& region, Model& model);
  void find_water_in(Model& model) const;
  void find_air();
  void find_ground();
  void choose_pressure(Model& model);
  void make_standard_air();
  std::vector<std::int64_t> times_ns(Model& model) const;
  void say_air(Model& model) const;
};

void scale(std::vector<float>& values, const UnitOf& unit) {
  if (unit.factor == 1 && unit.offset == 0) return;
  for (float& value : values) value = float(double(value) * unit.factor + unit.offset);
}

Air CfFile::air(std::size_t time) const {
  Air air;
  if (!vertical.level_pressure_Pa.empty()) {
    air.level_pressure_Pa = vertical.level_pressure_Pa;
  } else if (vertical.pressure) {
    air.pressure_Pa = field(*vertical.pressure, time);
    for (float& p : air.pressure_Pa) p *= float(pressure_factor);
  } else if (vertical.pressure_Pa) {
    air.pressure_Pa = vertical.pressure_Pa(time);
  } else if (standard_Pa) {
    air.pressure_Pa = *standard_Pa;
  }
  if (temperature) {
    air.temperature_K = field(*temperature, time);
    scale(air.temperature_K, unit_of(*temperature, kTemperature));
  }
  if (vapour) {
    air.vapour = field(*vapour, time);
    air.vapour_is = vapour_is;
    scale(air.vapour, unit_of(*vapour, kDimensionless));
  }
  return air;
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
  const bool has_ice =
      std::ranges::any_of(model.water, [](const WaterVariable& w) { return is_ice(w.species); });
  for (WaterVariable& water : model.water)
    if (!has_ice && is_whole_condensate(water)) {
      water.freezes_below_K = kWholeCondensateFreezes_K;
      model.assumptions.push_back(water.variable->name +
                                  " holds liquid and ice: ice below -15 degC is assumed.");
    }
  model.cloud_fraction = find_named(*file, names::kCloudFraction, accept);
  model.droplet_number = find_named(*file, names::kDropletNumber, accept);
}

void CfFile::find_air() {
  const auto on_levels = [&](const Dimension& dimension) {
    return [this, dimension](const FileVariable& v) {
      return reader->is_field(v, roles.z) && unit_of(v, dimension).fits;
    };
  };
  temperature = find_named(*file, names::kTemperature, on_levels(kTemperature));
  const auto humidity = [&](const VariableNames& names, Vapour kind) {
    if (vapour) return;
    vapour = find_named(*file, names, on_levels(kDimensionless));
    if (vapour) vapour_is = kind;
    // `r` is relative humidity to some and a mixing ratio to others.
    if (vapour && kind == Vapour::kRelative && vapour->text("units").find('g') != std::string::npos)
      vapour_is = Vapour::kMixingRatio;
  };
  humidity(names::kSpecificHumidity, Vapour::kSpecific);
  humidity(names::kVapourMixingRatio, Vapour::kMixingRatio);
  humidity(names::kRelativeHumidity, Vapour::kRelative);
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

// Densities of heights without pressure: the standard atmosphere's at the middle of the layers.
void CfFile::make_standard_air() {
  const std::vector<float> z = vertical.interfaces_m(0, nullptr);
  const std::size_t nz = file->size(roles.z), cells = z.size() / (nz + 1);
  std::vector<float> pressure(nz * cells);
  for (std::size_t n = 0; n < cells; ++n)
    for (std::size_t k = 0; k < nz; ++k) {
      const double middle = 0.5 * (double(z[n * (nz + 1) + k]) + double(z[n * (nz + 1) + k + 1]));
      constexpr double kRadius_m = 6356766;
      pressure[k * cells + n] =
          float(nepho::forecast::standard_pressure_Pa(kRadius_m * middle / (kRadius_m + middle)));
    }
  standard_Pa = std::move(pressure);
}

void CfFile::choose_pressure(Model& model) {
  if (vertical.level_pressure_Pa.empty() && !vertical.pressure)
    vertical.pressure = find_named(*file, names::kPressure, [&](const FileVariable& v) {
      return reader->is_field(v, roles.z) && unit_of(v, kPressure).fits;
    });
  if (vertical.pressure) pressure_factor = unit_of(*vertical.pressure, kPressure).factor;
  const bool per_volume = std::ranges::all_of(
      model.water, [](const WaterVariable& w) { return w.basis == Basis::kVolume; });
  if (vertical.level_pressure_Pa.empty() && !vertical.pressure && !vertical.pressure_Pa) {
    make_standard_air();
    if (!per_volume)
      model.assumptions.push_back(
          "There is no pressure: air densities are the standard atmosphere's at these heights.");
  }
  if (!temperature && !per_volume)
    model.assumptions.push_back(
        "There is no temperature: the standard atmosphere's is taken for densities.");
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
  if (axis) {
    FileTimes times = read_times(*file, *axis);
    std::ranges::move(times.assumptions, std::back_inserter(model.assumptions));
    return std::move(times.utc_ns);
  }
  if (roles.time >= 0 && file->size(roles.time) > 1)
    throw Error({"the file does not say which times it holds",
                 file->path() + " [" + file->name(roles.time) + "]",
                 "a coordinate with units such as \"hours since 2000-01-01\"", "none", ""});
  return no_time();
}

// By the attributes that files have for it; models rarely sign.
std::string model_name(const DataFile& file) {
  std::string name;
  for (const char* attribute : {"source", "title", "institution", "Conventions"})
    if (const std::string text = file.text(attribute);
        std::ranges::any_of(text, [](unsigned char c) { return std::isalnum(c); }))
      name += (name.empty() ? "" : "; ") + text.substr(0, text.find('\n')).substr(0, 80);
  return name.empty() ? "not said" : name;
}

void CfFile::say_air(Model& model) const {
  std::string air = vertical.pressure                     ? "pressure " + vertical.pressure->name
                    : !vertical.level_pressure_Pa.empty() ? "pressure of the levels"
                    : vertical.pressure_Pa                ? "pressure by formula"
                                                          : "";
  const auto add = [&](const FileVariable* variable, const char* what) {
    if (variable) air += (air.empty() ? "" : ", ") + (what + variable->name);
  };
  add(temperature, "temperature ");
  add(vapour, "humidity ");
  add(terrain, "ground ");
  add(land, "land ");
  if (!air.empty()) model.recognised.push_back({"air and ground", air});
}

// The variable whose dimensions stand for all: the first water that has any grid.
const FileVariable* first_water(const DataFile& file) {
  const auto found =
      find_water(file, [](const FileVariable& v) { return v.dimensions.size() >= 2; });
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
  model.recognised = {{"model", model_name(file)},
                      {"grid", std::to_string(cf->grid->nx()) + " x " +
                                   std::to_string(cf->grid->ny()) + " cells, " + how}};
  reader.nx = cf->grid->nx();
  reader.ny = cf->grid->ny();
  if (region) cf->restrict_to(*region, model);
  model.nx = reader.nx;
  model.ny = reader.ny;
  model.nz = int(file.size(cf->roles.z));
  model.utc_ns = cf->times_ns(model);
  cf->find_water_in(model);
  cf->find_air();
  cf->find_ground();
  // `vertical` is part of the CfFile that these ask: a shared pointer would never let go.
  const CfFile* self = cf.get();
  VerticalRequest request{cf->reader,
                          &first,
                          cf->roles.z,
                          cf->temperature,
                          [self](std::size_t time) { return self->air(time); },
                          {}};
  if (cf->terrain) request.terrain_m = [self](std::size_t time) { return self->terrain_m(time); };
  cf->vertical = find_vertical(request);
  cf->choose_pressure(model);
  const auto say = [](std::vector<std::string>& to, const std::vector<std::string>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  say(model.assumptions, cf->vertical.assumptions);
  say(model.facts, cf->vertical.facts);
  model.recognised.push_back(
      {"levels", std::to_string(model.nz) + " levels, " + cf->vertical.how +
                     (cf->vertical.from_top ? ", from the top down" : ", from the ground up")});
  cf->say_air(model);
  model.heights_change = cf->vertical.heights_change;
  model.heights_on_ellipsoid = cf->vertical.on_ellipsoid;
  model.field = [cf](const FileVariable& v, std::size_t time) { return cf->field(v, time); };
  model.grid = [cf](std::size_t) { return cf->grid; };
  model.air = [cf](std::size_t time) { return cf->air(time); };
  model.interfaces_m = cf->vertical.interfaces_m;
  model.height_range_m = cf->vertical.height_range_m;
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
  return make_forecast(model_of(cf, request.region, grid_file.get()), request);
}

}  // namespace

const Convention kCf = {"CF", recognise, open_cf};

}  // namespace nepho::forecast
