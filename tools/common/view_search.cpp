#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/cloud_raster.h"
#include "common/planet_view.h"
#include "common/view_parts.h"
#include "geo/place.h"

namespace nepho {
namespace {

constexpr double kCellsAcross = 107;    // of the data: 6 pixels each in a picture of 640
constexpr double kMostOfBody = 0.3;     // of its radius: beyond, it is a view of the globe
constexpr double kFewCells = 8;         // to either side, where there is only a small cloud
constexpr double kTopsToSide = 3;       // and at least as many heights of the clouds
constexpr double kFlatHorizon = 0.8;    // of the half picture above its middle: flat weather
constexpr double kTowersHorizon = 0.6;  // and where clouds are as high as a third of the part
constexpr double kOverTop = 1.3;        // the eye over the highest cloud
constexpr double kClearance_m = 300;    // eye and view line over the terrain
constexpr int kHeadings = 24;
constexpr int kTargetsAcross = 16;  // of the search, at most

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// An eye whose line of sight, with the horizon at its place in the picture, meets the height
// `middle_m` some way ahead.
struct Slant {
  double eye_m = 0, ahead_rad = 0;  // the latter seen from the planet's centre
  double down_rad = 0, length_m = 0;
};
struct SlantRule {
  double middle_m, body_m, horizon_at;
  Lens lens;
};
Slant slant_from(double eye_m, const SlantRule& rule) {
  const double eye_r = rule.body_m + eye_m, there_r = rule.body_m + rule.middle_m;
  const double ground_r = rule.body_m + std::min(0.0, rule.middle_m);
#ifdef NEPHO_MUTANT_FLAT_EARTH
  const double dip_rad = 0 * ground_r;
#else
  const double dip_rad = std::acos(std::min(1.0, ground_r / eye_r));
#endif
  const double down_rad =
      dip_rad + std::atan(rule.horizon_at * std::tan(rule.lens.vertical_fov_rad / 2));
  const double ahead_rad =
      down_rad - std::acos(std::min(1.0, eye_r * std::cos(down_rad) / there_r));
  const double fall_m = eye_m - rule.middle_m, chord = 2 * std::sin(ahead_rad / 2);
  return {eye_m, ahead_rad, down_rad, std::sqrt(fall_m * fall_m + eye_r * there_r * chord * chord)};
}

// By halving: farther from higher.
Slant slant_that_reaches(double length_m, const SlantRule& rule) {
  double low_m = rule.middle_m + 1, high_m = rule.middle_m + rule.body_m;
  for (int n = 0; n < 60; ++n) {
    const double eye_m = 0.5 * (low_m + high_m);
    (slant_from(eye_m, rule).length_m < length_m ? low_m : high_m) = eye_m;
  }
  return slant_from(high_m, rule);
}

// The slant of a view that shows `part_m` to either side, above all clouds.
Slant slant_over(const CloudLayer& layer, double part_m, double body_m, const Lens& lens) {
  const double towers = smooth_step(0.05, 0.3, layer.top_m / part_m);
  const SlantRule rule{layer.middle_m, body_m,
                       kFlatHorizon + towers * (kTowersHorizon - kFlatHorizon), lens};
  const Slant slant = slant_that_reaches(part_m / std::tan(half_width_rad(lens)), rule);
  const double least_m = kOverTop * layer.top_m;
  return slant.eye_m < least_m ? slant_from(least_m, rule) : slant;
}

// Where one comes to on the sphere, from a direction along an azimuth. `axes` stand on the
// ellipsoid, whose normal is up to 0.2 degrees off the direction: 20 km.
glm::dvec3 moved(const glm::dvec3& direction, const LocalAxes& axes, double azimuth,
                 double by_rad) {
  return glm::normalize(std::cos(by_rad) * direction +
                        std::sin(by_rad) * heading_of(axes, azimuth));
}

bool clear_of_terrain(const PlanetGround& ground, const glm::dvec3& eye_m, const glm::dvec3& to_m) {
  constexpr int kPoints = 48;
  for (int n = 0; n < kPoints; ++n) {  // the target itself may stand in a valley
    const glm::dvec3 p = eye_m + (to_m - eye_m) * (0.9 * n / kPoints);
    if (geodetic_height_m(ground.body, p) < ground.height_m(p) + kClearance_m) return false;
  }
  return true;
}

// A view on trial: a place on the raster's plane, and a heading there.
struct Aim {
  glm::dvec2 place_m{0.0};
  double heading_rad = 0, score = -1;
};

// Tries headings at places, by the picture that each would give.
class Search {
 public:
  // The eye is `back_m` behind the place.
  Search(const CloudRaster& raster, const LayerHits& hits, double back_m,
         const PlanetGround& ground, const std::optional<glm::dvec3>& to_sun)
      : raster_(raster), hits_(hits), back_m_(back_m), ground_(ground), to_sun_(to_sun) {}

  // All headings at a place, each score times `factor`.
  void try_place(const glm::dvec2& place_m, double factor) {
    const glm::dvec3 direction = raster_.direction(place_m);
    const LocalAxes axes = ground_.axes(ground_.point_m(direction, 0));
    const double step_m = 1e-3 * raster_.radius_m(), step_rad = step_m / ground_.body.equatorial_m;
    const auto on_plane = [&](double azimuth) {
      return (raster_.plane_m(moved(direction, axes, azimuth, step_rad)) - place_m) / step_m;
    };
    const glm::dvec2 north = on_plane(0), east = on_plane(glm::half_pi<double>());
    for (int n = 0; n < kHeadings; ++n) {
      const double heading = glm::two_pi<double>() * n / kHeadings;
      if (!lit_from_the_side(axes, heading, to_sun_)) continue;
      const glm::dvec2 ahead = glm::normalize(std::cos(heading) * north + std::sin(heading) * east);
      const double score = factor * lit_well(axes, heading, to_sun_) *
                           structure(raster_, hits_, place_m - back_m_ * ahead, ahead);
      if (score > best.score) best = {place_m, heading, score};
    }
  }
  Aim best;

 private:
  const CloudRaster& raster_;
  const LayerHits& hits_;
  double back_m_;
  const PlanetGround& ground_;
  const std::optional<glm::dvec3>& to_sun_;
};

}  // namespace

double oblique_part_m(const CloudMap& map, const Ellipsoid& body) {
  const double top_m = layer_near(map, {0, 0, 1}, 3 * body.equatorial_m, body).top_m;
  const double cell_m = map.finest_cell_m;
  const double bulk_m = map.bulk().radius_rad * body.equatorial_m;
  const double wished_m = std::max(0.5 * kCellsAcross * cell_m, kTopsToSide * top_m);
  return std::max(std::min({wished_m, bulk_m, kMostOfBody * body.equatorial_m}),
                  std::max(kFewCells * cell_m, top_m));
}

PlanetView oblique_view(const CloudMap& map, double part_m, const std::optional<glm::dvec3>& target,
                        const PlanetGround& ground, const Lens& lens,
                        const std::optional<glm::dvec3>& to_sun) {
  const double body_m = ground.body.equatorial_m;
  Cap bulk = map.bulk();
  if (target) bulk = {*target, 0};
  const CloudLayer all = layer_near(map, bulk.direction, 3 * body_m, ground.body);
  const Slant trial = slant_over(all, part_m, body_m, lens);
  const double reach_m = bulk.radius_rad * body_m, back_m = trial.ahead_rad * body_m;
  const CloudRaster raster(map, bulk.direction, reach_m + 2 * part_m, ground);
  const LayerHits hits =
      layer_hits(trial.eye_m, -trial.down_rad, all.middle_m, body_m, 3 * back_m, lens);

  Search search(raster, hits, back_m, ground, to_sun);
  search.try_place({0, 0}, 1);
  double step_m = std::max(part_m / 3, 2 * reach_m / kTargetsAcross);
  if (!target) {
    const int side = int(reach_m / step_m);
    for (int j = -side; j <= side; ++j)
      for (int i = -side; i <= side; ++i) search.try_place(step_m * glm::dvec2(i, j), 1);
    for (int round = 0; round < 2; ++round) {
      step_m /= 2;
      const glm::dvec2 about_m = search.best.place_m;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) search.try_place(about_m + step_m * glm::dvec2(i, j), 1);
    }
  }

  const glm::dvec3 direction = raster.direction(search.best.place_m);
  const CloudLayer layer = layer_near(map, direction, 3 * part_m, ground.body);
  const Slant slant = slant_over(layer, part_m, body_m, lens);
  PlanetView view;
  view.centre_m = ground.point_m(direction, ground.height_m(ground.point_m(direction, 0)));
  const glm::dvec3 eye_direction =
      moved(direction, ground.axes(view.centre_m), search.best.heading_rad + glm::pi<double>(),
            slant.ahead_rad);
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

double standing_part_m(const CloudMap& map, const Ellipsoid& body) {
  const CloudLayer layer = layer_near(map, {0, 0, 1}, 3 * body.equatorial_m, body);
  return std::max(std::clamp(15 * layer.middle_m, 10e3, 60e3), 2 * map.finest_cell_m);
}

Stand place_to_stand(const CloudMap& map, const glm::dvec3& about, const PlanetGround& ground,
                     const Lens& lens, const std::optional<glm::dvec3>& to_sun) {
  const double body_m = ground.body.equatorial_m, part_m = standing_part_m(map, ground.body);
  const CloudLayer layer = layer_near(map, about, 2 * part_m, ground.body);
  const double over_m = std::max(layer.middle_m - ground.height_m(ground.point_m(about, 0)), 200.0);
  const CloudRaster raster(map, about, 3 * part_m, ground);
  const LayerHits hits =
      layer_hits(2, standing_pitch_rad(lens), over_m, body_m, 1.5 * part_m, lens);
  Search search(raster, hits, 0, ground, to_sun);
  // Open sky overhead (cloud of optical depth 4 is as bad as any), and clouds not so near that one
  // sees neither their tops nor their sides.
  const double open_m = std::max(0.7 * layer.top_m, 1.5 * map.cell_m);
  const auto open_sky = [&](const glm::dvec2& at_m) {
    double clear = 0;
    for (int n = 0; n < 25; ++n) {
      const glm::dvec2 off_m = 0.5 * open_m * glm::dvec2(n % 5 - 2, n / 5 - 2);
      clear += 1 - std::clamp(4.0 * raster.at(at_m + off_m), 0.0, 1.0);
    }
    return 0.01 + std::pow(clear / 25, 2);
  };
  constexpr int kSide = kTargetsAcross / 2;
  for (int j = -kSide; j <= kSide; ++j)
    for (int i = -kSide; i <= kSide; ++i) {
      const glm::dvec2 at_m = 1.5 * part_m / kSide * glm::dvec2(i, j);
      if (raster.at(at_m) >= 0 || (i == 0 && j == 0)) search.try_place(at_m, open_sky(at_m));
    }
  const GeodeticPoint place =
      geodetic_point(ground.body, ground.point_m(raster.direction(search.best.place_m), 0));
  Stand stand;
  stand.latitude_deg = place.latitude_deg;
  stand.longitude_deg = place.longitude_deg;
  stand.azimuth_deg = glm::degrees(search.best.heading_rad);
  return stand;
}

}  // namespace nepho
