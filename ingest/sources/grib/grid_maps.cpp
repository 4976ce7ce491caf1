#include "sources/grib/grid_maps.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "geo/map_projection.h"

namespace nepho::grib {
namespace {

// Shape of the Earth: GRIB2 table 3.2; edition 1 has a bit for two of them.
struct Earth {
  double equatorial_m = 6371229, polar_m = 6371229;
};

Earth earth_of(const Message& message) {
  if (message.need_integer("editionNumber") == 1)
    return message.integer("earthIsOblate").value_or(0) == 1 ? Earth{6378160, 6356775}
                                                             : Earth{6367470, 6367470};
  const auto given = [&](const char* value, const char* power, double unit) {
    const double scaled = double(message.integer(value).value_or(0));
    return unit * scaled * std::pow(10.0, -double(message.integer(power).value_or(0)));
  };
  const auto axes = [&](double unit) {
    return Earth{given("scaledValueOfEarthMajorAxis", "scaleFactorOfEarthMajorAxis", unit),
                 given("scaledValueOfEarthMinorAxis", "scaleFactorOfEarthMinorAxis", unit)};
  };
  Earth earth;
  switch (message.integer("shapeOfTheEarth").value_or(6)) {
    case 0:
      earth = {6367470, 6367470};
      break;
    case 1:
      earth.equatorial_m = earth.polar_m =
          given("scaledValueOfRadiusOfSphericalEarth", "scaleFactorOfRadiusOfSphericalEarth", 1);
      break;
    case 2:
      earth = {6378160, 6356775};
      break;
    case 3:
      earth = axes(1000);
      break;
    case 4:
      earth = {6378137, 6356752.314140};
      break;
    case 5:
      earth = {6378137, 6356752.314245};
      break;
    case 7:
      earth = axes(1);
      break;
    case 8:
      earth = {6371200, 6371200};
      break;
    case 9:
      earth = {6377563.396, 6356256.909};
      break;
    default:
      break;
  }
  if (!(earth.equatorial_m > 1e5 && earth.polar_m > 1e5 && earth.polar_m <= earth.equatorial_m))
    throw Error({"a GRIB message's shape of the Earth is not usable", message.where(),
                 "a radius, or axes of an ellipsoid, in m",
                 std::to_string(earth.equatorial_m) + " and " + std::to_string(earth.polar_m), ""});
  return earth;
}

void put(Grid& grid, const char* name, double value) {
  grid.mapping.push_back({name, "", {value}});
}
void put_name(Grid& grid, const char* value, const Earth& earth) {
  grid.mapping.push_back({"grid_mapping_name", value, {}});
  if (earth.equatorial_m == earth.polar_m) return put(grid, "earth_radius", earth.equatorial_m);
  put(grid, "semi_major_axis", earth.equatorial_m);
  put(grid, "semi_minor_axis", earth.polar_m);
}

// Axes in m from the first point on.
void map_axes(const Message& message, Grid& grid, const MapSpec& spec, const char* dx,
              const char* dy) {
  grid.kind = Grid::Kind::kMap;
  const glm::dvec2 first =
      MapProjection(spec).map_m({message.need_number("latitudeOfFirstGridPointInDegrees"),
                                 message.need_number("longitudeOfFirstGridPointInDegrees")});
  const double step_x = message.need_number(dx) * (grid.x_falls ? -1 : 1);
  const double step_y = message.need_number(dy) * (grid.y_falls ? -1 : 1);
  if (step_x == 0 || step_y == 0) refuse_grid(message, "steps of 0 m");
  for (std::size_t i = 0; i < grid.nx; ++i) grid.x.push_back(first.x + step_x * double(i));
  for (std::size_t j = 0; j < grid.ny; ++j) grid.y.push_back(first.y + step_y * double(j));
}

MapSpec spec_of(const Message& message, MapKind kind) {
  const Earth earth = earth_of(message);
  MapSpec spec;
  spec.kind = kind;
  spec.equatorial_m = earth.equatorial_m;
  spec.polar_m = earth.polar_m;
  return spec;
}

}  // namespace

void refuse_grid(const Message& message, const std::string& found) {
  throw Error({"a GRIB message's grid contradicts itself", message.where(),
               "first and last points, increments and numbers of points that agree", found, ""});
}

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

void lambert(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kLambertConformal);
  spec.true_latitude1_deg = message.need_number("Latin1InDegrees");
  spec.true_latitude2_deg = message.need_number("Latin2InDegrees");
  spec.central_longitude_deg = message.need_number("LoVInDegrees");
  spec.origin_latitude_deg = message.number("LaDInDegrees").value_or(spec.true_latitude1_deg);
  put_name(grid, "lambert_conformal_conic", {spec.equatorial_m, spec.polar_m});
  grid.mapping.push_back(
      {"standard_parallel", "", {spec.true_latitude1_deg, spec.true_latitude2_deg}});
  put(grid, "longitude_of_central_meridian", spec.central_longitude_deg);
  put(grid, "latitude_of_projection_origin", spec.origin_latitude_deg);
  map_axes(message, grid, spec, "DxInMetres", "DyInMetres");
}

void mercator(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kMercator);
  spec.true_latitude1_deg = message.need_number("LaDInDegrees");
  spec.central_longitude_deg = message.need_number("longitudeOfFirstGridPointInDegrees");
  put_name(grid, "mercator", {spec.equatorial_m, spec.polar_m});
  put(grid, "standard_parallel", spec.true_latitude1_deg);
  put(grid, "longitude_of_projection_origin", spec.central_longitude_deg);
  map_axes(message, grid, spec, "DiInMetres", "DjInMetres");
  if (message.number("orientationOfTheGridInDegrees").value_or(0) != 0) {
    grid.kind = Grid::Kind::kUnknown;
    grid.why = "its rows do not run east";
  }
}

void polar_stereographic(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kPolarStereographic);
  const bool south = message.integer("projectionCentreFlag").value_or(0) & 0x80;
  const double true_latitude = std::abs(message.number("LaDInDegrees").value_or(60));
  if (!(true_latitude > 0 && true_latitude <= 90))
    refuse_grid(message, "steps at latitude " + short_number(true_latitude));
  spec.true_latitude1_deg = south ? -true_latitude : true_latitude;
  spec.central_longitude_deg = message.need_number("orientationOfTheGridInDegrees");
  put_name(grid, "polar_stereographic", {spec.equatorial_m, spec.polar_m});
  put(grid, "latitude_of_projection_origin", south ? -90 : 90);
  put(grid, "standard_parallel", spec.true_latitude1_deg);
  put(grid, "straight_vertical_longitude_from_pole", spec.central_longitude_deg);
  map_axes(message, grid, spec, "DxInMetres", "DyInMetres");
}

void rotate(const Message& message, Grid& grid) {
  grid.kind = Grid::Kind::kRotated;
  put_name(grid, "rotated_latitude_longitude", earth_of(message));
  const double south = message.need_number("longitudeOfSouthernPoleInDegrees");
  put(grid, "grid_north_pole_latitude", -message.need_number("latitudeOfSouthernPoleInDegrees"));
  put(grid, "grid_north_pole_longitude", std::remainder(south + 180, 360));
  // About the new polar axis, clockwise as seen from its southern end (WMO manual 306, template
  // 3.1): meridians are numbered from that much further east, the true pole's too. ecCodes 2.28
  // turns about the Earth's axis instead.
  const double turn = message.number("angleOfRotationInDegrees").value_or(0);
#ifdef NEPHO_MUTANT_UNTURNED
  put(grid, "north_pole_grid_longitude", 0);
  (void)turn;
#else
  put(grid, "north_pole_grid_longitude", turn == 0 ? 0 : std::remainder(-turn, 360));
#endif
}

// CGMS 03, LRIT/HRIT global specification, 4.4: angles about the satellite, x in the plane of the
// equator first. WMO manual 306, template 3.90: the Earth's disc is dx by dy grid lengths wide.
void space_view(const Message& message, Grid& grid) {
  const auto degrees = [&](const char* key) {
    const std::string name(key);
    if (const auto value = message.number((name + "InDegrees").c_str())) return *value;
    return message.need_number(key) * 1e-6;
  };
  const auto refuse = [&](const std::string& why) { grid.why = why; };
  if (degrees("latitudeOfSubSatellitePoint") != 0)
    return refuse("its satellite is not above the equator");
  if (message.number("orientationOfTheGridInDegrees").value_or(0) != 0)
    return refuse("its rows do not run east");
  const auto distance = message.number("NrInRadiusOfEarth");
  if (!distance || !(*distance > 1 && *distance < 1000))
    return refuse("it does not say how far the satellite is");
  const Earth earth = earth_of(message);
  const double dx = message.need_number("dx"), dy = message.need_number("dy");
  if (!(dx > 0 && dy > 0)) refuse_grid(message, "a disc of no width");
  const double height_m = (*distance - 1) * earth.equatorial_m;
  const double disc_rad = 2 * std::asin(1 / *distance);
  const double step_x = disc_rad / dx * height_m * (grid.x_falls ? -1 : 1);
  const double step_y =
      disc_rad / dy * (earth.polar_m / earth.equatorial_m) * height_m * (grid.y_falls ? -1 : 1);
  const double first_x =
      double(message.integer("Xo").value_or(0)) - message.need_number("XpInGridLengths");
  const double first_y =
      double(message.integer("Yo").value_or(0)) - message.need_number("YpInGridLengths");
  for (std::size_t i = 0; i < grid.nx; ++i) grid.x.push_back((double(i) + first_x) * step_x);
  for (std::size_t j = 0; j < grid.ny; ++j) grid.y.push_back((double(j) + first_y) * step_y);
  put_name(grid, "geostationary", earth);
  put(grid, "perspective_point_height", height_m);
  put(grid, "longitude_of_projection_origin", degrees("longitudeOfSubSatellitePoint"));
  put(grid, "latitude_of_projection_origin", 0);
  grid.mapping.push_back({"sweep_angle_axis", "y", {}});
  grid.kind = Grid::Kind::kMap;
}

}  // namespace nepho::grib
