// A height model joined to the ground around it.

#include "common/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/planet_ground.h"

namespace nepho {
namespace {

constexpr double kStep_rad = 1e-4;  // 637 m

SurfaceMap square(int n, double step_rad, float height_m) {
  SurfaceMap map;
  map.nx = map.ny = n;
  map.low_rad = glm::dvec2(-0.5 * step_rad * (n - 1));
  map.step_rad = glm::dvec2(step_rad);
  map.height_m.assign(std::size_t(n * n), height_m);
  map.water.assign(std::size_t(n * n), 0.0f);
  return map;
}

double height_m(const SurfaceMap& map, double x_rad, double y_rad) {
  const glm::dvec3 u(std::cos(y_rad) * std::cos(x_rad), std::cos(y_rad) * std::sin(x_rad),
                     std::sin(y_rad));
  const auto place = place_on(map, map.axes * u);
  return place ? place->value(map.height_m) : NAN;
}

TEST(Terrain, OwnGroundLiesAroundAndInGaps) {
  SurfaceMap fine = square(21, kStep_rad, 2000);
  fine.height_m[10 * 21 + 10] = NAN;
  const SurfaceMap own = square(11, 10 * kStep_rad, 700);
  const auto map = joined_ground(fine, own);
  ASSERT_NE(map, nullptr);
  EXPECT_LE(map->step_rad.x, kStep_rad * (1 + 1e-9));
  EXPECT_NEAR(height_m(*map, 5.4 * kStep_rad, 4 * kStep_rad), 2000, 1e-3);
  EXPECT_NEAR(height_m(*map, 0, 0), 700, 1e-3);
  EXPECT_NEAR(height_m(*map, 30 * kStep_rad, -20 * kStep_rad), 700, 1e-3);
  // Not a whole planet's: its nodes would be coarse.
  SurfaceMap globe = own;
  globe.around = true;
  EXPECT_EQ(joined_ground(fine, globe), nullptr);
}

TEST(Terrain, WithoutDataTheGroundFallsToTheSea) {
  SurfaceMap fine = square(41, kStep_rad, 2000);
  for (int j = 12; j < 30; ++j)
    for (int i = 12; i < 30; ++i) fine.height_m[std::size_t(41 * j + i)] = NAN;
  const auto map = filled_ground(fine);
  EXPECT_NEAR(height_m(*map, 15 * kStep_rad, -15 * kStep_rad), 2000, 1e-3);
  EXPECT_EQ(height_m(*map, 0, 0), 0);
  EXPECT_EQ(map->height_m.front(), 0);
  EXPECT_EQ(map->water.front(), 1);
  // A node beyond the edge: 637 m on, 1100 m down.
  EXPECT_NEAR(height_m(*map, 21 * kStep_rad, 0), 2000 - 1.732 * 6356752.3 * kStep_rad, 1);
  double steepest_m = 0;
  for (int j = 0; j < map->ny; ++j)
    for (int i = 0; i + 1 < map->nx; ++i) {
      const auto n = std::size_t(j * map->nx + i);
      ASSERT_FALSE(std::isnan(map->height_m[n]));
      steepest_m = std::max(steepest_m, double(std::abs(map->height_m[n + 1] - map->height_m[n])));
    }
  EXPECT_LT(steepest_m, 1.74 * 6356752.3 * kStep_rad);
}

}  // namespace
}  // namespace nepho
