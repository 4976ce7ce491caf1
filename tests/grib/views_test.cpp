// One cell with cloud on rotated poles that turn, and in views of satellites.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "planted_cell.h"

namespace nepho::grib::test {
namespace {

// WMO template 3.1: an angle of rotation counts meridians of the rotated system from further east.
TEST(GribViews, RotatedPolesTurn) {
  const auto place = [](double turn_deg, double first_lon) {
    Case c{
        "turned" + std::to_string(int(turn_deg)), 2, kNx * kNy,
        with(lat_lon("rotated_ll", 0.5, 3, first_lon), {{"latitudeOfSouthernPoleInDegrees", -39.25},
                                                        {"longitudeOfSouthernPoleInDegrees", 18.0},
                                                        {"angleOfRotationInDegrees", turn_deg}}),
        0.5};
    return column_place(*open({plant(c, 17, {{"iScansNegatively", 0}}).path}));
  };
  double worst = 0;
  for (const double turn_deg : {20.0, -35.5}) {
    const glm::dvec2 turned = place(turn_deg, 357.5),
                     plain = place(0, std::fmod(357.5 + turn_deg, 360));
    worst = std::max(worst, distance_deg(turned.x, turned.y, plain.x, plain.y));
  }
  nepho::test::report_accuracy("Forecasts in GRIB", "rotated poles that turn", worst, 1e-3, "deg");
  EXPECT_LT(worst, 1e-3);
}

// From a satellite above 10 E: places by the formulas of CGMS 03, 4.4.3.2; on a sphere, and where
// rows run south and east, also ecCodes's own (2.28 has no radius of an ellipsoid there).
TEST(GribViews, SatelliteViews) {
  constexpr double kRadii = 6.610839, kEquator_m = 6371229, kPole_m = 6350000, kDisc = 400;
  constexpr double kXp = 210.5, kYp = 190.25;
  constexpr int kXo = 260, kYo = 120;
  double worst = 0;
  for (const bool sphere : {true, false})
    for (const bool north : {false, true})
      for (const bool west : {false, true}) {
        const bool placed = sphere && !north && !west;
        const Case c{"view",
                     2,
                     kNx * kNy,
                     with(sphere ? Keys{{"gridType", "space_view"}, {"shapeOfTheEarth", 6}}
                                 : Keys{{"gridType", "space_view"},
                                        {"shapeOfTheEarth", 7},
                                        {"scaleFactorOfEarthMajorAxis", 0},
                                        {"scaledValueOfEarthMajorAxis", int(kEquator_m)},
                                        {"scaleFactorOfEarthMinorAxis", 0},
                                        {"scaledValueOfEarthMinorAxis", int(kPole_m)}},
                          {{"Nx", kNx},
                           {"Ny", kNy},
                           {"latitudeOfSubSatellitePoint", 0},
                           {"longitudeOfSubSatellitePoint", 10000000},
                           {"dx", int(kDisc)},
                           {"dy", int(kDisc)},
                           {"Xp", int(kXp * 1000)},
                           {"Yp", int(kYp * 1000)},
                           {"orientationOfTheGrid", 0},
                           {"Nr", int(kRadii * 1e6)},
                           {"Xo", kXo},
                           {"Yo", kYo}}),
                     0.3,
                     true,
                     placed};
        const std::size_t at = 3 * kNx + 7;
        const Planted planted =
            plant(c, at, {{"iScansNegatively", int(west)}, {"jScansPositively", int(north)}});
        const glm::dvec2 place = column_place(*open({planted.path}));
        // From the angles of view.
        const double disc = 2 * std::asin(1 / kRadii), flat = sphere ? 1 : kPole_m / kEquator_m;
        const double x = (7 + kXo - kXp) * disc / kDisc * (west ? -1 : 1);
        const double y = (3 + kYo - kYp) * disc / kDisc * flat * (north ? 1 : -1);
        const double a = 1 + (1 / (flat * flat) - 1) * std::sin(y) * std::sin(y),
                     b = kRadii * std::cos(x) * std::cos(y);
        const double s = (b - std::sqrt(b * b - a * (kRadii * kRadii - 1))) / a;
        const double s1 = kRadii - s * std::cos(x) * std::cos(y),
                     s2 = s * std::sin(x) * std::cos(y), s3 = s * std::sin(y);
        const double d = 180 / std::numbers::pi;
        worst = std::max(worst, distance_deg(place.x, place.y,
                                             d * std::atan(s3 / std::hypot(s1, s2) / (flat * flat)),
                                             10 + d * std::atan(s2 / s1)));
        if (placed)
          worst = std::max(worst, distance_deg(place.x, place.y, planted.place.latitude,
                                               planted.place.longitude));
      }
  nepho::test::report_accuracy("Forecasts in GRIB", "views of a satellite against CGMS and ecCodes",
                               worst, 1e-3, "deg");
  EXPECT_LT(worst, 1e-3);
}

}  // namespace
}  // namespace nepho::grib::test
