#include "made_maps.h"

#include <cmath>

namespace nepho::samples {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

glm::dvec2 degrees(double lat_rad, double lon_deg) {
  return {lat_rad / kDegree, std::remainder(lon_deg, 360.0)};
}

// Azimuthal maps: at an angle c from the middle (eq. 20-14, 20-15).
glm::dvec2 at_angle(const MapOrigin& map, glm::dvec2 m, double c) {
  const double rho = glm::length(m), lat1 = map.latitude_deg * kDegree;
  if (rho == 0) return {map.latitude_deg, map.longitude_deg};
  const double lat =
      std::asin(std::cos(c) * std::sin(lat1) + m.y * std::sin(c) * std::cos(lat1) / rho);
  const double lon = std::atan2(
      m.x * std::sin(c), rho * std::cos(lat1) * std::cos(c) - m.y * std::sin(lat1) * std::sin(c));
  return degrees(lat, map.longitude_deg + lon / kDegree);
}

}  // namespace

glm::dvec2 from_mercator(const MapOrigin& map, double parallel_deg, glm::dvec2 m) {
  const double r = map.radius_m * std::cos(parallel_deg * kDegree);
  return degrees(std::atan(std::sinh(m.y / r)), map.longitude_deg + m.x / r / kDegree);
}

glm::dvec2 from_equal_area(const MapOrigin& map, glm::dvec2 m) {
  return at_angle(map, m, 2 * std::asin(glm::length(m) / (2 * map.radius_m)));
}

glm::dvec2 from_stereographic(const MapOrigin& map, double scale, glm::dvec2 m) {
  return at_angle(map, m, 2 * std::atan(glm::length(m) / (2 * map.radius_m * scale)));
}

glm::dvec2 from_transverse(const MapOrigin& map, double scale, glm::dvec2 m) {
  const double x = m.x / (map.radius_m * scale);
  const double d = m.y / (map.radius_m * scale) + map.latitude_deg * kDegree;
  return degrees(std::asin(std::sin(d) / std::cosh(x)),
                 map.longitude_deg + std::atan2(std::sinh(x), std::cos(d)) / kDegree);
}

glm::dvec2 from_polar(const PolarMap& map, glm::dvec2 m) {
  const double e2 = map.flattening * (2 - map.flattening), e = std::sqrt(e2);
  const auto small_t = [&](double lat) {
    const double s = e * std::sin(lat);
    return std::tan(3.14159265358979323846 / 4 - lat / 2) / std::pow((1 - s) / (1 + s), e / 2);
  };
  if (map.south) m = -m;
  double t = 0;
  if (map.scale_at_pole > 0) {
    t = glm::length(m) * std::sqrt(std::pow(1 + e, 1 + e) * std::pow(1 - e, 1 - e)) /
        (2 * map.equatorial_m * map.scale_at_pole);
  } else {
    const double lat = std::abs(map.true_latitude_deg) * kDegree;
    const double wide = std::cos(lat) / std::sqrt(1 - e2 * std::sin(lat) * std::sin(lat));
    t = glm::length(m) * small_t(lat) / (map.equatorial_m * wide);
  }
  double lat = 3.14159265358979323846 / 2 - 2 * std::atan(t);
  for (int turn = 0; turn < 20; ++turn) {
    const double s = e * std::sin(lat);
    lat = 3.14159265358979323846 / 2 - 2 * std::atan(t * std::pow((1 - s) / (1 + s), e / 2));
  }
  const double lon = std::atan2(m.x, -m.y) / kDegree;
  return map.south ? degrees(-lat, map.longitude_deg - lon) : degrees(lat, map.longitude_deg + lon);
}

glm::dvec2 from_rotated(glm::dvec2 pole, double north_longitude_deg, glm::dvec2 rotated_deg) {
  const double lat = pole.x * kDegree, lon = pole.y * kDegree;
  const glm::dvec3 up = {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                         std::sin(lat)};
  const glm::dvec3 to_north = glm::normalize(glm::dvec3(0, 0, 1) - up.z * up);
  const glm::dvec3 beside = glm::cross(up, to_north);
  const double x = (rotated_deg.x - north_longitude_deg) * kDegree, y = rotated_deg.y * kDegree;
  const glm::dvec3 u =
      std::cos(y) * (std::cos(x) * to_north + std::sin(x) * beside) + std::sin(y) * up;
  return degrees(std::atan2(u.z, std::hypot(u.x, u.y)), std::atan2(u.y, u.x) / kDegree);
}

glm::dvec2 from_view(double longitude_deg, double height_m, bool sweep_x, glm::dvec2 angle) {
  constexpr double kEquatorial_m = 6378137, kPolar_m = 6356752.31414;
  const double cx = std::cos(angle.x), sx = std::sin(angle.x), cy = std::cos(angle.y),
               sy = std::sin(angle.y);
  // From the satellite: towards the middle of the Earth, east, north.
  const glm::dvec3 look =
      sweep_x ? glm::dvec3(cx * cy, sx, cx * sy) : glm::dvec3(cx * cy, sx * cy, sy);
  const double far = kEquatorial_m + height_m, squash = std::pow(kEquatorial_m / kPolar_m, 2);
  const double a = look.x * look.x + look.y * look.y + squash * look.z * look.z;
  const double b = far * look.x, c = far * far - kEquatorial_m * kEquatorial_m;
  const double root = b * b - a * c;
  if (!(root > 0)) return glm::dvec2(NAN);
  const double way = (b - std::sqrt(root)) / a;
  const glm::dvec3 p = {far - way * look.x, way * look.y, way * look.z};
  return degrees(std::atan2(squash * p.z, std::hypot(p.x, p.y)),
                 longitude_deg + std::atan2(p.y, p.x) / kDegree);
}

}  // namespace nepho::samples
