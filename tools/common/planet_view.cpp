#include "common/planet_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "geo/place.h"

namespace nepho {
namespace {

constexpr double kHorizonAt = 0.6;    // of the half picture above its middle: a fifth is sky
constexpr double kPartFills = 0.75;   // of the picture's half width
constexpr double kOverTop = 1.3;      // the eye over the highest cloud
constexpr double kClearance_m = 300;  // eye and view line over the terrain
constexpr double kGlobeFills = 0.88;  // of the picture's shorter half, by angle
constexpr double kInSight_m = 80e3;   // clouds beyond are haze to who stands
constexpr double kSideOfSun_rad = glm::radians(100.0);
constexpr int kHeadings = 24;

double half_width_rad(const Lens& lens) {
  return std::atan(std::tan(lens.vertical_fov_rad / 2) * lens.aspect);
}

double turn_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, glm::two_pi<double>()));
}

glm::dvec3 heading_of(const LocalAxes& axes, double azimuth_rad) {
#ifdef NEPHO_MUTANT_HEADING_EAST_WEST
  azimuth_rad = -azimuth_rad;
#endif
  return std::sin(azimuth_rad) * axes.east + std::cos(azimuth_rad) * axes.north;
}

double azimuth_rad(const LocalAxes& axes, const glm::dvec3& direction) {
  return std::atan2(glm::dot(direction, axes.east), glm::dot(direction, axes.north));
}

// How well a heading is lit: best with the sun to the side, a little behind the shoulder.
double lit_well(const LocalAxes& axes, double heading_rad,
                const std::optional<glm::dvec3>& to_sun) {
  if (!to_sun) return 1;
  const double aside = turn_between(azimuth_rad(axes, *to_sun), heading_rad);
  const double off = (aside - kSideOfSun_rad) / glm::radians(45.0);
  return 0.25 + std::exp(-0.5 * off * off);
}

struct Layer {
  double top_m = 1000, middle_m = 500;
};

// Of the clouds within `radius_m` of a direction; of all, where there are none.
Layer layer_near(const CloudMap& map, const glm::dvec3& direction, double radius_m,
                 const Ellipsoid& body) {
  std::vector<double> tops_m;
  double weight = 0, middle_m = 0;
  for (const CloudColumn& c : map.columns) {
    if (glm::length(c.direction - direction) * body.equatorial_m > radius_m) continue;
    tops_m.push_back(c.top_m);
    weight += c.cloudiness() * c.area_m2;
    middle_m += c.cloudiness() * c.area_m2 * c.middle_m();
  }
  if (tops_m.empty()) return {};
  const auto high = tops_m.begin() + std::ptrdiff_t(0.98 * double(tops_m.size() - 1));
  std::nth_element(tops_m.begin(), high, tops_m.end());
  return {*high, middle_m / weight};
}

// An eye whose line of sight, with the horizon at its place in the picture, meets the height
// `middle_m` some way ahead.
struct Slant {
  double eye_m = 0, ahead_rad = 0;  // the latter seen from the planet's centre
  double length_m = 0;
};
Slant slant_from(double eye_m, double middle_m, double radius_m, const Lens& lens) {
  const double eye_r = radius_m + eye_m, ground_r = radius_m + std::min(0.0, middle_m);
#ifdef NEPHO_MUTANT_FLAT_EARTH
  const double dip_rad = 0 * ground_r;
#else
  const double dip_rad = std::acos(std::min(1.0, ground_r / eye_r));
#endif
  const double down_rad = dip_rad + std::atan(kHorizonAt * std::tan(lens.vertical_fov_rad / 2));
  const double there = eye_r * std::cos(down_rad) / (radius_m + middle_m);
  const double ahead_rad = down_rad - std::acos(std::min(1.0, there));
  const double fall_m = eye_m - middle_m, chord = 2 * std::sin(ahead_rad / 2);
  return {eye_m, ahead_rad,
          std::sqrt(fall_m * fall_m + eye_r * (radius_m + middle_m) * chord * chord)};
}

// By halving: farther from higher.
Slant slant_that_reaches(double length_m, double middle_m, double radius_m, const Lens& lens) {
  double low_m = middle_m + 1, high_m = middle_m + radius_m;
  for (int n = 0; n < 60; ++n) {
    const double eye_m = 0.5 * (low_m + high_m);
    const bool short_of = slant_from(eye_m, middle_m, radius_m, lens).length_m < length_m;
    (short_of ? low_m : high_m) = eye_m;
  }
  return slant_from(high_m, middle_m, radius_m, lens);
}

// Where one comes to on the sphere, from a direction along an azimuth. `axes` stand on the
// ellipsoid, whose normal is up to 0.2 degrees off the direction: 20 km.
glm::dvec3 moved(const glm::dvec3& direction, const LocalAxes& axes, double azimuth,
                 double by_rad) {
  return glm::normalize(std::cos(by_rad) * direction +
                        std::sin(by_rad) * heading_of(axes, azimuth));
}

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

bool clear_of_terrain(const PlanetGround& ground, const glm::dvec3& eye_m, const glm::dvec3& to_m) {
  constexpr int kPoints = 48;
  for (int n = 0; n < kPoints; ++n) {  // the target itself may stand in a valley
    const glm::dvec3 p = eye_m + (to_m - eye_m) * (0.9 * n / kPoints);
    if (geodetic_height_m(ground.body, p) < ground.height_m(p) + kClearance_m) return false;
  }
  return true;
}

}  // namespace

double oblique_part_m(const CloudMap& map, const Ellipsoid& body) {
  const double extent_m = map.extent().radius_rad * body.equatorial_m;
  return std::min(std::max(10 * map.finest_cell_m, 20e3),
                  std::max(extent_m / 2.5, 3 * map.finest_cell_m));
}

PlanetView oblique_view(const CloudMap& map, const glm::dvec3& direction,
                        const PlanetGround& ground, const Lens& lens,
                        const std::optional<glm::dvec3>& to_sun) {
  const double radius_m = ground.body.equatorial_m, part_m = oblique_part_m(map, ground.body);
  const Layer layer = layer_near(map, direction, 3 * part_m, ground.body);
  const double length_m = part_m / (kPartFills * std::tan(half_width_rad(lens)));
  Slant slant = slant_that_reaches(length_m, layer.middle_m, radius_m, lens);
  if (slant.eye_m < kOverTop * layer.top_m)
    slant = slant_from(kOverTop * layer.top_m, layer.middle_m, radius_m, lens);

  PlanetView view;
  view.centre_m = ground.point_m(direction, ground.height_m(ground.point_m(direction, 0)));
  const LocalAxes axes = ground.axes(view.centre_m);
  double best = -1, best_heading = 0;
  for (int n = 0; n < kHeadings; ++n) {
    const double heading = glm::two_pi<double>() * n / kHeadings;
    const glm::dvec3 back = moved(direction, axes, heading + glm::pi<double>(), slant.ahead_rad);
    const double score = lit_well(axes, heading, to_sun) *
                         cloud_ahead(map, back, axes, heading, half_width_rad(lens),
                                     slant.ahead_rad, 8 * slant.ahead_rad);
    if (score > best) best = score, best_heading = heading;
  }

  const glm::dvec3 eye_direction =
      moved(direction, axes, best_heading + glm::pi<double>(), slant.ahead_rad);
  Camera& camera = view.camera;
  camera.vertical_fov_rad = lens.vertical_fov_rad;
  camera.target_m = ground.point_m(direction, layer.middle_m);
  double eye_m = slant.eye_m;
  for (int n = 0; n < 20; ++n, eye_m = 1.2 * eye_m + kClearance_m) {
    camera.eye_m = ground.point_m(eye_direction, eye_m);
    if (clear_of_terrain(ground, camera.eye_m, camera.target_m)) break;
  }
  camera.up = ground.axes(camera.eye_m).up;
  return view;
}

PlanetView globe_view(const CloudMap& map, const PlanetGround& ground, const Lens& lens,
                      const std::optional<glm::dvec3>& to_sun) {
  constexpr int kSides = 600;
  constexpr double kGoldenTurn_rad = 2.399963229728653;
  glm::dvec3 best_side{1, 0, 0};
  double best = -1;
  for (int n = 0; n < kSides; ++n) {
    const double z = 1 - (2 * n + 1.0) / kSides, r = std::sqrt(1 - z * z);
    const glm::dvec3 side = {r * std::cos(kGoldenTurn_rad * n), r * std::sin(kGoldenTurn_rad * n),
                             z};
    double sum = 0;
    for (const CloudColumn& c : map.columns) {
      const double facing = glm::dot(c.direction, side);
      if (facing < 0.15) continue;  // seen edge on
      const double light = to_sun ? std::max(0.0, glm::dot(c.direction, *to_sun)) : 1;
      sum += c.cloudiness() * c.area_m2 * facing * light;
    }
    if (to_sun) {  // half a moon is dramatic, a full one flat
      const double off =
          (std::acos(glm::clamp(glm::dot(side, *to_sun), -1.0, 1.0)) - glm::radians(40.0)) /
          glm::radians(25.0);
      sum *= 0.05 + std::exp(-0.5 * off * off);
    }
    sum *= 0.2 + r;  // poles last
    if (sum > best) best = sum, best_side = side;
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
  double pitch_rad = std::atan(kHorizonAt * std::tan(lens.vertical_fov_rad / 2));
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

Stand place_to_stand(const CloudMap& map, const glm::dvec3& direction, const PlanetGround& ground) {
  constexpr double kCloudStands_rad = glm::radians(15.0);
  const glm::dvec3 under = ground.point_m(direction, 0);
  const LocalAxes axes = ground.axes(under);
  const Layer layer = layer_near(map, direction, std::max(30e3, 2 * map.cell_m), ground.body);
  const double off_m = std::clamp(layer.middle_m / std::tan(kCloudStands_rad), 3e3, 40e3);
  const double wide_m = std::max(0.5 * off_m, 0.5 * map.cell_m);
  double least = -1, heading = 0, away_rad = 0;
  for (int n = 0; n < 3 * kHeadings; ++n) {
    const double candidate = glm::two_pi<double>() * n / kHeadings;
    const double farther = 1 + 0.7 * (n / kHeadings);  // near is better, if it is as open
    const double candidate_rad = farther * off_m / ground.body.equatorial_m;
    const glm::dvec3 there = moved(direction, axes, candidate, candidate_rad);
    double cover = 0;
    for (const CloudColumn& c : map.columns) {
      const double apart = glm::length(c.direction - there) * ground.body.equatorial_m / wide_m;
      cover += c.cloudiness() * c.area_m2 * std::exp(-0.5 * apart * apart);
    }
    cover *= farther;
    if (least < 0 || cover < least) least = cover, heading = candidate, away_rad = candidate_rad;
  }
  const GeodeticPoint place =
      geodetic_point(ground.body, ground.point_m(moved(direction, axes, heading, away_rad), 0));
  Stand stand;
  stand.latitude_deg = place.latitude_deg;
  stand.longitude_deg = place.longitude_deg;
  stand.azimuth_deg = std::fmod(glm::degrees(heading) + 180, 360);
  return stand;
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
