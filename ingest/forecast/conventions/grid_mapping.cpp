#include "forecast/conventions/grid_mapping.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/cell_bounds.h"
#include "forecast/conventions/cf_map.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/names.h"
#include "forecast/conventions/vertical.h"

namespace nepho::forecast {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kDegree_m = 111195;  // of latitude, on a sphere of 6371 km

// Values of an axis in degrees; an axis without units counts as degrees where it is named so.
std::optional<std::vector<double>> degrees(const DataFile& file, const FileVariable& axis,
                                           Quantity names) {
  std::vector<double> values = file.read_all(axis);
  const UnitOf unit = unit_of(axis, kAngle);
  const FileVariable* named =
      find_named(file, names, [&](const FileVariable& v) { return &v == &axis; });
  if (unit.fits) {
    for (double& value : values) value = value * (unit.factor / kDegree);
    return values;
  }
  // "degrees_north" with a wrong suffix, or nothing at all.
  if (named && (axis.text("units").empty() || axis.text("units").starts_with("degree")))
    return values;
  return {};
}

// Around 0.
std::vector<double> centred_m(const DataFile& file, const FileVariable& axis) {
  std::vector<double> values = file.read_all(axis);
  const double middle = 0.5 * (values.front() + values.back());
  for (double& value : values) value = (value - middle) * unit_of(axis, kLength).factor;
  return values;
}

struct Fields {
  std::vector<double> latitude_deg, longitude_deg;  // of centres
  double factor;                                    // to degrees
};

Fields fields_of(const DataFile& file, const DimensionRoles& roles, FieldReader reader) {
  reader.nx = int(file.size(roles.x));
  reader.ny = int(file.size(roles.y));
  const UnitOf unit = unit_of(*roles.latitude, kAngle);
  Fields fields{{}, {}, unit.fits ? unit.factor / kDegree : 1};
  const auto read = [&](const FileVariable& v) {
    const std::vector<float> values = reader.surface(v, 0);
    std::vector<double> result(values.begin(), values.end());
    for (double& value : result) value *= fields.factor;
    return result;
  };
  fields.latitude_deg = read(*roles.latitude);
  fields.longitude_deg = read(*roles.longitude);
  return fields;
}

std::unique_ptr<HorizontalGrid> grid_of_fields(const DataFile& file, const DimensionRoles& roles,
                                               Fields fields,
                                               std::vector<std::string>& assumptions) {
  const int nx = int(file.size(roles.x)), ny = int(file.size(roles.y));
  const std::string where =
      file.path() + " [" + roles.latitude->name + ", " + roles.longitude->name + "]";
  const auto row = std::size_t(nx);
  // Axes written out in full: rows of one latitude and columns of one longitude. They go around.
  bool axes = nx > 1 && ny > 1;
  for (std::size_t n = 0; n < fields.latitude_deg.size() && axes; ++n)
    axes = fields.latitude_deg[n] == fields.latitude_deg[n - n % row] &&
           fields.longitude_deg[n] == fields.longitude_deg[n % row];
  if (axes) {
    std::vector<double> latitude;
    for (std::size_t n = 0; n < fields.latitude_deg.size(); n += row)
      latitude.push_back(fields.latitude_deg[n]);
    fields.longitude_deg.resize(row);
    return axes_grid(std::move(latitude), std::move(fields.longitude_deg), where);
  }
  if (auto corners = cell_corners(file, *roles.latitude, *roles.longitude, nx, ny, fields.factor))
    return corners_grid(nx, ny, std::move(corners->latitude), std::move(corners->longitude), where);
  if (nx == 1 || ny == 1)
    return line_grid(nx, ny, fields.latitude_deg, fields.longitude_deg, where, assumptions);
  return points_grid(nx, ny, std::move(fields.latitude_deg), std::move(fields.longitude_deg),
                     where);
}

// Largest angle between the map's centres and the file's, over that of a cell's side.
double cells_apart(const HorizontalGrid& grid, const Fields& fields) {
  double worst = 0;
  const auto apart = [](glm::dvec2 a, glm::dvec2 b) {
    return std::hypot(a.x - b.x, std::remainder(a.y - b.y, 360.0) * std::cos(a.x * kDegree));
  };
  const int nx = grid.nx(), ny = grid.ny();
  for (int j = 0; j < ny; j += std::max(1, ny / 8))
    for (int i = 0; i < nx; i += std::max(1, nx / 8)) {
      const auto n = std::size_t(j) * std::size_t(nx) + std::size_t(i);
      const glm::dvec2 here = grid.lat_lon_deg(i + 0.5, j + 0.5);
      const double side = apart(grid.lat_lon_deg(i + 1, j + 0.5), grid.lat_lon_deg(i, j + 0.5));
      const double gap = apart(here, {fields.latitude_deg[n], fields.longitude_deg[n]}) / side;
      if (gap > worst) worst = gap;  // not where either has no place
    }
  return worst;
}

// A map that lies elsewhere than the file's own places is a mistake in its attributes.
constexpr double kMapsPlace_cells = 0.25;

// The coordinate of a dimension: of its name, or else of one that says that it is one.
const FileVariable* axis_of(const DataFile& file, int dimension) {
  const auto along = [&](const FileVariable& v) {
    return v.numeric && v.dimensions == std::vector<int>{dimension};
  };
  if (const FileVariable* axis = file.find(file.name(dimension)); axis && along(*axis)) return axis;
  static const std::vector<std::string> kNames = {"projection_x_coordinate",
                                                  "projection_y_coordinate",
                                                  "projection_x_angular_coordinate",
                                                  "projection_y_angular_coordinate",
                                                  "grid_longitude",
                                                  "grid_latitude",
                                                  "longitude",
                                                  "latitude"};
  const auto at = std::ranges::find_if(file.variables(), [&](const FileVariable& v) {
    return along(v) && std::ranges::find(kNames, v.text("standard_name")) != kNames.end();
  });
  return at == file.variables().end() ? nullptr : &*at;
}

// Axes that say that they are latitude and longitude are no map's, whatever else the file holds.
bool is_geographic(const DataFile& file, const DimensionRoles& roles) {
  const FileVariable *y = axis_of(file, roles.y), *x = axis_of(file, roles.x);
  const auto says = [](const FileVariable* axis, const char* direction, const char* grid) {
    return axis && axis->text("units").starts_with(direction) &&
           axis->text("standard_name") != grid;
  };
  return (says(y, "degrees_n", "grid_latitude") || says(y, "degree_n", "grid_latitude")) &&
         (says(x, "degrees_e", "grid_longitude") || says(x, "degree_e", "grid_longitude"));
}

const FileVariable& need_axis(const DataFile& file, int dimension, const FileVariable& water) {
  const FileVariable* axis = axis_of(file, dimension);
  if (!axis)
    throw Error({"the grid has no coordinates", file.where(water),
                 "a variable " + file.name(dimension) + "(" + file.name(dimension) +
                     "), or fields of latitude and longitude",
                 "neither", ""});
  return *axis;
}

}  // namespace

std::shared_ptr<const HorizontalGrid> cf_grid(const DataFile& file, const DimensionRoles& roles,
                                              const FieldReader& reader, const FileVariable& water,
                                              std::vector<std::string>& assumptions,
                                              std::string& how) {
  const std::string where =
      file.path() + " [" + file.name(roles.y) + ", " + file.name(roles.x) + "]";
  const bool has_fields = roles.latitude;
  std::optional<Fields> fields;
  if (has_fields) fields = fields_of(file, roles, reader);
  const FileVariable* mapping = map_of(file, water);
  if (mapping && is_geographic(file, roles)) mapping = nullptr;
  if (mapping && (!has_fields || (axis_of(file, roles.y) && axis_of(file, roles.x)))) {
    std::vector<std::string> said;
    std::shared_ptr<const HorizontalGrid> grid;
    try {
      grid = cf_map_grid(file, *mapping, need_axis(file, roles.x, water),
                         need_axis(file, roles.y, water), said);
    } catch (const Error&) {
      if (!has_fields) throw;
    }
    if (grid && (!has_fields || cells_apart(*grid, *fields) < kMapsPlace_cells)) {
      assumptions.insert(assumptions.end(), said.begin(), said.end());
      const std::string name = mapping->text("grid_mapping_name");
      how = "map " + (name.empty() ? mapping->name : name);
      return grid;
    }
    assumptions.push_back("The map " + mapping->name +
                          (grid ? " does not agree with" : " is not known: the cells lie by") +
                          (grid ? " the file's latitudes and longitudes, which are taken."
                                : " the file's latitudes and longitudes."));
  }
  how = "fields " + (has_fields ? roles.latitude->name + ", " + roles.longitude->name : "");
  if (has_fields) return grid_of_fields(file, roles, std::move(*fields), assumptions);
  how = "axes " + file.name(roles.y) + ", " + file.name(roles.x);
  const FileVariable& y = need_axis(file, roles.y, water);
  const FileVariable& x = need_axis(file, roles.x, water);
  const auto latitude = degrees(file, y, names::kLatitude);
  auto longitude = degrees(file, x, names::kLongitude);
  if (latitude && longitude) {
    unwrap_deg(*longitude);
    const auto factor = [](const FileVariable& axis) {
      const UnitOf unit = unit_of(axis, kAngle);
      return unit.fits ? unit.factor / kDegree : 1;
    };
    AxisWalls lat = axis_walls(file, y, *latitude, factor(y), false),
              lon = axis_walls(file, x, *longitude, factor(x), true);
    const double along = std::max(0.01, std::cos((*latitude)[latitude->size() / 2] * kDegree));
    widen_lone(lon, lat, kDegree_m * along, kDegree_m, assumptions);
    return axes_grid(*latitude, *longitude, where, {std::move(lat.edges), std::move(lon.edges)});
  }
  if (unit_of(x, kLength).fits && unit_of(y, kLength).fits) {
    assumptions.push_back(kNoPlace);
    const std::vector<double> xs = centred_m(file, x), ys = centred_m(file, y);
    AxisWalls x_walls{edges_between(xs), xs.size() > 1}, y_walls{edges_between(ys), ys.size() > 1};
    widen_lone(x_walls, y_walls, 1, 1, assumptions);
    return plane_edges_grid(std::move(x_walls.edges), std::move(y_walls.edges));
  }
  throw Error({"the grid has no place", where, "latitudes and longitudes in degrees, or m of a map",
               "units \"" + y.text("units") + "\" and \"" + x.text("units") + "\"",
               "name the map in the attribute grid_mapping of " + water.name});
}

}  // namespace nepho::forecast
