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
  const double turn = message.number("angleOfRotationInDegrees").value_or(0);
  put(grid, "north_pole_grid_longitude", 0);
  if (turn != 0) {
    grid.kind = Grid::Kind::kUnknown;
    grid.why = "its rotated pole is turned by " + short_number(turn) + " degrees as well";
  }
}

}  // namespace nepho::grib
