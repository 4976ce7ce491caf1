// Views of a planet's weather: where they stand, what they show, when it is and where the sun is.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/cloud_raster.h"
#include "common/data_error.h"
#include "common/planet_scene.h"
#include "common/planet_view.h"
#include "core/error.h"
#include "geo/place.h"
#include "scene/utc.h"
#include "weather_source.h"

namespace nepho {
namespace {

using test::WeatherSource;

constexpr double kEarth_m = 6378137;
const Ellipsoid kEarth = Ellipsoid::wgs84();

// A thick patch in the west, a thin one in the east, 600 km apart.
const std::vector<test::Blob> kTwoPatches = {{30, -90, 200e3, 4000, 2500, 2e-3},
                                             {30, -83, 200e3, 4000, 2500, 2e-5}};

std::unique_ptr<WeatherSource> two_patches() {
  static const auto field = test::blobs(kTwoPatches, 4);
  return std::make_unique<WeatherSource>(field);
}

// A cover of the whole globe, thick over the Indian ocean.
std::unique_ptr<WeatherSource> cloudy_globe() {
  static const auto field =
      test::blobs({{0, 0, 2e7, 4000, 3000, 2e-4}, {-10, 75, 1.5e6, 4000, 3000, 5e-3}}, 3);
  return std::make_unique<WeatherSource>(field);
}

// Where a point appears, -1 to 1 from left to right and from below to above; and whether ahead.
struct Seen {
  double x, y;
  bool ahead;
};
Seen seen(const Camera& c, double aspect, const glm::dvec3& direction) {
  const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, c.up));
  const glm::dvec3 upward = glm::cross(right, forward);
  const double tan_y = std::tan(c.vertical_fov_rad / 2), ahead = glm::dot(direction, forward);
  return {glm::dot(direction, right) / (ahead * tan_y * aspect),
          glm::dot(direction, upward) / (ahead * tan_y), ahead > 0};
}

// The line between sphere and space, straight ahead.
double horizon_in_picture(const Camera& c, double aspect) {
  const glm::dvec3 up = glm::normalize(c.eye_m);
  const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
  const glm::dvec3 level = glm::normalize(forward - glm::dot(forward, up) * up);
  const double height_m = geodetic_height_m(kEarth, c.eye_m);
  const double dip = std::acos(kEarth_m / (kEarth_m + height_m));
  return seen(c, aspect, std::cos(dip) * level - std::sin(dip) * up).y;
}

glm::dvec3 direction_to(double latitude_deg, double longitude_deg) {
  return glm::normalize(ecef_m(kEarth, {latitude_deg, longitude_deg, 0}));
}
double away_m(const glm::dvec3& a, const glm::dvec3& b) {
  return kEarth_m *
         std::acos(glm::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0));
}

double heading_rad(const LocalAxes& axes, const glm::dvec3& direction) {
  return std::atan2(glm::dot(direction, axes.east), glm::dot(direction, axes.north));
}

// A map around a direction, on axes of its own, all of one height.
std::shared_ptr<SurfaceMap> square_about(const glm::dvec3& centre, double half_rad,
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
std::shared_ptr<SurfaceMap> known_square(const glm::dvec3& middle) {
  return square_about(middle, 900e3 / kEarth_m, 0);
}

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

// A deck of cells of 10 km with a clear eye in it, as a source might give it; the rest of a domain
// of `wide_m` to either side is clear.
CloudMap deck_with_eye(const glm::dvec3& middle, double deck_m, const glm::dvec3& eye,
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

constexpr double kWide_m = 900e3;
const std::pair<double, double> kPlaces[] = {{30, -90}, {0, 179.9}, {89.9, 40}, {-60, -179.5}};

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

std::shared_ptr<SurfaceMap> plateau(double latitude_deg, double longitude_deg, float height_m) {
  return square_about(direction_to(latitude_deg, longitude_deg), 0.15, height_m);
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

// A scene with one weather source, worked out as the program does.
OpenedScene opened(std::unique_ptr<WeatherSource> source) {
  OpenedScene result;
  result.scene.volumes.resize(1);
  result.sources.push_back(std::move(source));
  result.request.volumes.push_back({result.sources[0].get(), 0.0, {}});
  return result;
}
std::string said(const OpenedScene& scene) {
  std::string all;
  for (const std::string& text : scene.assumptions) all += text + "\n";
  return all;
}
void expect_said(const OpenedScene& scene, const std::string& part) {
  EXPECT_NE(said(scene).find(part), std::string::npos) << said(scene) << "  lacks: " << part;
}

// Over 90 W noon is at 18:00 UTC.
std::unique_ptr<WeatherSource> forecast(std::vector<double> hours,
                                        std::vector<double> empty_hours) {
  auto source = two_patches();
  source->edit().name = "storm";
  source->edit().time_origin_ns = utc_ns_value("2005-08-28T00:00Z", "test");
  source->edit().times_s.clear();
  for (const double hour : hours) source->edit().times_s.push_back(3600 * hour);
  for (const double hour : empty_hours) source->empty_times_s.push_back(3600 * hour);
  return source;
}

TEST(PlanetScene, takes_the_first_time_with_cloud_by_day) {
  OpenedScene scene = opened(forecast({0, 6, 9, 12, 15, 18, 21}, {0, 15}));
  resolve_planet(scene);
  ASSERT_TRUE(scene.scene.planet);
  EXPECT_EQ(scene.scene.planet->body.polar_m, kEarth.polar_m);
  const PlanetShot shot = frame_on_planet(scene, *body_of(scene));
  // 12:00 is 6 in the morning there, the sun below 15 degrees; 15:00 has no cloud.
  EXPECT_EQ(scene.scene.volumes[0].time_s, 18 * 3600.0);
  EXPECT_EQ(scene.request.volumes[0].time_s, 18 * 3600.0);
  expect_said(scene, "storm: the first time with cloud, by day, --time 2005-08-28T18:00:00Z");
  expect_said(scene, "sun: where it stood at 2005-08-28T18:00:00Z");
  expect_said(scene, "view: oblique, where the clouds have most structure, --look-from geo:");
  expect_said(scene, "--no-planet");
  const glm::dvec3 up = glm::normalize(shot.camera.target_m);
  EXPECT_GT(glm::dot(*scene.scene.sun.to_sun, up), std::sin(glm::radians(65.0)));  // August, noon
  EXPECT_NEAR(shot.sun_distance_au, 1.01, 0.002);
  EXPECT_LT(away_m(shot.camera.target_m, direction_to(30, -90)), 250e3);  // within its edge
}

TEST(PlanetScene, a_night_forecast_gets_a_sun_and_says_so) {
  OpenedScene scene = opened(forecast({0, 3, 6}, {0, 3}));
  resolve_planet(scene);
  const PlanetShot shot = frame_on_planet(scene, *body_of(scene));
  EXPECT_EQ(scene.scene.volumes[0].time_s, 6 * 3600.0);
  expect_said(scene, "night there at the valid time");
  expect_said(scene, "--sun 2005-08-28T06:00:00Z for the real one");
  expect_said(scene, "sun: 35 degrees high to the side");
  const LocalAxes axes = PlanetGround{kEarth, {}}.axes(shot.camera.target_m);
  EXPECT_NEAR(sun_angles_deg(axes, *scene.scene.sun.to_sun).y, 35, 0.5);
  EXPECT_EQ(shot.sun_distance_au, 1);
}

TEST(PlanetScene, what_is_asked_for_is_kept) {
  OpenedScene scene = opened(forecast({0, 18, 21}, {}));
  scene.scene.volumes[0].utc_ns = utc_ns_value("2005-08-28T21:00Z", "test");
  scene.scene.camera.stand = Stand{30, -90, 2, 45, 3};
  scene.scene.sun.utc_ns = utc_ns_value("2005-08-28T03:00Z", "test");
  resolve_planet(scene);
  const PlanetShot shot = frame_on_planet(scene, *body_of(scene));
  EXPECT_EQ(scene.scene.volumes[0].time_s, 21 * 3600.0);
  EXPECT_FALSE(scene.scene.volumes[0].utc_ns);
  EXPECT_NEAR(geodetic_height_m(kEarth, shot.camera.eye_m), 2, 1e-3);
  EXPECT_EQ(said(scene).find("sun:"), std::string::npos) << said(scene);
  const LocalAxes axes = PlanetGround{kEarth, {}}.axes(shot.camera.eye_m);
  EXPECT_LT(sun_angles_deg(axes, *scene.scene.sun.to_sun).y, 0);  // evening there

  // Angles are over the horizon of where the camera looks.
  OpenedScene angles = opened(forecast({0}, {}));
  angles.scene.camera.stand = Stand{30, -90, 2, 45, 3};
  angles.scene.sun.azimuth_elevation_deg = {120, 20};
  resolve_planet(angles);
  frame_on_planet(angles, *body_of(angles));
  const glm::dvec2 deg = sun_angles_deg(axes, *angles.scene.sun.to_sun);
  EXPECT_NEAR(deg.x, 120, 1e-9);
  EXPECT_NEAR(deg.y, 20, 1e-9);
}

TEST(PlanetScene, times_that_are_not_there_are_listed) {
  OpenedScene scene = opened(forecast({0, 18}, {}));
  scene.scene.volumes[0].utc_ns = utc_ns_value("2005-08-28T17:59Z", "test");
  resolve_planet(scene);
  try {
    frame_on_planet(scene, kEarth);
    ADD_FAILURE();
  } catch (const Error& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("2005-08-28T00:00:00Z, 2005-08-28T18:00:00Z"), std::string::npos) << text;
  }
}

TEST(PlanetScene, no_planet_and_a_sky_leave_it_out_and_another_body_is_refused) {
  OpenedScene none = opened(forecast({0}, {}));
  none.scene.no_planet = true;
  resolve_planet(none);
  EXPECT_FALSE(none.scene.planet);
  EXPECT_TRUE(body_of(none));  // places are still on the Earth
  OpenedScene sky = opened(forecast({0}, {}));
  sky.scene.sky = Sky{};
  resolve_planet(sky);
  EXPECT_FALSE(sky.scene.planet);
  OpenedScene other = opened(forecast({0}, {}));
  other.scene.planet = Planet{Ellipsoid::sphere(3.4e6), {}, {}};
  EXPECT_THROW(resolve_planet(other), Error);
  auto free_cloud = forecast({0}, {});
  free_cloud->edit().on_planet = false;
  OpenedScene free_scene = opened(std::move(free_cloud));
  resolve_planet(free_scene);
  EXPECT_FALSE(free_scene.scene.planet);
  EXPECT_FALSE(body_of(free_scene));
}

TEST(PlanetScene, an_eye_below_the_ground_is_refused) {
  auto source = forecast({0}, {});
  source->edit().surface = plateau(30, -90, 800);
  OpenedScene scene = opened(std::move(source));
  scene.scene.camera.eye_m = ecef_m(kEarth, {30, -90, 500});
  scene.scene.camera.target_m = ecef_m(kEarth, {30.1, -90, 500});
  resolve_planet(scene);
  EXPECT_THROW(frame_on_planet(scene, kEarth), Error);
  scene.scene.camera.eye_m = ecef_m(kEarth, {30, -90, 801});
  EXPECT_NO_THROW(frame_on_planet(scene, kEarth));
}

TEST(PlanetScene, a_globe_is_seen_from_its_day_side_without_a_search_for_day) {
  auto source = cloudy_globe();
  source->edit().time_origin_ns = utc_ns_value("2011-01-10T00:00Z", "test");
  OpenedScene scene = opened(std::move(source));
  resolve_planet(scene);
  const PlanetShot shot = frame_on_planet(scene, *body_of(scene));
  expect_said(scene, "view: the globe");
  expect_said(scene, "sun: where it stood at 2011-01-10T00:00:00Z");
  EXPECT_GT(glm::dot(*scene.scene.sun.to_sun, glm::normalize(shot.camera.eye_m)), 0.2);
}

TEST(DataError, is_that_of_the_sources_own_field) {
  const auto source = two_patches();
  EXPECT_LT(data_error(*source, 0).rms_per_m / data_error(*source, 0).field_rms_per_m, 1e-3);
  source->point_factor = 1.25;
  const DataError error = data_error(*source, 0);
  EXPECT_NEAR(error.rms_per_m / error.field_rms_per_m, 0.2, 1e-3);
  EXPECT_GT(error.points, 1000);
  source->point_factor = 0;
  EXPECT_THROW(data_error(*source, 0), Error);
}

}  // namespace
}  // namespace nepho
