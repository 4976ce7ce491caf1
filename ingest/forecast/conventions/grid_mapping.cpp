#include "forecast/conventions/grid_mapping.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/names.h"
#include "forecast/conventions/vertical.h"

namespace nepho::forecast {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Values of an axis in degrees; an axis without units counts as degrees where it is named so.
std::optional<std::vector<double>> degrees(const DataFile& file, const FileVariable& axis,
                                           const VariableNames& names) {
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

// One number of the mapping, or the first or last of a pair.
double attribute(const FileVariable& mapping, const char* name, double otherwise,
                 bool last = false) {
  const FileAttribute* found = mapping.attribute(name);
  if (!found || found->numbers.empty()) return otherwise;
  return last ? found->numbers.back() : found->numbers.front();
}

std::optional<MapKind> kind_of(const FileVariable& mapping) {
  const std::string name = mapping.text("grid_mapping_name");
  if (name == "lambert_conformal_conic") return MapKind::kLambertConformal;
  if (name == "mercator") return MapKind::kMercator;
  if (name == "polar_stereographic") return MapKind::kPolarStereographic;
  if (name == "transverse_mercator") return MapKind::kTransverseMercator;
  if (name == "rotated_latitude_longitude") return MapKind::kRotated;
  // Written before there was a name for it.
  if (name.empty() && mapping.attribute("grid_north_pole_latitude")) return MapKind::kRotated;
  return {};
}

MapSpec spec_of(const FileVariable& mapping, MapKind kind) {
  MapSpec spec;
  spec.kind = kind;
  const double sphere = attribute(mapping, "earth_radius", 6371229);
  spec.equatorial_m = attribute(mapping, "semi_major_axis", sphere);
  const double flattening = attribute(mapping, "inverse_flattening", 0);
  spec.polar_m =
      attribute(mapping, "semi_minor_axis",
                flattening > 0 ? spec.equatorial_m * (1 - 1 / flattening) : spec.equatorial_m);
  spec.origin_latitude_deg = attribute(mapping, "latitude_of_projection_origin", 0);
  spec.true_latitude1_deg =
      attribute(mapping, "standard_parallel",
                kind == MapKind::kPolarStereographic ? spec.origin_latitude_deg : 0);
  spec.true_latitude2_deg = attribute(mapping, "standard_parallel", 0, true);
  if (kind == MapKind::kMercator) spec.origin_latitude_deg = 0;
  for (const char* name : {"longitude_of_projection_origin", "longitude_of_central_meridian",
                           "straight_vertical_longitude_from_pole"})
    spec.central_longitude_deg = attribute(mapping, name, spec.central_longitude_deg);
  spec.scale = attribute(mapping, "scale_factor_at_central_meridian", 1);
  spec.false_easting_m = attribute(mapping, "false_easting", 0);
  spec.false_northing_m = attribute(mapping, "false_northing", 0);
  spec.pole_latitude_deg = attribute(mapping, "grid_north_pole_latitude", 90);
  spec.pole_longitude_deg = attribute(mapping, "grid_north_pole_longitude", 180);
  return spec;
}

const FileVariable& need_axis(const DataFile& file, int dimension, const FileVariable& water) {
  const FileVariable* axis = file.find(file.name(dimension));
  if (!axis || axis->dimensions != std::vector<int>{dimension} || !axis->numeric)
    throw Error({"the grid has no coordinates", file.where(water),
                 "a variable " + file.name(dimension) + "(" + file.name(dimension) +
                     "), or fields of latitude and longitude",
                 "neither", ""});
  return *axis;
}

// Along a map, in its unit: m, or degrees where it is rotated.
std::vector<double> map_axis(const DataFile& file, const FileVariable& axis, bool rotated) {
  std::vector<double> values = file.read_all(axis);
  const UnitOf unit = unit_of(axis, rotated ? kAngle : kLength);
  if (!unit.fits)
    throw Error({"an axis of the grid has no usable units", file.where(axis),
                 rotated ? "degrees" : "m or km", "\"" + axis.text("units") + "\"", ""});
  for (double& value : values) value *= rotated ? unit.factor / kDegree : unit.factor;
  return values;
}

void centre(std::vector<double>& values) {
  const double middle = 0.5 * (values.front() + values.back());
  for (double& value : values) value -= middle;
}

}  // namespace

std::shared_ptr<const HorizontalGrid> cf_grid(const DataFile& file, const DimensionRoles& roles,
                                              const FieldReader& reader, const FileVariable& water,
                                              std::vector<std::string>& assumptions) {
  const std::string where =
      file.path() + " [" + file.name(roles.y) + ", " + file.name(roles.x) + "]";
  if (roles.latitude && file.size(roles.x) > 1 && file.size(roles.y) > 1) {
    FieldReader whole = reader;
    whole.nx = int(file.size(roles.x));
    whole.ny = int(file.size(roles.y));
    const auto field = [&](const FileVariable& v) {
      const std::vector<float> values = whole.surface(v, 0);
      const UnitOf unit = unit_of(v, kAngle);
      std::vector<double> result(values.begin(), values.end());
      if (unit.fits)
        for (double& value : result) value *= unit.factor / kDegree;
      return result;
    };
    return points_grid(
        whole.nx, whole.ny, field(*roles.latitude), field(*roles.longitude),
        file.path() + " [" + roles.latitude->name + ", " + roles.longitude->name + "]");
  }
  const FileVariable& y = need_axis(file, roles.y, water);
  const FileVariable& x = need_axis(file, roles.x, water);
  if (const FileVariable* mapping = file.find(water.text("grid_mapping"));
      mapping && mapping->text("grid_mapping_name") != "latitude_longitude") {
    const auto kind = kind_of(*mapping);
    if (!kind)
      throw Error({"this map projection is not known", file.where(*mapping),
                   "latitude_longitude, lambert_conformal_conic, mercator, polar_stereographic, "
                   "transverse_mercator or rotated_latitude_longitude",
                   "\"" + mapping->text("grid_mapping_name") + "\"",
                   "fields of latitude and longitude would do instead"});
    const bool rotated = *kind == MapKind::kRotated;
    return map_grid(map_axis(file, x, rotated), map_axis(file, y, rotated),
                    MapProjection(spec_of(*mapping, *kind)));
  }
  const auto latitude = degrees(file, y, names::kLatitude);
  const auto longitude = degrees(file, x, names::kLongitude);
  if (latitude && longitude) return axes_grid(*latitude, *longitude, where);
  if (unit_of(x, kLength).fits && unit_of(y, kLength).fits) {
    assumptions.push_back(kNoPlace);
    std::vector<double> x_m = map_axis(file, x, false), y_m = map_axis(file, y, false);
    centre(x_m);
    centre(y_m);
    return plane_grid(x_m, y_m);
  }
  throw Error({"the grid has no place", where, "latitudes and longitudes in degrees, or m of a map",
               "units \"" + y.text("units") + "\" and \"" + x.text("units") + "\"", ""});
}

}  // namespace nepho::forecast
