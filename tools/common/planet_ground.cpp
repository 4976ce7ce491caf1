#include "common/planet_ground.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "geo/place.h"

namespace nepho {

std::optional<MapPlace> place_on(const SurfaceMap& map, const glm::dvec3& scaled) {
  if (map.nx < 1 || map.ny < 1) return std::nullopt;
  const glm::dvec3 v = glm::transpose(map.axes) * scaled;  // along centre, east, north
  double x_rad = std::atan2(v.y, v.x) - map.low_rad.x;
  if (map.around) x_rad -= glm::two_pi<double>() * std::floor(x_rad / glm::two_pi<double>());
  const double x = x_rad / map.step_rad.x;
  const double y = (std::asin(std::clamp(v.z, -1.0, 1.0)) - map.low_rad.y) / map.step_rad.y;
  const double last_x = map.around ? map.nx : map.nx - 1;
  if (!(x >= 0 && x <= last_x && y >= 0 && y <= map.ny - 1)) return std::nullopt;
  const int i = std::min(int(x), map.around ? map.nx - 1 : std::max(map.nx - 2, 0));
  const int j = std::min(int(y), std::max(map.ny - 2, 0));
  const int i1 = map.around ? (i + 1) % map.nx : std::min(i + 1, map.nx - 1);
  const int j1 = std::min(j + 1, map.ny - 1);
  const auto at = [&](int column, int row) {
    return std::size_t(row) * std::size_t(map.nx) + std::size_t(column);
  };
  const double fx = x - i, fy = y - j;
  return MapPlace{{at(i, j), at(i1, j), at(i, j1), at(i1, j1)},
                  {(1 - fy) * (1 - fx), (1 - fy) * fx, fy * (1 - fx), fy * fx}};
}

bool map_height_m(const SurfaceMap& map, const Ellipsoid& body, const glm::dvec3& ecef_m,
                  double& height_m) {
  const glm::dvec3 scaled(ecef_m.x, ecef_m.y, ecef_m.z * body.equatorial_m / body.polar_m);
  const auto place = place_on(map, glm::normalize(scaled));
  if (!place) return false;
  height_m = place->value(map.height_m);
  return true;
}

double PlanetGround::height_m(const glm::dvec3& ecef_m) const {
  double result = 0;
  for (const auto& map : maps)
    if (map && map_height_m(*map, body, ecef_m, result)) return result;
  return 0;
}

bool PlanetGround::known(const glm::dvec3& ecef_m) const {
  double ignored_m = 0;
  return maps.empty() || std::ranges::any_of(maps, [&](const auto& map) {
           return map && map_height_m(*map, body, ecef_m, ignored_m);
         });
}

glm::dvec3 PlanetGround::point_m(const glm::dvec3& direction, double height_m) const {
  GeodeticPoint point = geodetic_point(body, direction * body.equatorial_m);
  point.height_m = height_m;
  return ecef_m(body, point);
}

LocalAxes PlanetGround::axes(const glm::dvec3& ecef_m) const {
  const GeodeticPoint point = geodetic_point(body, ecef_m);
  const double phi = glm::radians(point.latitude_deg), lambda = glm::radians(point.longitude_deg);
  LocalAxes axes;
  axes.up = {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)};
  axes.east = {-std::sin(lambda), std::cos(lambda), 0};
  axes.north = glm::cross(axes.up, axes.east);
  return axes;
}

}  // namespace nepho
