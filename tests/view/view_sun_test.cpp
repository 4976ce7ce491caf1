// The sun of a window: by a date, or free.
#include "view/view_sun.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "common/planet_ground.h"
#include "common/planet_view.h"
#include "core/error.h"
#include "scene/utc.h"
#include "sun/sun_position.h"

namespace nepho::test {
namespace {

constexpr double kIrradiance = 1.5;  // W m-2 nm-1, at the date of the scene

OpenedScene over_the_planet(const char* date) {
  OpenedScene opened;
  opened.scene.planet.emplace();
  const std::int64_t utc_ns = utc_ns_value(date, "test");
  const SunPosition position = sun_position(utc_ns);
  opened.sun_utc_ns = utc_ns;
  opened.sun_distance_au = position.distance_au;
  opened.request.sun = {position.to_sun, glm::dvec3(kIrradiance)};
  return opened;
}

LocalAxes greenwich() {
  return PlanetGround().axes({4e6, 0, 5e6});
}

Panel filled(const ViewSun& sun) {
  Panel panel;
  sun.fill(panel, greenwich());
  return panel;
}

Panel typed(const ViewSun& sun, const char* date) {
  Panel panel = filled(sun);
  std::snprintf(panel.sun_utc.data(), panel.sun_utc.size(), "%s", date);
  panel.sun_utc_typed = true;
  return panel;
}

TEST(ViewSun, StandsAsAtADate) {
  ViewSun sun(over_the_planet("2024-01-03T12:00:00Z"));
  Panel panel = filled(sun);
  EXPECT_TRUE(panel.planet);
  EXPECT_TRUE(panel.sun_dated);
  EXPECT_EQ(std::string(panel.sun_utc.data()), "2024-01-03T12:00:00Z");
  EXPECT_NEAR(panel.sun_hour, 12, 1e-9);
  const glm::dvec3 before = sun.sun().to_sun;
  sun.apply(panel, filled(sun), greenwich());  // nothing was done
  EXPECT_EQ(sun.sun().to_sun, before);

  // Half a year on the Earth is 1.7 % farther from it, and the light 6.7 % weaker.
  sun.apply(typed(sun, "2024-07-05T12:00:00Z"), filled(sun), greenwich());
  const SunPosition summer = sun_position(utc_ns_value("2024-07-05T12:00:00Z", "test"));
  const SunPosition winter = sun_position(utc_ns_value("2024-01-03T12:00:00Z", "test"));
  EXPECT_EQ(sun.sun().to_sun, summer.to_sun);
  const double ratio = winter.distance_au / summer.distance_au;
  EXPECT_LT(ratio, 0.97);
  EXPECT_NEAR(sun.sun().irradiance_W_per_m2_nm.g, kIrradiance * ratio * ratio, 1e-9);

  panel = filled(sun);
  panel.sun_hour = 18.5;
  sun.apply(panel, filled(sun), greenwich());
  EXPECT_EQ(std::string(filled(sun).sun_utc.data()), "2024-07-05T18:30:00Z");
}

TEST(ViewSun, OfABadDateNothingIsTaken) {
  ViewSun sun(over_the_planet("2024-01-03T12:00:00Z"));
  const glm::dvec3 before = sun.sun().to_sun;
  for (const char* date : {"noon", "2024-13-01", "", "2024-01-03T25:00Z"})
    EXPECT_THROW(sun.apply(typed(sun, date), filled(sun), greenwich()), Error) << date;
  EXPECT_EQ(sun.sun().to_sun, before);
}

TEST(ViewSun, IsFreeWhereItIsAsked) {
  ViewSun sun(over_the_planet("2024-01-03T12:00:00Z"));
  const glm::dvec3 before = sun.sun().to_sun;
  Panel panel = filled(sun);
  panel.sun_dated = false;
  sun.apply(panel, filled(sun), greenwich());
  EXPECT_LT(glm::length(sun.sun().to_sun - before), 1e-9);  // where it stands
  panel = filled(sun);
  EXPECT_FALSE(panel.sun_dated);
  panel.sun_azimuth_deg = 250;
  panel.sun_elevation_deg = 5;
  sun.apply(panel, filled(sun), greenwich());
  const glm::dvec2 angles = sun_angles_deg(greenwich(), sun.sun().to_sun);
  EXPECT_NEAR(angles.x, 250, 1e-9);
  EXPECT_NEAR(angles.y, 5, 1e-9);
  // The data's date moves a sun that stands by a date, and no other.
  const glm::dvec3 free = sun.sun().to_sun;
  sun.follow(utc_ns_value("2024-03-01T06:00:00Z", "test"));
  EXPECT_EQ(sun.sun().to_sun, free);
  panel = filled(sun);
  panel.sun_dated = true;
  sun.apply(panel, filled(sun), greenwich());
  EXPECT_EQ(sun.sun().to_sun, sun_position(utc_ns_value("2024-03-01T06:00:00Z", "test")).to_sun);
  sun.follow(utc_ns_value("2024-03-01T09:00:00Z", "test"));
  EXPECT_EQ(sun.sun().to_sun, sun_position(utc_ns_value("2024-03-01T09:00:00Z", "test")).to_sun);
}

TEST(ViewSun, KeepsALightThatTheSceneStates) {
  OpenedScene opened = over_the_planet("2024-01-03T12:00:00Z");
  opened.sun_distance_au = 0;
  ViewSun sun(opened);
  sun.apply(typed(sun, "2024-07-05T12:00:00Z"), filled(sun), greenwich());
  EXPECT_EQ(sun.sun().irradiance_W_per_m2_nm.g, kIrradiance);
}

}  // namespace
}  // namespace nepho::test
