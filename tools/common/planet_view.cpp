#include "common/planet_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "common/view_parts.h"
#include "geo/place.h"

namespace nepho {
namespace {

constexpr double kGlobeFills = 0.88;  // of the picture's shorter half, by angle
constexpr double kInSight_m = 80e3;   // clouds beyond are haze to who stands
constexpr int kHeadings = 24;

// Cloud in the wedge ahead of an eye, nearer parts counting more.
double cloud_ahead(const CloudMap& map, const glm::dvec3& eye_direction, const LocalAxes& eye_axes,
                   double heading_rad, double half_rad, double near_rad, double far_rad) {
  double sum = 0;
  for (const CloudColumn& c : map.columns) {
    const glm::dvec3 d = c.direction - eye_direction;
    const double apart = glm::length(d);
    const double off = turn_between(azimuth_rad(eye_axes, d), heading_rad) / half_rad;
    if (apart > far_rad || off > 1) continue;
    sum +=
        (1 - 0.9 * off * off) * c.cloudiness() * c.area_m2 / (apart * apart + near_rad * near_rad);
  }
  return sum;
}

// Directions spread evenly (a Fibonacci spiral).
std::vector<glm::dvec3> all_around() {
  constexpr int kSides = 600;
  constexpr double kGoldenTurn_rad = 2.399963229728653;
  std::vector<glm::dvec3> sides;
  for (int n = 0; n < kSides; ++n) {
    const double z = 1 - (2 * n + 1.0) / kSides, r = std::sqrt(1 - z * z);
    const double turn_rad = kGoldenTurn_rad * n;
    sides.emplace_back(r * std::cos(turn_rad), r * std::sin(turn_rad), z);
  }
  return sides;
}

}  // namespace

PlanetView globe_view(const CloudMap& map, const PlanetGround& ground, const Lens& lens,
                      const std::optional<glm::dvec3>& to_sun) {
  const std::vector<glm::dvec3> sides = all_around();
  const double share_m2 = 4 * glm::pi<double>() * ground.body.equatorial_m *
                          ground.body.equatorial_m / double(sides.size());
  glm::dvec3 best_side{1, 0, 0};
  double best = -1;
  for (const glm::dvec3& side : sides) {
    const auto counts = [&](const glm::dvec3& place) {
      const double facing = glm::dot(place, side);
      if (facing < 0.15) return 0.0;  // seen edge on
      return facing * (to_sun ? std::max(0.0, glm::dot(place, *to_sun)) : 1);
    };
    // Cloud and gaps, rather than the most cloud: an overcast side shows nothing.
    double all = 0, sum = 0, squares = 0;
    for (const glm::dvec3& place : sides) all += share_m2 * counts(place);
    for (const CloudColumn& c : map.columns) {
      const double weight = c.area_m2 * counts(c.direction);
      sum += weight * c.cloudiness();
      squares += weight * c.cloudiness() * c.cloudiness();
    }
    if (!(all > 0)) continue;
    double score = std::sqrt(std::max(0.0, squares / all - sum * sum / (all * all)));
    if (to_sun) {  // half a moon is dramatic, a full one flat
      const double off =
          (std::acos(glm::clamp(glm::dot(side, *to_sun), -1.0, 1.0)) - glm::radians(40.0)) /
          glm::radians(25.0);
      score *= 0.05 + std::exp(-0.5 * off * off);
    }
    score *= 0.2 + std::hypot(side.x, side.y);  // poles last
    if (score > best) best = score, best_side = side;
  }
  PlanetView view;
  view.centre_m = ground.point_m(best_side, 0);
  Camera& camera = view.camera;
  camera.vertical_fov_rad = lens.vertical_fov_rad;
  const double half_rad = std::min(lens.vertical_fov_rad / 2, half_width_rad(lens));
  camera.target_m = view.centre_m;
  camera.eye_m =
      glm::normalize(view.centre_m) * ground.body.equatorial_m / std::sin(kGlobeFills * half_rad);
  camera.up = {0, 0, 1};
  return view;
}

PlanetView standing_view(const Stand& stand, const CloudMap& near, const PlanetGround& ground,
                         const Lens& lens, const std::optional<glm::dvec3>& to_sun) {
  GeodeticPoint place{stand.latitude_deg, stand.longitude_deg, 0};
  place.height_m = ground.height_m(ecef_m(ground.body, place));
  PlanetView view;
  view.centre_m = ecef_m(ground.body, place);
  const LocalAxes axes = ground.axes(view.centre_m);
  const glm::dvec3 here = glm::normalize(view.centre_m);
  const double half_rad = half_width_rad(lens), far_rad = kInSight_m / ground.body.equatorial_m;
  const double near_rad = 3e3 / ground.body.equatorial_m;

#ifdef NEPHO_MUTANT_DEGREES_FOR_RADIANS
  double heading = stand.azimuth_deg.value_or(0);
#else
  double heading = glm::radians(stand.azimuth_deg.value_or(0));
#endif
  if (!stand.azimuth_deg) {
    double best = -1;
    for (int n = 0; n < kHeadings; ++n) {
      const double candidate = glm::two_pi<double>() * n / kHeadings;
      const double score =
          lit_well(axes, candidate, to_sun) *
          (1e-3 + cloud_ahead(near, here, axes, candidate, half_rad, near_rad, far_rad));
      if (score > best) best = score, heading = candidate;
    }
  }
  double pitch_rad = standing_pitch_rad(lens);
  if (stand.elevation_deg) {
    pitch_rad = glm::radians(*stand.elevation_deg);
  } else {  // higher, where the clouds ahead are
    double weight = 0, sum_rad = 0;
    for (const CloudColumn& c : near.columns) {
      const double away = glm::length(c.direction - here);
      if (away > far_rad || turn_between(azimuth_rad(axes, c.direction - here), heading) > half_rad)
        continue;
      const double w = c.cloudiness() * c.area_m2 / (away * away + near_rad * near_rad);
      weight += w;
      sum_rad += w * std::atan2(c.middle_m() - place.height_m, away * ground.body.equatorial_m);
    }
    if (weight > 0) pitch_rad = std::clamp(sum_rad / weight, pitch_rad, glm::radians(35.0));
  }
  Camera& camera = view.camera;
  camera.vertical_fov_rad = lens.vertical_fov_rad;
  place.height_m += stand.eye_height_m;
  camera.eye_m = ecef_m(ground.body, place);
  camera.target_m = camera.eye_m + 1000.0 * (std::cos(pitch_rad) * heading_of(axes, heading) +
                                             std::sin(pitch_rad) * axes.up);
  // Looking straight up, the heading says what is up in the picture.
  camera.up = std::abs(std::cos(pitch_rad)) > 1e-6 ? axes.up : -heading_of(axes, heading);
  return view;
}

glm::dvec2 sun_angles_deg(const LocalAxes& axes, const glm::dvec3& to_sun) {
  const double azimuth_deg = glm::degrees(azimuth_rad(axes, to_sun));
  return {azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg,
          glm::degrees(std::asin(glm::clamp(glm::dot(to_sun, axes.up), -1.0, 1.0)))};
}

glm::dvec3 sun_to_the_side(const Camera& camera, const LocalAxes& axes) {
  constexpr double elevation_rad = glm::radians(35.0);
  glm::dvec3 view = camera.target_m - camera.eye_m;
  // Looking straight down, the picture's upper edge says where "ahead" is.
  if (glm::length(glm::cross(glm::normalize(view), axes.up)) < 1e-3) view = camera.up;
  const double azimuth = azimuth_rad(axes, view) - kSideOfSun_rad;
  return std::cos(elevation_rad) * heading_of(axes, azimuth) + std::sin(elevation_rad) * axes.up;
}

}  // namespace nepho
