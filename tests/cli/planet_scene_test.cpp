// A planet's scenes: when it is, where the sun is, what is assumed and what refused.
#include <gtest/gtest.h>

#include "common/data_error.h"
#include "common/planet_scene.h"
#include "core/error.h"
#include "planet_cases.h"
#include "scene/utc.h"

namespace nepho {
namespace {

using namespace test;

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
