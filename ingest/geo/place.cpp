#include "geo/place.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Math.hpp>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"

namespace nepho {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

using GeographicLib::Geocentric;

Geocentric geocentric(const Ellipsoid& body) {
  return {body.equatorial_m, (body.equatorial_m - body.polar_m) / body.equatorial_m};
}

void check_number(const char* name, double value) {
  if (!std::isfinite(value))
    throw Error({.what = "a place is not finite",
                 .where = name,
                 .expected = "a number",
                 .found = std::to_string(value),
                 .hint = ""});
}

void check_point(const GeodeticPoint& point) {
  check_number("lat_deg", point.latitude_deg);
  check_number("lon_deg", point.longitude_deg);
  check_number("height_m", point.height_m);
  if (std::abs(point.latitude_deg) > 90)
    throw Error({.what = "a latitude is beyond the pole",
                 .where = "lat_deg",
                 .expected = "-90 to 90",
                 .found = std::to_string(point.latitude_deg),
                 .hint = "latitude comes before longitude"});
}

}  // namespace

glm::dvec3 ecef_m(const Ellipsoid& body, const GeodeticPoint& point) {
  check_point(point);
  glm::dvec3 result;
  geocentric(body).Forward(point.latitude_deg, point.longitude_deg, point.height_m, result.x,
                           result.y, result.z);
  return result;
}

GeodeticPoint geodetic_point(const Ellipsoid& body, glm::dvec3 ecef_m) {
  for (const double component : {ecef_m.x, ecef_m.y, ecef_m.z}) check_number("ecef_m", component);
  GeodeticPoint result;
  geocentric(body).Reverse(ecef_m.x, ecef_m.y, ecef_m.z, result.latitude_deg, result.longitude_deg,
                           result.height_m);
  return result;
}

Placement placement_of(const GeodeticPlace& place) {
  const GeodeticPoint point = {place.latitude_deg, place.longitude_deg, place.height_m};
  check_point(point);
  check_number("heading_deg", place.heading_deg);
  Placement result;
  std::vector<double> rows(9);  // columns east, north, up
  geocentric(Ellipsoid::wgs84())
      .Forward(point.latitude_deg, point.longitude_deg, point.height_m, result.origin_ecef_m[0],
               result.origin_ecef_m[1], result.origin_ecef_m[2], rows);
  double s = 0, c = 0;
  GeographicLib::Math::sincosd(place.heading_deg, s, c);
  for (std::size_t n = 0; n < 3; ++n) {
    const double east = rows[3 * n], north = rows[3 * n + 1], up = rows[3 * n + 2];
    result.axes[n] = c * east - s * north;
    result.axes[3 + n] = s * east + c * north;
    result.axes[6 + n] = up;
  }
  return result;
}

glm::dvec3 unit_vector(glm::dvec2 lat_lon_deg) {
  const double lat = lat_lon_deg.x * kDegree, lon = lat_lon_deg.y * kDegree;
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

glm::dvec2 lat_lon_deg_of(const glm::dvec3& u) {
  return {std::atan2(u.z, std::hypot(u.x, u.y)) / kDegree, std::atan2(u.y, u.x) / kDegree};
}

}  // namespace nepho
