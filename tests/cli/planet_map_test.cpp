// Where a planet's clouds and ground are, as its views see them.
#include <gtest/gtest.h>

#include "planet_cases.h"

namespace nepho {
namespace {

using namespace test;

TEST(CloudMap, holds_the_columns_optical_depth_where_the_cloud_is) {
  const auto source = two_patches();
  const CloudMap map = cloud_map(*source, 0, kEarth);
  ASSERT_FALSE(map.empty());
  double most = 0;
  glm::dvec3 where{0.0};
  for (const CloudColumn& c : map.columns)
    if (c.optical_depth > most) most = c.optical_depth, where = c.direction;
  // 5 km of 2e-3 per m, known to a layer of 1 km; the Gaussian's top over a cell of 80 km.
  EXPECT_NEAR(most, 10, 2.5);
  EXPECT_LT(away_m(where, direction_to(30, -90)), map.cell_m);
  EXPECT_NEAR(map.finest_cell_m, 2 * glm::pi<double>() * kEarth_m / 4 / 128, 20e3);
  for (const CloudColumn& c : map.columns) {
    EXPECT_GE(c.base_m, 0);
    EXPECT_LE(c.top_m, 8500);
  }
  EXPECT_LT(map.extent().radius_rad, 0.25);
  // A cap around one patch leaves out the other.
  const CloudMap part = cloud_map(*source, 0, kEarth, Cap{direction_to(30, -83), 0.03});
  ASSERT_FALSE(part.empty());
  for (const CloudColumn& c : part.columns)
    EXPECT_LT(away_m(c.direction, direction_to(30, -83)), 0.03 * kEarth_m);
}

TEST(CloudMap, the_cloudiest_place_is_the_thick_patch_and_a_globe_has_no_extent) {
  const CloudMap map = cloud_map(*two_patches(), 0, kEarth);
  EXPECT_LT(away_m(cloudiest(map, 100e3 / kEarth_m), direction_to(30, -90)), 100e3);
  EXPECT_EQ(cloud_map(*cloudy_globe(), 0, kEarth).extent().radius_rad, glm::pi<double>());
}

TEST(CloudRaster, holds_columns_side_by_side_without_gaps_and_ends_with_the_data) {
  const glm::dvec3 middle = direction_to(30, -90);
  const CloudMap map = deck_with_eye(middle, 300e3, middle, 50e3);
  const CloudRaster raster(map, middle, 1500e3, {kEarth, {known_square(middle)}});
  const float deck = raster.at({150e3, 150e3});
  EXPECT_GT(deck, 0.45);  // 40 / 53, seven tenths of it: all tops are the same
  for (double x_m = -230e3; x_m <= 230e3; x_m += 7e3) {
    EXPECT_NEAR(raster.at({x_m, 150e3}), deck, 0.15 * deck) << x_m;  // two grids beat
    const glm::dvec2 p{x_m, -0.3 * x_m};
    EXPECT_NEAR(glm::length(raster.plane_m(raster.direction(p)) - p), 0, 1e-3);
    EXPECT_NEAR(away_m(raster.direction(p), middle), glm::length(p), 1);
  }
  EXPECT_EQ(raster.at({0, 0}), 0);
  EXPECT_EQ(raster.at({0, 400e3}), 0);                      // clear, and known
  EXPECT_EQ(raster.at({0, 1300e3}), CloudRaster::kBeyond);  // beyond the ground that is known
}

TEST(PlanetGround, heights_are_bilinear_on_the_maps_own_axes) {
  const auto map = plateau(47, 11, 0);
  for (int j = 0; j < 31; ++j)
    for (int i = 0; i < 31; ++i)
      map->height_m[std::size_t(31 * j + i)] = float(1000 + 20 * i + 3 * j);
  const PlanetGround ground{kEarth, {map}};
  const auto at = [&](double x_rad, double y_rad) {
    const glm::dvec3 u = map->axes * glm::dvec3(std::cos(y_rad) * std::cos(x_rad),
                                                std::cos(y_rad) * std::sin(x_rad), std::sin(y_rad));
    return glm::dvec3(u.x, u.y, u.z * kEarth.polar_m / kEarth.equatorial_m) * kEarth.equatorial_m;
  };
  for (const double x : {-0.1499, -0.033, 0.0, 0.07, 0.1499})
    for (const double y : {-0.14, 0.0123, 0.1499})
      EXPECT_NEAR(ground.height_m(at(x, y)), 1000 + 20 * (x + 0.15) / 0.01 + 3 * (y + 0.15) / 0.01,
                  1e-3);
  EXPECT_EQ(ground.height_m(at(0.16, 0)), 0);
  EXPECT_EQ(ground.height_m(at(0, -0.16)), 0);
  EXPECT_EQ(ground.height_m(at(3, 0)), 0);
  // All the way round: the last column leads to the first.
  SurfaceMap ring;
  ring.around = true;
  ring.nx = 4;
  ring.ny = 2;
  ring.low_rad = {0, -0.5};
  ring.step_rad = {glm::half_pi<double>(), 1};
  ring.height_m = {0, 10, 20, 30, 0, 10, 20, 30};
  double height_m = -1;
  const double x_rad = 1.75 * glm::pi<double>();
  ASSERT_TRUE(map_height_m(ring, kEarth, {std::cos(x_rad), std::sin(x_rad), 0}, height_m));
  EXPECT_NEAR(height_m, 15, 1e-6);
}

}  // namespace
}  // namespace nepho
