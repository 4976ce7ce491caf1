// Views of a planet's weather: where they stand and what they show.
#include <gtest/gtest.h>

#include "common/planet_scene.h"
#include "planet_cases.h"

namespace nepho {
namespace {

using namespace test;

TEST(PlanetView, oblique_finds_the_eye_of_a_deck_at_poles_and_date_line_too) {
  for (const auto& [latitude_deg, longitude_deg] : kPlaces) {
    const glm::dvec3 middle = direction_to(latitude_deg, longitude_deg);
    const LocalAxes axes = PlanetGround{kEarth, {}}.axes(middle * kEarth_m);
    const glm::dvec3 eye =
        glm::normalize(middle + (250e3 * axes.east - 180e3 * axes.north) / kEarth_m);
    const CloudMap map = deck_with_eye(middle, kWide_m, eye, 60e3);
    constexpr double kPart_m = 150e3;
    EXPECT_LT(
        away_m(most_varied(map, 0.5 * kPart_m / kEarth_m, {kEarth, {known_square(middle)}}), eye),
        kPart_m)
        << latitude_deg;
    const Camera c =
        oblique_view(map, kPart_m, std::nullopt, {kEarth, {known_square(middle)}}, {}, std::nullopt)
            .camera;
    EXPECT_LT(away_m(c.target_m, eye), kPart_m) << latitude_deg;
    // All of the eye is in the picture.
    for (double turn = 0; turn < 6.2; turn += 0.5) {
      const glm::dvec3 rim = glm::normalize(
          eye + 60e3 / kEarth_m * (std::cos(turn) * axes.east + std::sin(turn) * axes.north));
      const Seen there = seen(c, 16.0 / 9, rim * (kEarth_m + 7000) - c.eye_m);
      EXPECT_TRUE(there.ahead);
      EXPECT_LT(std::abs(there.x), 1) << latitude_deg;
      EXPECT_LT(std::abs(there.y), 1) << latitude_deg;
    }
    EXPECT_GT(horizon_in_picture(c, 16.0 / 9), 0.5);
    EXPECT_LT(horizon_in_picture(c, 16.0 / 9), 1);
  }
}

TEST(PlanetView, how_much_is_shown_goes_by_cells_tops_and_what_there_is) {
  const glm::dvec3 middle = direction_to(30, -90);
  // 107 cells of 10 km across, where there are as many.
  CloudMap map = deck_with_eye(middle, kWide_m, -middle, 0);
  EXPECT_NEAR(oblique_part_m(map, kEarth), 535e3, 1);
  // Cells of 50 m: three times the height of the tops to either side.
  map.finest_cell_m = 50;
  EXPECT_NEAR(oblique_part_m(map, kEarth), 21e3, 1);
  // A deck of 200 km: 2.4 of its rms radius, 200 km * sqrt(2/3) / 2... of a square of half side
  // 100.
  map = deck_with_eye(middle, 100e3, -middle, 0);
  EXPECT_NEAR(oblique_part_m(map, kEarth), 2.4 * 105e3 * std::sqrt(2.0 / 3), 5e3);
  // One column: eight of its cells.
  map = deck_with_eye(middle, 0, -middle, 0);
  ASSERT_EQ(map.columns.size(), 1u);
  EXPECT_NEAR(oblique_part_m(map, kEarth), 80e3, 1);
  // A cover of the whole globe is no part.
  EXPECT_LE(oblique_part_m(cloud_map(*cloudy_globe(), 0, kEarth), kEarth), 0.31 * kEarth_m);
}

TEST(PlanetView, oblique_looks_from_above_with_the_horizon_in_the_upper_fifth) {
  const glm::dvec3 place = direction_to(30, -90);
  const PlanetGround sea{kEarth, {}};
  for (const double cell_factor : {1.0, 0.02}) {
    CloudMap map = deck_with_eye(place, 200e3, place, 40e3);
    map.finest_cell_m *= cell_factor;
    const double part_m = oblique_part_m(map, kEarth);
    for (const double aspect : {16.0 / 9, 1.0, 0.6})
      for (const double fov_rad : {0.4, 0.75, 1.2}) {
        const Lens lens{fov_rad, aspect};
        const Camera c = oblique_view(map, part_m, place, sea, lens, std::nullopt).camera;
        const Seen middle = seen(c, aspect, ecef_m(kEarth, {30, -90, 4000}) - c.eye_m);
        EXPECT_NEAR(middle.x, 0, 0.01);
        EXPECT_NEAR(middle.y, 0, 0.02);
        // Flat weather from higher than towers.
        EXPECT_NEAR(horizon_in_picture(c, aspect), cell_factor == 1 ? 0.8 : 0.6, 0.03)
            << aspect << " " << fov_rad;
        EXPECT_GT(geodetic_height_m(kEarth, c.eye_m), 1.3 * 7000 - 1);
        EXPECT_GT(glm::dot(c.up, glm::normalize(c.eye_m)), 0.999);
        // The part spans the picture, unless the eye had to stand higher.
        const glm::dvec3 right = glm::normalize(glm::cross(c.target_m - c.eye_m, c.up));
        const glm::dvec3 side =
            glm::normalize(place + part_m / kEarth_m * right) * glm::length(c.target_m);
        EXPECT_NEAR(seen(c, aspect, side - c.eye_m).x, 1, 0.08);
      }
  }
}

TEST(PlanetView, oblique_has_the_sun_to_the_side) {
  const glm::dvec3 place = direction_to(30, -90);
  const CloudMap map = deck_with_eye(place, 200e3, place, 40e3);
  const PlanetGround sea{kEarth, {}};
  for (double azimuth = 0; azimuth < 6.2; azimuth += 0.7) {
    const LocalAxes axes = sea.axes(ecef_m(kEarth, {30, -90, 0}));
    const glm::dvec3 to_sun =
        0.8 * (std::sin(azimuth) * axes.east + std::cos(azimuth) * axes.north) + 0.6 * axes.up;
    const Camera c = oblique_view(map, 150e3, std::nullopt, sea, {}, to_sun).camera;
    const LocalAxes there = sea.axes(c.target_m);
    const double aside_deg = glm::degrees(std::abs(
        std::remainder(heading_rad(there, to_sun) - heading_rad(there, c.target_m - c.eye_m),
                       2 * glm::pi<double>())));
    EXPECT_GT(aside_deg, 39) << azimuth;
    EXPECT_LT(aside_deg, 121) << azimuth;
  }
}

TEST(PlanetView, a_lone_column_and_one_deck_are_in_the_middle) {
  const glm::dvec3 place = direction_to(47, 11);
  for (const double deck_m : {0.0, 60e3}) {
    const CloudMap map = deck_with_eye(place, deck_m, -place, 0);
    const double part_m = oblique_part_m(map, kEarth);
    const Camera c =
        oblique_view(map, part_m, std::nullopt, {kEarth, {known_square(place)}}, {}, std::nullopt)
            .camera;
    EXPECT_LT(away_m(c.target_m, place), 0.7 * part_m) << deck_m;
  }
}

TEST(PlanetView, oblique_stays_clear_of_the_terrain) {
  const CloudMap map = cloud_map(*two_patches(), 0, kEarth);
  const glm::dvec3 place = direction_to(30, -90);
  const Camera low = oblique_view(map, 100e3, place, {kEarth, {}}, {}, std::nullopt).camera;
  const float wall_m = float(geodetic_height_m(kEarth, low.eye_m) + 5000);
  const auto map_there = plateau(30, -90, wall_m);
  // A valley where the clouds are, high ground all around.
  for (int j = 14; j <= 16; ++j)
    for (int i = 14; i <= 16; ++i) map_there->height_m[std::size_t(31 * j + i)] = 0;
  const PlanetGround ground{kEarth, {map_there}};
  const Camera high = oblique_view(map, 100e3, place, ground, {}, std::nullopt).camera;
  EXPECT_GT(geodetic_height_m(kEarth, high.eye_m), ground.height_m(high.eye_m) + 299);
}

TEST(PlanetView, globe_is_whole_sunlit_and_has_north_above) {
  const CloudMap map = cloud_map(*cloudy_globe(), 0, kEarth);
  for (const double sun_longitude : {-120.0, 0.0, 60.0, 170.0}) {
    const glm::dvec3 to_sun = direction_to(15, sun_longitude);
    for (const double aspect : {16.0 / 9, 0.7}) {
      const Camera c = globe_view(map, {kEarth, {}}, {0.6, aspect}, to_sun).camera;
      const double distance_m = glm::length(c.eye_m);
      const double half_rad = std::min(0.3, std::atan(std::tan(0.3) * aspect));
      EXPECT_NEAR(std::asin(kEarth_m / distance_m) / half_rad, 0.88, 1e-9);
      const double phase_deg = glm::degrees(std::acos(glm::dot(glm::normalize(c.eye_m), to_sun)));
      EXPECT_GT(phase_deg, 5);
      EXPECT_LT(phase_deg, 75);
      EXPECT_GT(seen(c, aspect, ecef_m(kEarth, {90, 0, 0}) - c.eye_m).y, 0);
    }
  }
  // Without a sun the thick clouds decide.
  const Camera c = globe_view(map, {kEarth, {}}, {}, std::nullopt).camera;
  EXPECT_LT(away_m(c.eye_m, direction_to(-10, 75)), 3e6);
}

TEST(PlanetView, standing_eye_is_over_the_ground_and_looks_at_the_cloud) {
  const PlanetGround ground{kEarth, {plateau(30, -90, 321)}};
  Stand stand;
  stand.latitude_deg = 30;
  stand.longitude_deg = -90;
  // One cloud column 20 km to the south-east.
  const LocalAxes axes = ground.axes(ecef_m(kEarth, {30, -90, 0}));
  const glm::dvec3 there = (axes.east - axes.north) / std::sqrt(2.0);
  CloudMap near;
  near.columns = {
      {glm::normalize(direction_to(30, -90) + 20e3 / kEarth_m * there), 1e8, 20, 2000, 3000}};
  const Camera c = standing_view(stand, near, ground, {0.95, 1.5}, std::nullopt).camera;
  EXPECT_NEAR(geodetic_height_m(kEarth, c.eye_m), 323, 1e-3);
  const glm::dvec3 ahead = glm::normalize(c.target_m - c.eye_m);
  EXPECT_GT(glm::dot(ahead, there), 0.9);
  EXPECT_NEAR(horizon_in_picture(c, 1.5), -0.6, 0.03);  // seen from 323 m, a little lower

  // High cloud overhead lifts the view; what is asked for is what is looked at.
  near.columns[0] = {glm::normalize(direction_to(30, -90) + 4e3 / kEarth_m * there), 1e7, 20, 2500,
                     3500};
  const Camera up = standing_view(stand, near, ground, {0.95, 1.5}, std::nullopt).camera;
  EXPECT_GT(glm::dot(glm::normalize(up.target_m - up.eye_m), axes.up),
            glm::dot(ahead, axes.up) + 0.1);
  stand.azimuth_deg = 70;
  stand.elevation_deg = -5;
  stand.eye_height_m = 10;
  const Camera asked = standing_view(stand, near, ground, {}, std::nullopt).camera;
  const glm::dvec3 d = glm::normalize(asked.target_m - asked.eye_m);
  EXPECT_NEAR(glm::degrees(std::asin(glm::dot(d, axes.up))), -5, 1e-6);
  EXPECT_NEAR(glm::degrees(std::atan2(glm::dot(d, axes.east), glm::dot(d, axes.north))), 70, 1e-6);
  EXPECT_NEAR(geodetic_height_m(kEarth, asked.eye_m), 331, 1e-3);
}

TEST(PlanetView, a_place_to_stand_has_the_cloud_ahead_and_not_above) {
  const glm::dvec3 place = direction_to(30, -83);
  const CloudMap map = deck_with_eye(place, 40e3, -place, 0);
  const PlanetGround ground{kEarth, {}};
  for (const double sun_rad : {-1.0, 0.5, 2.5}) {  // whatever its side
    const LocalAxes about = ground.axes(ecef_m(kEarth, {30, -83, 0}));
    const glm::dvec3 to_sun =
        0.8 * (std::sin(sun_rad) * about.east + std::cos(sun_rad) * about.north) + 0.6 * about.up;
    const Stand stand = place_to_stand(map, place, ground, {0.95, 16.0 / 9}, to_sun);
    const glm::dvec3 here = ecef_m(kEarth, {stand.latitude_deg, stand.longitude_deg, 0});
    double nearest_m = 1e9;
    for (const CloudColumn& c : map.columns)
      nearest_m = std::min(nearest_m, away_m(c.direction, here));
    EXPECT_GT(nearest_m, 8e3) << sun_rad;  // beyond half a cell and some way off
    EXPECT_LT(nearest_m, 60e3) << sun_rad;
    // Towards some of it, the sun to the side.
    const LocalAxes axes = ground.axes(here);
    const double heading = glm::radians(*stand.azimuth_deg);
    double off_rad = 9;
    for (const CloudColumn& c : map.columns)
      off_rad = std::min(off_rad, std::abs(std::remainder(
                                      heading_rad(axes, c.direction * kEarth_m - here) - heading,
                                      2 * glm::pi<double>())));
    EXPECT_LT(off_rad, 0.4) << sun_rad;
    const double aside_deg = glm::degrees(
        std::abs(std::remainder(heading_rad(axes, to_sun) - heading, 2 * glm::pi<double>())));
    EXPECT_GT(aside_deg, 39) << sun_rad;
    EXPECT_LT(aside_deg, 121) << sun_rad;
  }
}

TEST(PlanetView, sun_to_the_side_is_where_it_says) {
  const PlanetGround ground{kEarth, {}};
  const LocalAxes axes = ground.axes(ecef_m(kEarth, {-35, 150, 0}));
  Camera camera;
  camera.eye_m = ecef_m(kEarth, {-35, 150, 1000});
  camera.target_m = camera.eye_m + 100.0 * axes.north;
  const glm::dvec2 deg = sun_angles_deg(axes, sun_to_the_side(camera, axes));
  EXPECT_NEAR(deg.x, 260, 1e-9);
  EXPECT_NEAR(deg.y, 35, 1e-9);
}

}  // namespace
}  // namespace nepho
