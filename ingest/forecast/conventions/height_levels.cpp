// Levels whose heights the file gives: of half levels, of levels, geopotential, or one per level.
#include <algorithm>
#include <cmath>

#include "forecast/conventions/cell_bounds.h"
#include "forecast/conventions/levels.h"
#include "forecast/water/level_heights.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

constexpr double kBelowGround_m = 30, kMostBelowGround = 0.01;  // of all columns
constexpr const char* kOverEllipsoid = "height_above_reference_ellipsoid";

// Fields called `height` are above the sea to some models and above the ground to others, whatever
// CF says: levels below the model's own ground can only be above it.
void note_datum(Vertical& vertical, Levels& levels) {
  const std::string standard = levels.variable->text("standard_name");
  vertical.on_ellipsoid = standard == kOverEllipsoid;
  if (!levels.request.terrain_m || !(standard.empty() || standard == "height")) return;
  const std::vector<float> lowest =
      levels.reader().levels(*levels.variable, levels.z, levels.from_top, 0, 0, 1);
  const std::vector<double> ground = levels.terrain_m(0);
  std::size_t below = 0;
  for (std::size_t n = 0; n < ground.size(); ++n)
    below += levels.height_m(double(lowest[n])) < ground[n] - kBelowGround_m;
  levels.above_ground = double(below) > kMostBelowGround * double(ground.size());
  if (!levels.above_ground) return;
  vertical.assumptions.push_back("Heights " + levels.variable->name +
                                 " lie below the ground in places: they are taken as above it.");
}

// A field of level heights: geometric, geopotential height, or geopotential.
bool by_level_field(const VerticalRequest& request, Vertical& vertical, Quantity wanted,
                    const std::function<UnitOf(const FileVariable&)>& unit, double scale,
                    bool geopotential) {
  const FieldReader& reader = *request.reader;
  const FileVariable* found = find_named(*reader.file, wanted, [&](const FileVariable& v) {
    return reader.is_field(v, request.z) && unit(v).fits;
  });
  if (!found) return false;
  auto levels = levels_of(request, *found, request.z);
  levels->factor = unit(*found).factor * scale;
  levels->geopotential = geopotential;
  levels->from_top = falls(reader, *found, request.z);
  vertical.from_top = levels->from_top;
  vertical.heights_change = varies(*found, reader.time);
  vertical.how = (geopotential ? "geopotential levels " : "levels ") + found->name;
  if (!geopotential) note_datum(vertical, *levels);
  vertical.interfaces_m = [levels](std::size_t time, const Air*) {
    return levels->of_levels(
        levels->reader().field(*levels->variable, levels->z, levels->from_top, time), time);
  };
  // Two levels at each end are enough for the outermost interfaces.
  if (levels->nz() >= 4 && !levels->above_ground)
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

}  // namespace

bool by_half_levels(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const DataFile& file = *reader.file;
  int z = -1;
  const FileVariable* half = find_named(file, names::kHalfLevelHeight, [&](const FileVariable& v) {
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
  levels->from_top = falls(reader, *half, z);
  vertical.from_top = levels->from_top;
  vertical.heights_change = varies(*half, reader.time);
  vertical.has_interfaces = true;
  note_datum(vertical, *levels);
  vertical.how = "half levels " + half->name;
  vertical.interfaces_m = [levels](std::size_t time, const Air*) {
    const std::vector<float> field =
        levels->reader().field(*levels->variable, levels->z, levels->from_top, time);
    const std::vector<double> ground = levels->terrain_m(time);
    const std::size_t cells = levels->cells(), count = std::size_t(levels->nz()) + 1;
    std::vector<float> result(field.size());
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < cells; ++n)
        result[n * count + k] =
            float(levels->height_m(double(field[k * cells + n])) + levels->base_m(ground[n]));
    return levels->checked(std::move(result));
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
      [](const FileVariable& v) { return unit_of(v, kGeopotentialUnit); },
      1 / constants::kStandardGravity_m_per_s2, true);
}

// CF's `height` is above the ground, `altitude` above the geoid.
bool by_height_axis(const VerticalRequest& request, Vertical& vertical) {
  const DataFile& file = *request.reader->file;
  const FileVariable* axis = file.find(file.name(request.z));
  if (!axis || axis->dimensions.size() != 1 || !axis->numeric) return false;
  const UnitOf unit = height_unit(*axis);
  if (!unit.fits) return false;
  std::vector<double> level = file.read_all(*axis);
  const double sign = axis->text("positive") == "down" ? -1 : 1;
  for (double& z : level) z = sign * z * unit.factor;
  auto levels = levels_of(request, *axis, request.z);
  levels->from_top = direction(level, file.where(*axis)) < 0;
  vertical.from_top = levels->from_top;
  auto walls = axis_bounds(file, *axis, level, sign * unit.factor, false);
  if (vertical.from_top) std::ranges::reverse(level);
  if (walls && walls->front() > walls->back()) std::ranges::reverse(*walls);
  vertical.has_interfaces = walls.has_value();
  const std::string standard = axis->text("standard_name");
  vertical.on_ellipsoid = standard == kOverEllipsoid;
  const bool above_ground = standard == "height" && request.terrain_m;
  vertical.how = std::string("heights ") + (above_ground ? "above ground " : "") + axis->name;
  if (!above_ground && standard != "altitude" && !vertical.on_ellipsoid)
    vertical.assumptions.push_back("Heights of " + axis->name + " are taken as above sea level.");
  vertical.interfaces_m = [levels, level, walls, above_ground](std::size_t time, const Air*) {
    const std::vector<double> ground = levels->terrain_m(time);
    const std::size_t count = level.size() + 1;
    std::vector<float> result(levels->cells() * count);
    std::vector<double> column = level;
    for (std::size_t n = 0; n < levels->cells(); ++n) {
      const double base = above_ground && std::isfinite(ground[n]) ? ground[n] : 0;
      for (std::size_t k = 0; walls && k < count; ++k)
        result[n * count + k] = float((*walls)[k] + base);
      if (walls) continue;
      for (std::size_t k = 0; k < level.size(); ++k) column[k] = level[k] + base;
      // Nothing of a model lies below its ground, or below the sea where it has none.
      const double floor_m = std::isfinite(ground[n]) ? ground[n] : 0;
      interfaces_of_levels_m(column, floor_m, {&result[n * count], count});
    }
    return levels->checked(std::move(result));
  };
  return true;
}

}  // namespace nepho::forecast
