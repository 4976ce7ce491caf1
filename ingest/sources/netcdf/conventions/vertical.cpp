#include "conventions/vertical.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "air.h"
#include "core/error.h"
#include "level_heights.h"
#include "units/constants.h"

namespace nepho::netcdf {
namespace {

constexpr Dimension kGeopotentialUnit{.m = 2, .s = -2};
// Of all interfaces: more that must be lifted, and the levels are no levels.
constexpr double kMostLifted = 0.01;
constexpr double kMissingLevelStep_m = 100;

using Interfaces = std::function<std::vector<float>(std::size_t, const Air*)>;

[[noreturn]] void refuse_levels(const std::string& where, const std::string& found) {
  throw Error({"the levels neither rise nor fall", where, "heights or pressures in order", found,
               "write the file again with its levels in order"});
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (std::size_t n = 0; n < values.size() && n < 6; ++n) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%g", n ? ", " : "", values[n]);
    text += number;
  }
  return text + (values.size() > 6 ? ", ..." : "");
}

// 1 rising, -1 falling; throws otherwise.
int direction(const std::vector<double>& values, const std::string& where) {
  int sign = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const int step = values[k] > values[k - 1] ? 1 : values[k] < values[k - 1] ? -1 : 0;
    if (step == 0 || (sign && step != sign)) refuse_levels(where, numbers(values));
    sign = step;
  }
  if (values.size() == 1 && !std::isfinite(values[0])) refuse_levels(where, "a missing value");
  return sign ? sign : 1;
}

// Heights that are missing, in columns of levels: between neighbours, or in steps from the nearest.
void fill_levels(std::vector<double>& level_m) {
  const auto valid = [](double z) { return std::isfinite(z); };
  const auto first = std::ranges::find_if(level_m, valid);
  if (first == level_m.end()) {
    for (std::size_t k = 0; k < level_m.size(); ++k) level_m[k] = kMissingLevelStep_m * double(k);
    return;
  }
  for (auto at = first; at != level_m.begin(); --at) *(at - 1) = *at - kMissingLevelStep_m;
  for (std::size_t k = 1; k < level_m.size(); ++k) {
    if (valid(level_m[k])) continue;
    std::size_t next = k;
    while (next < level_m.size() && !valid(level_m[next])) ++next;
    const double step = next < level_m.size()
                            ? (level_m[next] - level_m[k - 1]) / double(next - k + 1)
                            : kMissingLevelStep_m;
    level_m[k] = level_m[k - 1] + step;
  }
}

// One file's levels; hooks hold it.
struct Levels {
  VerticalRequest request;
  const NcVariable* variable = nullptr;
  int z = -1;  // of `variable`
  bool from_top = false;
  double factor = 1, offset = 0;
  bool geopotential = false;  // of geopotential height, after the factor

  const FieldReader& reader() const { return *request.reader; }
  const NcFile& file() const { return *reader().file; }
  int nz() const { return int(file().size(request.z)); }
  std::size_t cells() const { return std::size_t(reader().nx) * std::size_t(reader().ny); }

  double height_m(double value) const {
    const double height = value * factor + offset;
    return geopotential ? height_of_geopotential_height_m(height) : height;
  }
  std::vector<double> terrain(std::size_t time) const {
    if (!request.terrain_m) return std::vector<double>(cells(), NAN);
    const std::vector<float> heights = request.terrain_m(time);
    return {heights.begin(), heights.end()};
  }
  // Refuses where too much had to be lifted.
  std::vector<float> checked(std::vector<float> interfaces) const {
    const std::size_t lifted = make_rising(interfaces, std::size_t(nz()) + 1);
    if (double(lifted) > kMostLifted * double(interfaces.size()))
      refuse_levels(file().where(*variable), std::to_string(lifted) + " of " +
                                                 std::to_string(interfaces.size()) +
                                                 " heights below the one beneath, or missing");
#ifdef NEPHO_MUTANT_FLIPPED_LEVELS
    const std::size_t count = std::size_t(nz()) + 1;
    for (std::size_t at = 0; at < interfaces.size(); at += count) {
      const float low = interfaces[at], high = interfaces[at + count - 1];
      std::reverse(interfaces.begin() + std::ptrdiff_t(at),
                   interfaces.begin() + std::ptrdiff_t(at + count));
      for (std::size_t k = 0; k < count; ++k) interfaces[at + k] = low + high - interfaces[at + k];
    }
#endif
    return interfaces;
  }
  std::vector<float> of_levels(const std::vector<float>& field, std::size_t time) const;
};

// [k][j][i] heights of levels, in the file's unit, to interfaces.
std::vector<float> Levels::of_levels(const std::vector<float>& field, std::size_t time) const {
  const std::size_t count = std::size_t(nz());
  const std::vector<double> ground = terrain(time);
  std::vector<float> result(cells() * (count + 1));
  std::vector<double> level(count);
  for (std::size_t n = 0; n < cells(); ++n) {
    for (std::size_t k = 0; k < count; ++k) level[k] = height_m(double(field[k * cells() + n]));
    fill_levels(level);
    interfaces_of_levels_m(level, ground[n], {&result[n * (count + 1)], count + 1});
  }
  return checked(std::move(result));
}

// Most columns' first level is above their last.
bool falls(const std::vector<float>& field, std::size_t cells) {
  std::size_t falling = 0, rising = 0;
  const std::size_t last = field.size() - cells;
  for (std::size_t n = 0; n < cells; ++n) {
    falling += field[n] > field[last + n];
    rising += field[n] < field[last + n];
  }
  return falling > rising;
}

bool varies(const NcVariable& variable, int dimension) {
  return std::ranges::find(variable.dimensions, dimension) != variable.dimensions.end();
}

UnitOf height_unit(const NcVariable& variable) {
  const std::string unit = variable.text("units");
  if (unit == "gpm" || unit == "geopotential meter" || unit == "geopotential metre")
    return {true, 1, 0};
  return unit_of(variable, kLength);
}

std::shared_ptr<Levels> levels_of(const VerticalRequest& request, const NcVariable& variable,
                                  int z) {
  auto levels = std::make_shared<Levels>();
  levels->request = request;
  levels->variable = &variable;
  levels->z = z;
  return levels;
}

using Way = bool (*)(const VerticalRequest&, Vertical&);

bool by_half_levels(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const NcFile& file = *reader.file;
  int z = -1;
  const NcVariable* half = find_named(file, names::kHalfLevelHeight, [&](const NcVariable& v) {
    for (const int d : v.dimensions)
      if (file.size(d) == file.size(request.z) + 1 && reader.is_field(v, d) && d != reader.x &&
          d != reader.y && d != reader.time) {
        z = d;
        return height_unit(v).fits;
      }
    return false;
  });
  if (!half) return false;
  auto levels = levels_of(request, *half, z);
  levels->factor = height_unit(*half).factor;
  levels->from_top = falls(reader.field(*half, z, false, 0), levels->cells());
  vertical.from_top = levels->from_top;
  vertical.heights_change = varies(*half, reader.time);
  vertical.how = "half levels " + half->name;
  vertical.interfaces_m = [levels](std::size_t time, const Air*) {
    const std::vector<float> field =
        levels->reader().field(*levels->variable, levels->z, levels->from_top, time);
    const std::size_t cells = levels->cells(), count = std::size_t(levels->nz()) + 1;
    std::vector<float> result(field.size());
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < cells; ++n)
        result[n * count + k] = float(levels->height_m(double(field[k * cells + n])));
    return levels->checked(std::move(result));
  };
  return true;
}

// A field of level heights: geometric, geopotential height, or geopotential.
bool by_level_field(const VerticalRequest& request, Vertical& vertical, const VariableNames& wanted,
                    const std::function<UnitOf(const NcVariable&)>& unit, double scale,
                    bool geopotential) {
  const FieldReader& reader = *request.reader;
  const NcVariable* found = find_named(*reader.file, wanted, [&](const NcVariable& v) {
    return reader.is_field(v, request.z) && unit(v).fits;
  });
  if (!found) return false;
  auto levels = levels_of(request, *found, request.z);
  levels->factor = unit(*found).factor * scale;
  levels->geopotential = geopotential;
  levels->from_top = falls(reader.field(*found, request.z, false, 0), levels->cells());
  vertical.from_top = levels->from_top;
  vertical.heights_change = varies(*found, reader.time);
  vertical.how = (geopotential ? "geopotential levels " : "levels ") + found->name;
  vertical.interfaces_m = [levels](std::size_t time, const Air*) {
    return levels->of_levels(
        levels->reader().field(*levels->variable, levels->z, levels->from_top, time), time);
  };
  // Two levels at each end are enough for the outermost interfaces.
  if (levels->nz() >= 4)
    vertical.height_range_m = [levels](std::size_t time) {
      const int nz = levels->nz();
      glm::dvec2 range{1e30, -1e30};
      const auto ends = [&](int first) {
        return levels->reader().levels(*levels->variable, levels->z, levels->from_top, time, first,
                                       2);
      };
      const std::vector<float> low = ends(0), high = ends(nz - 2);
      const std::size_t cells = levels->cells();
      for (std::size_t n = 0; n < cells; ++n) {
        const double a = levels->height_m(double(low[n])),
                     b = levels->height_m(double(low[cells + n]));
        const double c = levels->height_m(double(high[n]));
        const double d = levels->height_m(double(high[cells + n]));
        if (std::isfinite(a) && std::isfinite(b)) range.x = std::min(range.x, a - 0.5 * (b - a));
        if (std::isfinite(c) && std::isfinite(d)) range.y = std::max(range.y, d + 0.5 * (d - c));
      }
      return range;
    };
  return true;
}

bool by_level_heights(const VerticalRequest& request, Vertical& vertical) {
  return by_level_field(request, vertical, names::kFullLevelHeight, height_unit, 1, false);
}

bool by_geopotential_height(const VerticalRequest& request, Vertical& vertical) {
  return by_level_field(request, vertical, names::kGeopotentialHeight, height_unit, 1, true);
}

bool by_geopotential(const VerticalRequest& request, Vertical& vertical) {
  return by_level_field(
      request, vertical, names::kGeopotential,
      [](const NcVariable& v) { return unit_of(v, kGeopotentialUnit); },
      1 / constants::kStandardGravity_m_per_s2, true);
}

// Hydrostatic columns over the surface, or over mean sea level at 1013.25 hPa.
struct Hydrostatic {
  std::shared_ptr<Levels> levels;
  std::vector<double> pressure_Pa;  // of levels, from the ground up; or
  const NcVariable* surface_pressure = nullptr;
  double surface_factor = 1;

  std::vector<float> interfaces_m(std::size_t time, const Air* known) const {
    const Air own = known ? Air{} : levels->request.air(time);
    const Air& air = known ? *known : own;
    const std::size_t cells = levels->cells(), nz = std::size_t(levels->nz());
    std::vector<float> surface;
    if (surface_pressure) surface = levels->reader().surface(*surface_pressure, time);
    const std::vector<double> ground = levels->terrain(time);
    std::vector<float> result(cells * (nz + 1));
    std::vector<double> p(nz), tv(nz), z(nz);
    for (std::size_t n = 0; n < cells; ++n) {
      for (std::size_t k = 0; k < nz; ++k) {
        const Air::State state = air.at(k, n, cells);
        p[k] = state.pressure_Pa;
        tv[k] = virtual_temperature_K(state.temperature_K, state.specific_humidity);
      }
      const bool known_ground = !surface.empty() && std::isfinite(ground[n]);
      hypsometric_heights_m(
          p, tv, known_ground ? double(surface[n]) * surface_factor : kStandardSurfacePressure_Pa,
          known_ground ? ground[n] : 0, z);
      for (double& height : z) height = height_of_geopotential_height_m(height);
      fill_levels(z);
      interfaces_of_levels_m(z, ground[n], {&result[n * (nz + 1)], nz + 1});
    }
    return levels->checked(std::move(result));
  }
};

void set_hydrostatic(const VerticalRequest& request, Vertical& vertical,
                     const NcVariable& variable) {
  auto column = std::make_shared<Hydrostatic>();
  column->levels = levels_of(request, variable, request.z);
  const FieldReader& reader = *request.reader;
  column->surface_pressure = find_named(
      *reader.file, names::kSurfacePressure,
      [&](const NcVariable& v) { return reader.is_surface(v) && unit_of(v, kPressure).fits; });
  if (column->surface_pressure && request.terrain_m) {
    column->surface_factor = unit_of(*column->surface_pressure, kPressure).factor;
  } else {
    column->surface_pressure = nullptr;
    vertical.assumptions.push_back(
        "Heights are hydrostatic over 1013.25 hPa at sea level: there is no surface pressure with "
        "its terrain.");
  }
  if (!request.temperature)
    vertical.assumptions.push_back(
        "There is no temperature: heights and densities are the standard atmosphere's.");
  vertical.heights_change = true;
  vertical.how = "hydrostatic from " + variable.name;
  vertical.interfaces_m = [column](std::size_t time, const Air* air) {
    return column->interfaces_m(time, air);
  };
}

bool by_pressure_levels(const VerticalRequest& request, Vertical& vertical) {
  const NcFile& file = *request.reader->file;
  const PressureLevels levels = pressure_levels(file, request.z);
  if (levels.pressure_Pa.empty()) return false;
  set_hydrostatic(request, vertical, *file.find(file.name(request.z)));
  vertical.from_top = levels.from_top;
  return true;
}

bool by_pressure_field(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const NcVariable* found = find_named(*reader.file, names::kPressure, [&](const NcVariable& v) {
    return reader.is_field(v, request.z) && unit_of(v, kPressure).fits;
  });
  if (!found) return false;
  const std::size_t cells = std::size_t(reader.nx) * std::size_t(reader.ny);
  vertical.from_top = !falls(reader.field(*found, request.z, false, 0), cells);
  vertical.pressure = found;
  set_hydrostatic(request, vertical, *found);
  return true;
}

// CF's `height` is above the ground, `altitude` above the geoid.
bool by_height_axis(const VerticalRequest& request, Vertical& vertical) {
  const NcFile& file = *request.reader->file;
  const NcVariable* axis = file.find(file.name(request.z));
  if (!axis || axis->dimensions.size() != 1 || !axis->numeric()) return false;
  const UnitOf unit = height_unit(*axis);
  if (!unit.fits) return false;
  std::vector<double> level = file.read_all(*axis);
  const double sign = axis->text("positive") == "down" ? -1 : 1;
  for (double& z : level) z = sign * z * unit.factor;
  auto levels = levels_of(request, *axis, request.z);
  levels->from_top = direction(level, file.where(*axis)) < 0;
  vertical.from_top = levels->from_top;
  if (vertical.from_top) std::ranges::reverse(level);
  const bool above_ground = axis->text("standard_name") == "height" && request.terrain_m;
  vertical.how = std::string("heights ") + (above_ground ? "above ground " : "") + axis->name;
  if (!above_ground && axis->text("standard_name") != "altitude")
    vertical.assumptions.push_back("Heights of " + axis->name + " are taken as above sea level.");
  vertical.interfaces_m = [levels, level, above_ground](std::size_t time, const Air*) {
    const std::vector<double> ground = levels->terrain(time);
    const std::size_t count = level.size() + 1;
    std::vector<float> result(levels->cells() * count);
    std::vector<double> column = level;
    for (std::size_t n = 0; n < levels->cells(); ++n) {
      const double base = above_ground && std::isfinite(ground[n]) ? ground[n] : 0;
      for (std::size_t k = 0; k < level.size(); ++k) column[k] = level[k] + base;
      // Nothing of a model lies below its ground, or below the sea where it has none.
      const double floor_m = std::isfinite(ground[n]) ? ground[n] : 0;
      interfaces_of_levels_m(column, floor_m, {&result[n * count], count});
    }
    return levels->checked(std::move(result));
  };
  return true;
}

}  // namespace

UnitOf unit_of(const NcVariable& variable, const Dimension& wanted) {
  const std::string text = variable.text("units");
  if (text == "millibars" || text == "millibar" || text == "mb")
    return {wanted == kPressure, 100, 0};
  if (text.empty()) return {};
  try {
    const Unit unit = parse_unit(text);
    return {unit.dimension == wanted, unit.factor, unit.offset};
  } catch (const Error&) {
    return {};
  }
}

PressureLevels pressure_levels(const NcFile& file, int z) {
  PressureLevels levels;
  const NcVariable* axis = file.find(file.name(z));
  if (!axis || axis->dimensions.size() != 1 || !axis->numeric()) return levels;
  const UnitOf unit = unit_of(*axis, kPressure);
  if (!unit.fits) return levels;
  levels.pressure_Pa = file.read_all(*axis);
  for (double& p : levels.pressure_Pa) p = p * unit.factor + unit.offset;
  levels.from_top = direction(levels.pressure_Pa, file.where(*axis)) > 0;
  if (levels.pressure_Pa.size() == 1) levels.from_top = false;
  if (levels.from_top) std::ranges::reverse(levels.pressure_Pa);
  if (!(levels.pressure_Pa.back() > 0))
    refuse_levels(file.where(*axis), "a pressure of " + std::to_string(levels.pressure_Pa.back()));
  return levels;
}

Vertical find_vertical(const VerticalRequest& request) {
  static constexpr std::array<Way, 7> kWays = {
      by_half_levels,     by_level_heights, by_geopotential_height, by_geopotential,
      by_pressure_levels, by_height_axis,   by_pressure_field};
  Vertical vertical;
  const NcFile& file = *request.reader->file;
  // Refused here whatever else there is: an axis out of order.
  const PressureLevels levels = pressure_levels(file, request.z);
  for (const Way way : kWays)
    if (way(request, vertical)) {
      vertical.level_pressure_Pa = levels.pressure_Pa;
      if (!levels.pressure_Pa.empty() && levels.from_top != vertical.from_top)
        refuse_levels(file.path() + " [" + file.name(request.z) + "]",
                      "pressures in another order than the heights (" + vertical.how + ")");
      if (file.size(request.z) < 2 && way != by_half_levels)
        throw Error({"one level has no thickness", file.path(), "at least two levels",
                     file.name(request.z) + " of size 1", ""});
      vertical.facts.push_back("Heights: " + vertical.how + ".");
      return vertical;
    }
  const NcVariable* axis = file.find(file.name(request.z));
  const std::string unit = axis ? "\"" + axis->text("units") + "\"" : "no such variable";
  throw Error({"the levels are neither heights nor pressures",
               file.path() + " [" + file.name(request.z) + "]",
               "units of length or pressure, or a field of heights, geopotential or pressure on "
               "these levels",
               "units " + unit, "hybrid levels need their heights or pressures as a variable"});
}

}  // namespace nepho::netcdf
