#include "reference/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

// Rays that start on terrain: they see what is above it, from their very first millimetre.

namespace nepho::test {
namespace {

constexpr double kRadius_m = 6.371e6, kCell_m = 1000;
constexpr int kNodes = 41;

// Over the middle of a map: x east, y north, in cells; z up.
class Terrain {
 public:
  template <class Height>
  explicit Terrain(Height&& height_m) {
    map_.axes = {glm::dvec3{0, 0, 1}, glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0}};
    map_.nx = map_.ny = kNodes;
    map_.step_rad = glm::dvec2{kCell_m / kRadius_m};
    map_.low_rad = -0.5 * (kNodes - 1) * map_.step_rad;
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) map_.height_m.push_back(float(height_m(i, j)));
    map_.water.assign(map_.height_m.size(), 0);
  }
  PlanetSurface surface() const { return {Ellipsoid::sphere(kRadius_m), &map_}; }

  double height_m(double x, double y) const {
    if (!(x >= 0 && y >= 0 && x <= kNodes - 1 && y <= kNodes - 1)) return 0;
    const int i = std::min(int(x), kNodes - 2), j = std::min(int(y), kNodes - 2);
    const auto node = [&](int a, int b) {
      return double(map_.height_m[std::size_t((j + b) * kNodes + i + a)]);
    };
    const double f = x - i, g = y - j;
    return (1 - g) * ((1 - f) * node(0, 0) + f * node(1, 0)) +
           g * ((1 - f) * node(0, 1) + f * node(1, 1));
  }
  glm::dvec3 point_m(double x, double y) const {
    const glm::dvec2 angle = map_.low_rad + map_.step_rad * glm::dvec2{x, y};
    return (kRadius_m + height_m(x, y)) * glm::dvec3{std::sin(angle.x) * std::cos(angle.y),
                                                     std::sin(angle.y),
                                                     std::cos(angle.x) * std::cos(angle.y)};
  }
  double gap_m(const glm::dvec3& p) const {
    const double r = glm::length(p);
    const glm::dvec2 angle{std::atan2(p.x, p.z), std::asin(p.y / r)};
    const glm::dvec2 at = (angle - map_.low_rad) / map_.step_rad;
    return r - kRadius_m - height_m(at.x, at.y);
  }

 private:
  SurfaceMap map_;
};

glm::dvec3 rising(double slope) {
  return glm::normalize(glm::dvec3{1, 0, slope});
}

// A wall one cell wide, 300 m high, hides a sun of slope 0.29 from what is nearer than 0.034 cells.
TEST(TerrainRays, LeakNoLightAtTheFootOfAWall) {
  const Terrain wall([](int i, int) { return i > 20 ? 300 : 0; });
  const PlanetSurface surface = wall.surface();
  for (const double apart : {1e-4, 1e-3, 0.01, 0.03}) {
    const glm::dvec3 foot_m = wall.point_m(20 - apart, 20.3);
    EXPECT_LT(surface.distance_m({foot_m, rising(0.29)}, true), kNoDistance_m) << apart;
    EXPECT_EQ(surface.distance_m({foot_m, rising(0.35)}, true), kNoDistance_m) << apart;
  }
}

TEST(TerrainRays, AreNotHiddenByTheSlopeTheyStartOn) {
  const Terrain wall([](int i, int) { return i > 20 ? 300 : 0; });
  const PlanetSurface surface = wall.surface();
  for (double x = 20.01; x < 21; x += 0.0137) {
    const glm::dvec3 point_m = wall.point_m(x, 20.3);
    EXPECT_EQ(surface.distance_m({point_m, rising(0.301)}, true), kNoDistance_m) << x;
    EXPECT_EQ(surface.distance_m({point_m, rising(0.299)}, true), 0) << x;
  }
}

// Against steps of a five-thousandth of a cell, for points near and far from the creases. Rays that
// pass ridges within a centimetre may go either way.
TEST(TerrainRays, MeetWhatFineStepsMeet) {
  constexpr double top_m = 300, step_m = 2e-4 * kCell_m, unclear_m = 0.01;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  const Terrain rough([&](int, int) { return top_m * part(random); });
  const PlanetSurface surface = rough.surface();
  int hidden = 0, open = 0, near = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const double off = trial % 2 ? part(random) : 0.02 * part(random);
    const glm::dvec3 point_m =
        rough.point_m(15 + int(10 * part(random)) + off, 15 + 10 * part(random));
    const double azimuth = 6.2831853 * part(random), slope = 0.3 * part(random);
    const Ray ray{point_m, glm::normalize(glm::dvec3{std::cos(azimuth), std::sin(azimuth), slope})};
    double lowest_m = 1, meets_m = kNoDistance_m;
    for (double t = 0.1; meets_m == kNoDistance_m; t += step_m) {
      const glm::dvec3 p = ray.origin_m + t * ray.direction;
      if (glm::length(p) > kRadius_m + top_m) break;
      lowest_m = std::min(lowest_m, rough.gap_m(p));
      if (lowest_m < 0) meets_m = t;
    }
    const double ours_m = surface.distance_m(ray, true);
    EXPECT_EQ(surface.hides(ray, true), ours_m < kNoDistance_m) << trial;
    if (ours_m > 0 && ours_m < kNoDistance_m) {
      const glm::dvec3 met_m = ray.origin_m + ours_m * ray.direction;
      EXPECT_NEAR(rough.gap_m(met_m), 0, 2e-8) << trial;
      EXPECT_EQ(surface.distance_m(ray, true, ours_m - 1e-3), kNoDistance_m) << trial;
      EXPECT_NEAR(surface.distance_m(ray, true, ours_m + 1e-3), ours_m, 1e-6) << trial;
    }
    if (meets_m < kNoDistance_m) {
      ++hidden;
      near += meets_m < 0.02 * kCell_m;
      const glm::dvec3 beyond = ray.origin_m + (meets_m + 0.01 * kCell_m) * ray.direction;
      if (rough.gap_m(beyond) < -unclear_m) {
        EXPECT_LE(ours_m, meets_m + 1e-6) << trial;
        EXPECT_GE(ours_m, meets_m - step_m - 0.1) << trial;
      }
    } else if (lowest_m > 1e-6) {
      ++open;
      EXPECT_EQ(ours_m, kNoDistance_m) << trial;
    }
  }
  EXPECT_GT(hidden, 80);
  EXPECT_GT(open, 80);
  EXPECT_GT(near, 20);
}

}  // namespace
}  // namespace nepho::test
