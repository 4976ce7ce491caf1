// Charts against GeographicLib, and placements. Truth for positions: the chart's and the
// ellipsoid's closed forms in long double (64-bit mantissa), written out here a second time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "geo/place.h"
#include "random.h"

namespace nepho::test {
namespace {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the truth needs more digits than a double");
constexpr Real kPi = std::numbers::pi_v<Real>;
const ShellChart kShell(Ellipsoid::wgs84(), -500, 100000);
const double kHeights_m[] = {-500, 0, 1.7, 10000, 24000, 100000};

double distance_m(glm::dvec3 p, const std::array<Real, 3>& truth) {
  return double(std::hypot(Real(p.x) - truth[0], Real(p.y) - truth[1], Real(p.z) - truth[2]));
}

// Poles, antimeridian, cube edges and corners (lon 45 + 90 n; tan lat = cos lon * ...), then
// random.
std::vector<GeodeticPoint> places() {
  std::vector<GeodeticPoint> result;
  const double corner_deg = 35.447;  // geodetic; the cube's corner is at 35.2644 geocentric, scaled
  for (const double h : kHeights_m) {
    for (const double lat : {-90., -89.99999999, -45.19, -corner_deg, -1e-9, 0., 1e-9, corner_deg,
                             44.81, 45., 89.9999, 90.})
      for (const double lon :
           {-180., -179.999999999, -135., -90., -45., 0., 45., 90., 135., 179.999999999, 180.})
        result.push_back({lat, lon, h});
    Random random;
    for (int n = 0; n < 2000; ++n)
      result.push_back({std::asin(random.uniform(-1, 1)) * 180 / std::numbers::pi,
                        random.uniform(-180, 180), h});
  }
  return result;
}

std::array<Real, 3> true_ecef(const Ellipsoid& body, const GeodeticPoint& p) {
  const Real a = body.equatorial_m, b = body.polar_m;
  const Real lat = p.latitude_deg * kPi / 180, lon = p.longitude_deg * kPi / 180;
  const Real n = a * a / std::hypot(a * std::cos(lat), b * std::sin(lat));
  return {(n + p.height_m) * std::cos(lat) * std::cos(lon),
          (n + p.height_m) * std::cos(lat) * std::sin(lon),
          (n * (b / a) * (b / a) + p.height_m) * std::sin(lat)};
}

TEST(Geo, PositionsAndBack) {
  for (const auto& [name, body] :
       {std::pair{"wgs84", Ellipsoid::wgs84()},
        {"mars", Ellipsoid{constants::kMarsEquatorial_m, constants::kMarsPolar_m}},
        {"sphere", Ellipsoid::sphere(1737400)},
        {"prolate", Ellipsoid{6300000, 6400000}}}) {
    double forward_m = 0, formats_m = 0, back_m = 0, height_m = 0;
    for (const GeodeticPoint& p : places()) {
      const std::array<Real, 3> truth = true_ecef(body, p);
      const glm::dvec3 ecef = ecef_m(body, p);
      forward_m = std::max(forward_m, distance_m(ecef, truth));
      formats_m = std::max(
          formats_m,
          distance_m(geodetic_to_ecef_m(body, p.latitude_deg * std::numbers::pi / 180,
                                        p.longitude_deg * std::numbers::pi / 180, p.height_m),
                     truth));
      const GeodeticPoint again = geodetic_point(body, ecef);
      back_m = std::max(back_m, distance_m(ecef, true_ecef(body, again)));
      height_m = std::max(height_m, std::abs(again.height_m - p.height_m));
    }
    const std::string of = std::string(", ") + name + ", -500 m to 100 km";
    report_accuracy("charts", "geo ecef_m" + of, forward_m, 5e-9, "m");
    report_accuracy("charts", "formats geodetic_to_ecef_m" + of, formats_m, 5e-9, "m");
    report_accuracy("charts", "geo geodetic_point of ecef_m" + of, back_m, 5e-9, "m");
    report_accuracy("charts", "geo geodetic_point height" + of, height_m, 7e-9, "m");
    for (const double worst_m : {forward_m, formats_m, back_m}) EXPECT_LE(worst_m, 5e-9);
    EXPECT_LE(height_m, 7e-9);
  }
}

TEST(ShellChart, PositionsInHighPrecision) {
  // n, u, v of the six faces as rows of unit vectors: lattice.md's order +x -x +y -y +z -z.
  static const int kFace[6][3][3] = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
      {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}};
  const Real a = kShell.body().equatorial_m, b = kShell.body().polar_m;
  double worst_m = 0;
  for (int root = 0; root < 6; ++root)
    for (int i = 0; i <= 64; ++i)
      for (int j = 0; j <= 64; ++j)
        for (int k = 0; k <= 8; ++k) {
          const Real u = std::tan(kPi / 4 * (Real(i) / 32 - 1));
          const Real v = std::tan(kPi / 4 * (Real(j) / 32 - 1));
          const Real h = kShell.bottom_m() + Real(k) / 8 * kShell.thickness_m();
          const Real scale = (a + h) / std::sqrt(1 + u * u + v * v);
          std::array<Real, 3> truth{};
          for (std::size_t c = 0; c < 3; ++c)
            truth[c] = scale * (kFace[root][0][c] + u * kFace[root][1][c] + v * kFace[root][2][c]) *
                       (c == 2 ? b / a : 1);
          worst_m = std::max(
              worst_m, distance_m(kShell.ecef_m({root, {i / 64.0, j / 64.0, k / 8.0}}), truth));
        }
  report_accuracy("charts", "shell ecef_m against long double, 6 faces with edges and corners",
                  worst_m, 5e-9, "m");
  EXPECT_LE(worst_m, 5e-9);
}

// From GeographicLib's place through the chart and back to GeographicLib's place.
TEST(ShellChart, PlacesSurviveTheChart) {
  double distance = 0, height_m = 0;
  for (const GeodeticPoint& p : places()) {
    const glm::dvec3 ecef = ecef_m(Ellipsoid::wgs84(), p);
    const glm::dvec3 back = kShell.ecef_m(kShell.locate(ecef));
    distance = std::max(distance, glm::length(back - ecef));
    height_m = std::max(height_m,
                        std::abs(geodetic_point(Ellipsoid::wgs84(), back).height_m - p.height_m));
  }
  report_accuracy("charts", "shell ecef_m(locate(p)) - p, poles, antimeridian, edges, corners",
                  distance, 5e-9, "m");
  report_accuracy("charts", "geodetic height through the shell chart", height_m, 7e-9, "m");
  EXPECT_LE(distance, 5e-9);
  EXPECT_LE(height_m, 7e-9);
}

// Where things are: names of places, not formulas.
TEST(ShellChart, FacesLieWhereTheyShould) {
  const auto at = [](double lat, double lon, double h) {
    return kShell.locate(ecef_m(Ellipsoid::wgs84(), {lat, lon, h}));
  };
  const double ground = 500.0 / 100500;
  const struct {
    double lat, lon;
    int root;
    double x, y;
  } cases[] = {{0, 0, 0, 0.5, 0.5},     {0, 180, 1, 0.5, 0.5}, {0, -180, 1, 0.5, 0.5},
               {0, 90, 2, 0.5, 0.5},    {0, -90, 3, 0.5, 0.5}, {90, 0, 4, 0.5, 0.5},
               {90, 123, 4, 0.5, 0.5},  {-90, 7, 5, 0.5, 0.5}, {0, 22.5, 0, 0.75, 0.5},
               {0, -22.5, 0, 0.25, 0.5}};
  for (const auto& c : cases) {
    const RootPosition p = at(c.lat, c.lon, 0);
    EXPECT_EQ(p.root, c.root) << c.lat << " " << c.lon;
    EXPECT_NEAR(p.q.x, c.x, 1e-15);
    EXPECT_NEAR(p.q.y, c.y, 1e-15);
    EXPECT_NEAR(p.q.z, ground, 1e-14);
  }
  EXPECT_GT(at(10, 0, 0).q.y, 0.5);  // north is up on the four side faces
  EXPECT_GT(at(10, 90, 0).q.y, 0.5);
  EXPECT_EQ(at(0, 44.999, 0).root, 0);
  EXPECT_EQ(at(0, 45.001, 0).root, 2);
}

TEST(Placement, HeadingTurnsTheBox) {
  const auto column = [](const Placement& p, int n) {
    return glm::dvec3{p.axes[3 * n], p.axes[3 * n + 1], p.axes[3 * n + 2]};
  };
  // At (0, 0): east = +y, north = +z, up = +x.
  const struct {
    double heading;
    glm::dvec3 x, y;
  } cases[] = {{0, {0, 1, 0}, {0, 0, 1}},
               {90, {0, 0, -1}, {0, 1, 0}},
               {180, {0, -1, 0}, {0, 0, -1}},
               {-90, {0, 0, 1}, {0, -1, 0}},
               {360, {0, 1, 0}, {0, 0, 1}}};
  for (const auto& c : cases) {
    const Placement p = placement_of({0, 0, 25, c.heading});
    EXPECT_EQ(column(p, 0), c.x) << c.heading;
    EXPECT_EQ(column(p, 1), c.y) << c.heading;
    EXPECT_EQ(column(p, 2), (glm::dvec3{1, 0, 0}));
    EXPECT_EQ(p.origin_ecef_m[0], 6378137.0 + 25);
  }
}

TEST(Placement, IsAFrameOnTheGround) {
  Random random;
  double skew = 0, step = 0;
  for (int n = 0; n < 5000; ++n) {
    const GeodeticPlace place{random.uniform(-90, 90), random.uniform(-180, 180),
                              random.uniform(-500, 100000), random.uniform(-720, 720)};
    const Placement p = placement_of(place);
    glm::dmat3 axes;
    for (int c = 0; c < 3; ++c) axes[c] = {p.axes[3 * c], p.axes[3 * c + 1], p.axes[3 * c + 2]};
    const glm::dmat3 gram = glm::transpose(axes) * axes;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) skew = std::max(skew, std::abs(gram[c][r] - (c == r)));
    EXPECT_GT(glm::determinant(axes), 0.999);
    // 1 km up along z is 1 km of height at the same place.
    const glm::dvec3 origin{p.origin_ecef_m[0], p.origin_ecef_m[1], p.origin_ecef_m[2]};
    const GeodeticPoint above = geodetic_point(Ellipsoid::wgs84(), origin + 1000.0 * axes[2]);
    EXPECT_NEAR(above.height_m, place.height_m + 1000, 1e-8);
    // 1 m along y leads north by cos(heading).
    if (std::abs(place.latitude_deg) < 89) {
      const GeodeticPoint ahead = geodetic_point(Ellipsoid::wgs84(), origin + axes[1]);
      const double lat = place.latitude_deg * std::numbers::pi / 180;
      const double meridian_m =
          6378137.0 * (1 - 0.00669437999014132) /
              std::pow(1 - 0.00669437999014132 * std::sin(lat) * std::sin(lat), 1.5) +
          place.height_m;
      const double north_m =
          (ahead.latitude_deg - place.latitude_deg) * std::numbers::pi / 180 * meridian_m;
      step =
          std::max(step, std::abs(north_m - std::cos(place.heading_deg * std::numbers::pi / 180)));
    }
  }
  report_accuracy("charts", "placement axes off orthonormal", skew, 1e-15, "1");
  EXPECT_LE(skew, 1e-15);
  EXPECT_LE(step, 1e-5);  // 1 m of curvature: tan(lat) / 2a, at 89 degrees 5e-6
}

TEST(Placement, RefusesNonsense) {
  const double nan = std::nan("");
  EXPECT_THROW(placement_of({90.001, 0, 0, 0}), Error);
  EXPECT_THROW(placement_of({nan, 0, 0, 0}), Error);
  EXPECT_THROW(placement_of({0, nan, 0, 0}), Error);
  EXPECT_THROW(placement_of({0, 0, 1 / 0.0, 0}), Error);
  EXPECT_THROW(placement_of({0, 0, 0, nan}), Error);
  EXPECT_THROW(geodetic_point(Ellipsoid::wgs84(), {0, nan, 0}), Error);
}

}  // namespace
}  // namespace nepho::test
