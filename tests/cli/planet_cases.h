#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/cloud_raster.h"
#include "common/planet_view.h"
#include "geo/place.h"
#include "weather_source.h"

// What tests of a planet's views share: weather, where it is, and where it appears.
namespace nepho::test {

inline constexpr double kEarth_m = 6378137;
inline const Ellipsoid kEarth = Ellipsoid::wgs84();

// A thick patch in the west, a thin one in the east, 600 km apart.
inline const std::vector<Blob> kTwoPatches = {{30, -90, 200e3, 4000, 2500, 2e-3},
                                              {30, -83, 200e3, 4000, 2500, 2e-5}};

inline std::unique_ptr<WeatherSource> two_patches() {
  static const auto field = blobs(kTwoPatches, 4);
  return std::make_unique<WeatherSource>(field);
}

// A cover of the whole globe, thick over the Indian ocean.
inline std::unique_ptr<WeatherSource> cloudy_globe() {
  static const auto field =
      blobs({{0, 0, 2e7, 4000, 3000, 2e-4}, {-10, 75, 1.5e6, 4000, 3000, 5e-3}}, 3);
  return std::make_unique<WeatherSource>(field);
}

// Where a point appears, -1 to 1 from left to right and from below to above; and whether ahead.
struct Seen {
  double x, y;
  bool ahead;
};
inline Seen seen(const Camera& c, double aspect, const glm::dvec3& direction) {
  const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, c.up));
  const glm::dvec3 upward = glm::cross(right, forward);
  const double tan_y = std::tan(c.vertical_fov_rad / 2), ahead = glm::dot(direction, forward);
  return {glm::dot(direction, right) / (ahead * tan_y * aspect),
          glm::dot(direction, upward) / (ahead * tan_y), ahead > 0};
}

// The line between sphere and space, straight ahead.
inline double horizon_in_picture(const Camera& c, double aspect) {
  const glm::dvec3 up = glm::normalize(c.eye_m);
  const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
  const glm::dvec3 level = glm::normalize(forward - glm::dot(forward, up) * up);
  const double height_m = geodetic_height_m(kEarth, c.eye_m);
  const double dip = std::acos(kEarth_m / (kEarth_m + height_m));
  return seen(c, aspect, std::cos(dip) * level - std::sin(dip) * up).y;
}

inline glm::dvec3 direction_to(double latitude_deg, double longitude_deg) {
  return glm::normalize(ecef_m(kEarth, {latitude_deg, longitude_deg, 0}));
}
inline double away_m(const glm::dvec3& a, const glm::dvec3& b) {
  return kEarth_m *
         std::acos(glm::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0));
}

inline double heading_rad(const LocalAxes& axes, const glm::dvec3& direction) {
  return std::atan2(glm::dot(direction, axes.east), glm::dot(direction, axes.north));
}

// A map around a direction, on axes of its own, all of one height.
inline std::shared_ptr<SurfaceMap> square_about(const glm::dvec3& centre, double half_rad,
                                                float height_m) {
  auto map = std::make_shared<SurfaceMap>();
  const glm::dvec3 east = PlanetGround{kEarth, {}}.axes(centre * kEarth_m).east;
  map->axes = glm::dmat3(centre, east, glm::cross(centre, east));
  map->low_rad = {-half_rad, -half_rad};
  map->step_rad = {half_rad / 15, half_rad / 15};
  map->nx = map->ny = 31;
  map->height_m.assign(31 * 31, height_m);
  map->water.assign(31 * 31, 0.0f);
  return map;
}
// What the data of deck_with_eye() are known to cover.
inline std::shared_ptr<SurfaceMap> known_square(const glm::dvec3& middle) {
  return square_about(middle, 900e3 / kEarth_m, 0);
}

// A deck of cells of 10 km with a clear eye in it, as a source might give it; the rest of a domain
// of `wide_m` to either side is clear.
inline CloudMap deck_with_eye(const glm::dvec3& middle, double deck_m, const glm::dvec3& eye,
                              double eye_m) {
  constexpr double kCell_m = 10e3;
  CloudMap map;
  map.cell_m = map.finest_cell_m = kCell_m;
  const LocalAxes axes = PlanetGround{kEarth, {}}.axes(middle * kEarth_m);
  for (double y_m = -deck_m; y_m <= deck_m; y_m += kCell_m)
    for (double x_m = -deck_m; x_m <= deck_m; x_m += kCell_m) {
      const glm::dvec3 d = glm::normalize(middle + (x_m * axes.east + y_m * axes.north) / kEarth_m);
      if (away_m(d, eye) < eye_m) continue;
      map.columns.push_back({d, kCell_m * kCell_m, 40, 1000, 7000});
    }
  return map;
}

inline constexpr double kWide_m = 900e3;
inline const std::pair<double, double> kPlaces[] = {
    {30, -90}, {0, 179.9}, {89.9, 40}, {-60, -179.5}};

inline std::shared_ptr<SurfaceMap> plateau(double latitude_deg, double longitude_deg,
                                           float height_m) {
  return square_about(direction_to(latitude_deg, longitude_deg), 0.15, height_m);
}

}  // namespace nepho::test
