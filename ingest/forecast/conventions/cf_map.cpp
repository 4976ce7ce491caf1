#include "forecast/conventions/cf_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/cell_bounds.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/vertical.h"
#include "geo/proj_map.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

// Of most models whose files do not say it, by the World Meteorological Organization's GRIB tables.
constexpr double kUsualSphere_m = 6371229;

// How a map's axes count: lengths, degrees of a rotated system, angles of view.
enum class Axes { kLength, kDegrees, kView };

constexpr double kDegree_m = kUsualSphere_m * M_PI / 180;

// GeographicLib's where it has the map, else PROJ's of the name `proj`.
struct KnownMap {
  const char* name;
  std::optional<MapKind> kind;
  const char* proj;
  Axes axes = Axes::kLength;
};
constexpr std::array<KnownMap, 15> kMaps = {
    {{"lambert_conformal_conic", MapKind::kLambertConformal, ""},
     {"mercator", MapKind::kMercator, ""},
     {"polar_stereographic", MapKind::kPolarStereographic, ""},
     {"transverse_mercator", MapKind::kTransverseMercator, ""},
     {"rotated_latitude_longitude", MapKind::kRotated, "", Axes::kDegrees},
     {"geostationary", {}, "geos", Axes::kView},
     {"lambert_azimuthal_equal_area", {}, "laea"},
     {"albers_conical_equal_area", {}, "aea"},
     {"azimuthal_equidistant", {}, "aeqd"},
     {"lambert_cylindrical_equal_area", {}, "cea"},
     {"oblique_mercator", {}, "omerc"},
     {"orthographic", {}, "ortho"},
     {"sinusoidal", {}, "sinu"},
     {"stereographic", {}, "stere"},
     {"vertical_perspective", {}, "nsper"}}};

constexpr std::array kSystemAttributes = {"crs_wkt",      "spatial_ref", "proj4",
                                          "proj4_params", "proj4text",   "proj4string"};

std::string system_text(const FileVariable& mapping) {
  for (const char* name : kSystemAttributes)
    if (const std::string text = mapping.text(name); !text.empty()) return text;
  return "";
}

double number(const FileVariable& mapping, const char* name, double otherwise) {
  return mapping.number(name).value_or(otherwise);
}

struct Figure {
  double equatorial_m = kUsualSphere_m, polar_m = kUsualSphere_m;
  bool known = true;
};

// CF 1.11, appendix F: a radius; or an axis with the other or the flattening; or a known name.
Figure figure_of(const FileVariable& mapping) {
  Figure figure;
  if (const auto axis = mapping.number("semi_major_axis")) {
    const double flattening = number(mapping, "inverse_flattening", 0);
    figure.equatorial_m = *axis;
    figure.polar_m =
        number(mapping, "semi_minor_axis", flattening > 0 ? *axis * (1 - 1 / flattening) : *axis);
    return figure;
  }
  if (const auto radius = mapping.number("earth_radius")) return {*radius, *radius};
  for (const char* name : {"reference_ellipsoid_name", "horizontal_datum_name", "ellipsoid"}) {
    const std::string text = mapping.text(name);
    if (text.starts_with("WGS84") || text.starts_with("WGS 84") || text.starts_with("WGS_1984") ||
        text.starts_with("GRS"))  // half axes are 0.1 mm apart
      return {constants::kWgs84Equatorial_m, constants::kWgs84Polar_m};
  }
  figure.known = false;
  return figure;
}

double central_longitude_deg(const FileVariable& mapping) {
  for (const char* name : {"straight_vertical_longitude_from_pole", "longitude_of_central_meridian",
                           "longitude_of_projection_origin"})
    if (const auto value = mapping.number(name)) return *value;
  return 0;
}

MapSpec spec_of(const FileVariable& mapping, MapKind kind, const Figure& figure,
                glm::dvec2 unit_m) {
  MapSpec spec;
  spec.kind = kind;
  spec.equatorial_m = figure.equatorial_m;
  spec.polar_m = figure.polar_m;
  spec.central_longitude_deg = central_longitude_deg(mapping);
  spec.origin_latitude_deg = number(mapping, "latitude_of_projection_origin", 0);
  const FileAttribute* parallel = mapping.attribute("standard_parallel");
  const bool has_parallel = parallel && !parallel->numbers.empty();
  const bool polar = kind == MapKind::kPolarStereographic;
  // Without a parallel the scale is told where the map touches.
  const double touches_deg = kind == MapKind::kMercator ? 0 : spec.origin_latitude_deg;
  spec.true_latitude1_deg = has_parallel ? parallel->numbers.front() : touches_deg;
  spec.true_latitude2_deg = has_parallel ? parallel->numbers.back() : touches_deg;
  // Written as a distance from the equator, whichever pole it is.
  if (polar && spec.origin_latitude_deg * spec.true_latitude1_deg < 0)
    spec.true_latitude1_deg = -spec.true_latitude1_deg;
  if (kind == MapKind::kMercator) spec.origin_latitude_deg = 0;
  if (kind == MapKind::kTransverseMercator)
    spec.scale = number(mapping, "scale_factor_at_central_meridian", 1);
  else if (!has_parallel)
    spec.scale = number(mapping, "scale_factor_at_projection_origin", 1);
#ifdef NEPHO_MUTANT_SWAPPED_PARALLELS
  if (has_parallel && parallel->numbers.size() == 2)
    std::swap(spec.origin_latitude_deg, spec.true_latitude1_deg);
#endif
  spec.false_easting_m = number(mapping, "false_easting", 0) * unit_m.x;
  spec.false_northing_m = number(mapping, "false_northing", 0) * unit_m.y;
  spec.pole_latitude_deg = number(mapping, "grid_north_pole_latitude", 90);
  spec.pole_longitude_deg = number(mapping, "grid_north_pole_longitude", 180);
  spec.pole_grid_longitude_deg = number(mapping, "north_pole_grid_longitude", 0);
  return spec;
}

// CF's attributes in PROJ's words.
std::string proj_text(const FileVariable& mapping, const KnownMap& known, const Figure& figure,
                      glm::dvec2 unit_m) {
  std::string text = std::string("+proj=") + known.proj;
  const auto add = [&](const char* name, double value) {
    char part[60];
    std::snprintf(part, sizeof part, " +%s=%.17g", name, value);
    text += part;
  };
  const bool oblique = std::string_view(known.proj) == "omerc";
  add(oblique ? "lonc" : "lon_0", central_longitude_deg(mapping));
  if (const auto value = mapping.number("latitude_of_projection_origin")) add("lat_0", *value);
  if (const FileAttribute* parallel = mapping.attribute("standard_parallel");
      parallel && !parallel->numbers.empty()) {
    const bool one = std::string_view(known.proj) == "cea";
    add(one ? "lat_ts" : "lat_1", parallel->numbers.front());
    if (!one) add("lat_2", parallel->numbers.back());
  }
  if (const auto value = mapping.number("scale_factor_at_projection_origin")) add("k_0", *value);
  if (const auto value = mapping.number("azimuth_of_central_line")) add("alpha", *value);
  if (const auto value = mapping.number("perspective_point_height")) add("h", *value);
  if (known.axes == Axes::kView) {
    // The other of two names of one thing.
    const std::string fixed = mapping.text("fixed_angle_axis");
    std::string sweep = mapping.text("sweep_angle_axis");
    if (sweep.empty() && !fixed.empty()) sweep = fixed == "x" ? "y" : "x";
#ifdef NEPHO_MUTANT_SWEEP
    sweep = sweep == "x" ? "y" : "x";
#endif
    text += " +sweep=" + (sweep.empty() ? "y" : sweep);
  }
  add("x_0", number(mapping, "false_easting", 0) * unit_m.x);
  add("y_0", number(mapping, "false_northing", 0) * unit_m.y);
  add("a", figure.equatorial_m);
  add("b", figure.polar_m);
  return text;
}

std::string known_names() {
  std::string text = "latitude_longitude";
  for (const KnownMap& map : kMaps) text += std::string(", ") + map.name;
  return text + ", or a " + kSystemAttributes[0];
}

// Factor of an axis to what the map counts in.
double axis_factor(const DataFile& file, const FileVariable& axis, Axes axes,
                   double perspective_height_m, std::vector<std::string>& assumptions) {
  const std::string unit = axis.text("units");
  if (const UnitOf length = unit_of(axis, kLength); length.fits && axes != Axes::kDegrees)
    return length.factor;
  if (const UnitOf angle = unit_of(axis, kAngle); angle.fits && axes != Axes::kLength)
    return axes == Axes::kView ? angle.factor * perspective_height_m : angle.factor * 180 / M_PI;
  const char* const usual = axes == Axes::kLength    ? "m"
                            : axes == Axes::kDegrees ? "degrees"
                                                     : "radians";
  if (unit.empty() || unit == "1") {
    assumptions.push_back("The axis " + axis.name + " has no units: " + usual + " are taken.");
    return axes == Axes::kView ? perspective_height_m : 1;
  }
  throw Error({"an axis of the grid has no usable units", file.where(axis),
               axes == Axes::kLength ? "m or km" : usual, "\"" + unit + "\"",
               "set the attribute `units` of " + axis.name});
}

const KnownMap* known_map(const FileVariable& mapping) {
  std::string name = mapping.text("grid_mapping_name");
  // Written before there was a name for it.
  if (name.empty() && mapping.attribute("grid_north_pole_latitude"))
    name = "rotated_latitude_longitude";
  const auto known = std::ranges::find(kMaps, name, [](const KnownMap& m) { return m.name; });
  return known == kMaps.end() ? nullptr : &*known;
}

}  // namespace

const FileVariable* map_of(const DataFile& file, const FileVariable& water) {
  // "crs", or "crs: x y" for one of several systems.
  std::string name = water.text("grid_mapping");
  name = name.substr(0, name.find_first_of(": "));
  const FileVariable* found = file.find(name);
  if (!found) {
    const auto names_map = [](const FileVariable& v) {
      return !v.text("grid_mapping_name").empty();
    };
    if (std::ranges::count_if(file.variables(), names_map) != 1) return nullptr;
    found = &*std::ranges::find_if(file.variables(), names_map);
  }
  return found->text("grid_mapping_name") == "latitude_longitude" ? nullptr : found;
}

std::unique_ptr<HorizontalGrid> cf_map_grid(const DataFile& file, const FileVariable& mapping,
                                            const FileVariable& x, const FileVariable& y,
                                            std::vector<std::string>& assumptions) {
  const KnownMap* known = known_map(mapping);
  const std::string system = system_text(mapping);
  if (!known && system.empty())
    throw Error({"this map projection is not known", file.where(mapping), known_names(),
                 "\"" + mapping.text("grid_mapping_name") + "\"",
                 "fields of latitude and longitude would do instead"});
  const Figure figure = figure_of(mapping);
  const Axes axes = known ? known->axes : Axes::kLength;
  const double height_m = number(mapping, "perspective_point_height", 0);
  if (axes == Axes::kView && !(height_m > 0))
    throw Error({"the satellite's height is missing", file.where(mapping),
                 "perspective_point_height in m", "none", ""});
  const glm::dvec2 factor = {axis_factor(file, x, axes, height_m, assumptions),
                             axis_factor(file, y, axes, height_m, assumptions)};
  const bool by_system = !known || (!figure.known && !system.empty() && axes == Axes::kLength);
  if (!by_system && !figure.known && axes != Axes::kDegrees)
    assumptions.push_back(
        "The map names no figure of the Earth: a sphere of 6371.229 km is taken.");
  const MapProjection projection =
      by_system     ? proj_map(system, file.where(mapping))
      : known->kind ? MapProjection(spec_of(mapping, *known->kind, figure, factor))
                    : proj_map(proj_text(mapping, *known, figure, factor), file.where(mapping));
  const auto edges = [&](const FileVariable& axis, double scale) {
    std::vector<double> centres = file.read_all(axis);
    for (double& value : centres) value *= scale;
    return axis_walls(file, axis, centres, scale, false);
  };
  AxisWalls x_walls = edges(x, factor.x), y_walls = edges(y, factor.y);
  const double unit_m = axes == Axes::kDegrees ? kDegree_m : 1;
  widen_lone(x_walls, y_walls, unit_m, unit_m, assumptions);
  return map_edges_grid(std::move(x_walls.edges), std::move(y_walls.edges), projection);
}

}  // namespace nepho::forecast
