#pragma once

#include "scenes.h"

namespace nepho::test {

// A spherical planet with its pole for a place.
inline constexpr double kRadius_m = 6.36e6;
inline constexpr glm::dvec3 kUp{0, 0, 1}, kNorth{0, 1, 0};

inline glm::dvec3 sun_at(double elevation_deg, double azimuth_deg = 0) {
  const double e = elevation_deg * kPi / 180, a = azimuth_deg * kPi / 180;
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

inline RenderRequest planet_request(std::initializer_list<const BrickSource*> sources) {
  RenderRequest request = request_of(sources);
  request.planet = Planet{};
  request.planet->body = Ellipsoid::sphere(kRadius_m);
  request.sun = {sun_at(40), {1.6, 1.85, 2.0}};
  return request;
}

inline void look(RenderRequest& request, double height_m, double pitch_deg, double fov_deg = 60) {
  const double p = pitch_deg * kPi / 180;
  const glm::dvec3 eye = (kRadius_m + height_m) * kUp;
  request.camera = {eye, eye + 1e4 * (std::cos(p) * kNorth + std::sin(p) * kUp),
                    std::abs(pitch_deg) > 80 ? kNorth : kUp, fov_deg * kPi / 180};
}

// A box of cloud, by whose edges the ground's and the air's shadows are known.
struct Slab {
  double low_m, high_m, half_width_m;
  FieldSource source;
  Slab(double low, double high, double half_width, double extinction, int levels = 1)
      : low_m(low),
        high_m(high),
        half_width_m(half_width),
        source(std::make_shared<BoxChart>(
                   glm::dvec3(-half_width, -half_width, kRadius_m + low),
                   glm::dmat3(2 * half_width, 0., 0., 0., 2 * half_width, 0., 0., 0., high - low)),
               isotropic(levels), [=](glm::dvec3) { return extinction; }) {}
  // Metres of the slab between a point and the sun.
  double shade_m(const glm::dvec3& p, const glm::dvec3& to_sun) const {
    double enter = 0, leave = 1e12;
    const glm::dvec3 low(-half_width_m, -half_width_m, kRadius_m + low_m);
    const glm::dvec3 high(half_width_m, half_width_m, kRadius_m + high_m);
    for (int a = 0; a < 3; ++a) {
      const double t0 = (low[a] - p[a]) / to_sun[a], t1 = (high[a] - p[a]) / to_sun[a];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return std::max(leave - enter, 0.0);
  }
};

// A ridge from east to west, `at_m` north of the pole, on a map of `cell_m`; all of it land.
inline std::shared_ptr<SurfaceMap> ridge_map(double at_m, double peak_m, double half_m,
                                             double cell_m) {
  auto map = std::make_shared<SurfaceMap>();
  map->axes = glm::dmat3(kUp, glm::dvec3(1, 0, 0), kNorth);  // columns centre, east, north
  map->nx = map->ny = 1 + int(60e3 / cell_m);
  map->low_rad = glm::dvec2(-30e3 / kRadius_m);
  map->step_rad = glm::dvec2(cell_m / kRadius_m);
  for (int j = 0; j < map->ny; ++j)
    for (int i = 0; i < map->nx; ++i) {
      const double north_m = -30e3 + cell_m * j;
      map->height_m.push_back(float(peak_m * std::max(0.0, 1 - std::abs(north_m - at_m) / half_m)));
      map->water.push_back(0);
    }
  return map;
}

}  // namespace nepho::test
