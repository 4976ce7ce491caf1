// Where the sun stands, against values that others published.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "accuracy_report.h"
#include "scene/utc.h"
#include "sun/sun_position.h"

namespace nepho {
namespace {

glm::dvec3 towards(const std::string& utc) {
  return sun_position(utc_ns_value(utc, "test")).to_sun;
}
double declination_deg(const std::string& utc) {
  return glm::degrees(std::asin(towards(utc).z));
}

struct Horizontal {
  double zenith_deg, azimuth_deg;
};
// The parallax puts the sun lower for who stands there.
Horizontal seen_from(const glm::dvec3& to_sun, double latitude_deg, double longitude_deg) {
  const double phi = glm::radians(latitude_deg), lambda = glm::radians(longitude_deg);
  const glm::dvec3 east = {-std::sin(lambda), std::cos(lambda), 0};
  const glm::dvec3 north = {-std::sin(phi) * std::cos(lambda), -std::sin(phi) * std::sin(lambda),
                            std::cos(phi)};
  const glm::dvec3 up = {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda),
                         std::sin(phi)};
  const double parallax_deg = 8.794 / 3600 * std::sqrt(1 - std::pow(glm::dot(to_sun, up), 2));
  const double azimuth_deg =
      glm::degrees(std::atan2(glm::dot(to_sun, east), glm::dot(to_sun, north)));
  return {glm::degrees(std::acos(glm::dot(to_sun, up))) + parallax_deg,
          azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg};
}

// Reda and Andreas, Solar Position Algorithm (NREL/TP-560-34302, 2008), appendix A.5:
// 2003-10-17 12:30:30 at UTC-7, 39.742476 N 105.1786 W: topocentric elevation without refraction
// 39.872046 degrees, azimuth 194.34024; distance 0.9965422974 au.
TEST(Sun, stands_where_the_published_example_has_it) {
  const SunPosition sun = sun_position(utc_ns_value("2003-10-17T12:30:30-07:00", "test"));
  const Horizontal found = seen_from(sun.to_sun, 39.742476, -105.1786);
  EXPECT_NEAR(found.zenith_deg, 90 - 39.872046, 0.001);
  EXPECT_NEAR(found.azimuth_deg, 194.34024, 0.001);
  EXPECT_NEAR(sun.distance_au, 0.9965422974, 1e-6);
  const double off_deg = std::max(std::abs(found.zenith_deg - (90 - 39.872046)),
                                  std::abs(found.azimuth_deg - 194.34024));
  test::report_accuracy("the sun", "place, example of NREL/TP-560-34302", off_deg, 0.01, "degrees");
}

// Meeus, Astronomical Algorithms, 2nd ed., example 25.b: 1992-10-13 at 0 h TD, apparent
// declination -7 deg 47' 01.74", distance 0.99760775 au. TD was UTC + 59.2 s.
TEST(Sun, agrees_with_meeus_example) {
  const SunPosition sun = sun_position(utc_ns_value("1992-10-12T23:59:00.8Z", "test"));
  EXPECT_NEAR(glm::degrees(std::asin(sun.to_sun.z)), -(7 + 47.0 / 60 + 1.74 / 3600), 0.0003);
  EXPECT_NEAR(sun.distance_au, 0.99760775, 1e-6);
}

// Instants as the US Naval Observatory and the IMCCE publish them, to the minute: there the
// declination passes 0 (by 1 minute of time 0.00027 degrees), or stands at its end.
TEST(Sun, equinoxes_and_solstices_come_when_they_should) {
  for (const char* utc : {"2000-03-20T07:35Z", "2005-03-20T12:33Z", "2020-03-20T03:50Z",
                          "2005-09-22T22:23Z", "2020-09-22T13:31Z"})
    EXPECT_NEAR(declination_deg(utc), 0, 0.0006) << utc;
  EXPECT_GT(declination_deg("2005-03-21T12:33Z"), 0.3);
  EXPECT_LT(declination_deg("2005-09-23T22:23Z"), -0.3);
  for (const auto& [utc, obliquity_deg] : {std::pair{"2000-06-21T01:48Z", 23.438},
                                           {"2020-06-20T21:44Z", 23.4367},
                                           {"2000-12-21T13:37Z", -23.438},
                                           {"2020-12-21T10:02Z", -23.4367}})
    EXPECT_NEAR(declination_deg(utc), obliquity_deg, 0.002) << utc;
}

// Meeus, chapter 27, table 27.c: the instant (Julian day, dynamical time) of a year's March
// equinox, right to 51 s from 1951 to 2050.
double march_equinox_day(int year) {
  const double y = (year - 2000) / 1000.0;
  const double start = 2451623.80984 + 365242.37404 * y + 0.05169 * y * y - 0.00411 * y * y * y -
                       0.00057 * y * y * y * y;
  const double t = (start - 2451545) / 36525;
  constexpr double terms[][3] = {
      {485, 324.96, 1934.136},  {203, 337.23, 32964.467}, {199, 342.08, 20.186},
      {182, 27.85, 445267.112}, {156, 73.14, 45036.886},  {136, 171.52, 22518.443},
      {77, 222.54, 65928.934},  {74, 296.72, 3034.906},   {70, 243.58, 9037.513},
      {58, 119.81, 33718.147},  {52, 297.17, 150.678},    {50, 21.02, 2281.226},
      {45, 247.54, 29929.562},  {44, 325.15, 31555.956},  {29, 60.93, 4443.417},
      {18, 155.12, 67555.328},  {17, 288.79, 4562.452},   {16, 198.04, 62894.029},
      {14, 199.76, 31436.921},  {12, 95.39, 14577.848},   {12, 287.11, 31931.756},
      {12, 320.81, 34777.259},  {9, 227.73, 1222.114},    {8, 15.45, 16859.074}};
  double sum = 0;
  for (const auto& [a, b, c] : terms) sum += a * std::cos(glm::radians(b + c * t));
  const double w = glm::radians(35999.373 * t - 2.47);
  return start + 1e-5 * sum / (1 + 0.0334 * std::cos(w) + 0.0007 * std::cos(2 * w));
}

TEST(Sun, crosses_the_equator_at_each_years_march_equinox_from_1950_to_2100) {
  double worst_deg = 0;
  for (int year = 1950; year <= 2100; year += 5) {
    const double dynamical_s = (march_equinox_day(year) - 2440587.5) * 86400;
    // Dynamical time over UTC: 29 s in 1950, 69 s in 2025, perhaps 200 s in 2100; to 60 s.
    const double delta_s = 29 + 0.0091 * (year - 1950) * (year - 1950) / 1.2;
    const auto utc_ns = std::int64_t((dynamical_s - delta_s) * 1e9);
    worst_deg =
        std::max(worst_deg, std::abs(glm::degrees(std::asin(sun_position(utc_ns).to_sun.z))));
  }
  // A minute of time is 0.00027 degrees.
  EXPECT_LT(worst_deg, 0.001);
  test::report_accuracy("the sun", "declination at March equinoxes, 1950 to 2100 (Meeus 27)",
                        worst_deg, 0.01, "degrees");
}

// The equation of time (Meeus, example 28.b: +13 min 42.6 s on 1992-10-13, 0 h TD) is how far east
// of the clock's meridian the sun stands: at 0 h UT over 180 degrees minus a quarter degree a
// minute.
TEST(Sun, stands_over_the_longitude_that_the_clock_says) {
  const glm::dvec3 v = towards("1992-10-12T23:59:00.8Z");
  const double clock_deg = (23 + 59.0 / 60 + 0.8 / 3600) * 15;
  double expected_deg = 180 - clock_deg - 13.71 / 4;
  if (expected_deg < -180) expected_deg += 360;
  EXPECT_NEAR(glm::degrees(std::atan2(v.y, v.x)), expected_deg, 0.002);
  // It moves to the west.
  const glm::dvec3 noon = towards("2005-08-28T12:00Z"), later = towards("2005-08-28T13:00Z");
  EXPECT_NEAR(glm::degrees(std::atan2(later.y, later.x) - std::atan2(noon.y, noon.x)), -15, 0.01);
}

TEST(Sun, is_a_direction_and_a_year_brings_it_nearer_and_farther) {
  for (int year = 1950; year <= 2100; year += 10) {
    const SunPosition january = sun_position(utc_ns_value(std::to_string(year) + "-01-04", "test"));
    const SunPosition july = sun_position(utc_ns_value(std::to_string(year) + "-07-05", "test"));
    EXPECT_NEAR(glm::length(january.to_sun), 1, 1e-15);
    EXPECT_NEAR(january.distance_au, 0.9833, 2e-4);
    EXPECT_NEAR(july.distance_au, 1.0167, 2e-4);
  }
}

TEST(Utc, dates_are_read_and_written) {
  const std::pair<const char*, std::int64_t> good[] = {
      {"1970-01-01", 0},
      {"1970-01-01T00:00:01Z", 1000000000},
      {"2005-08-28T15:00:00Z", 1125241200000000000},
      {"2005-08-28 15:00", 1125241200000000000},
      {"2005-08-28_15:00:00", 1125241200000000000},
      {"2005-08-28T15Z", 1125241200000000000},
      {"2005-08-28T17:30:00+02:30", 1125241200000000000},
      {"2005-08-28T10:00-05:00", 1125241200000000000},
      {"1969-12-31T23:59:59.25Z", -750000000},
      {"2004-02-29", 1078012800000000000}};
  for (const auto& [text, ns] : good) EXPECT_EQ(utc_ns_value(text, "t"), ns) << text;
  EXPECT_EQ(utc_text(1125241200000000000), "2005-08-28T15:00:00Z");
  EXPECT_EQ(utc_text(-750000000), "1969-12-31T23:59:59.25Z");
  for (const std::int64_t ns : {1125241200123456789ll, -1ll, -9000000000000000000ll, 0ll})
    EXPECT_EQ(utc_ns_value(utc_text(ns), "t"), ns);
  for (const char* text : {"", "2005", "2005-02-30", "2003-02-29", "28.8.2005", "2005-08-28T25:00",
                           "2005-08-28T24:01", "2005-08-28T15:00:00Y", "2005-08-28T15:61",
                           "1600-01-01", "2005-08-28T15:00:00Z ", "2005-8-28"})
    EXPECT_ANY_THROW(utc_ns_value(text, "t")) << text;
}

}  // namespace
}  // namespace nepho
