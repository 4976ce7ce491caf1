#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "air/air_lookup.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

using std::numbers::pi;
constexpr double kRadius_m = 6378137, kEndless_m = 1e30;

const AirTables& tables() {
  static const AirTables made = make_air_tables(Air{}, kRadius_m, glm::dvec3{0.1});
  return made;
}

TEST(AirTables, TransmittanceIsThatOfTheQuadrature) {
  const Air air;
  const AirLookup lookup(air, kRadius_m, tables());
  double worst = 0;
  for (double height_m = 0; height_m < air.top_m; height_m += 997)
    for (double zenith_deg = 0; zenith_deg <= 91; zenith_deg += 0.25) {
      const double zenith = zenith_deg * pi / 180;
      if (zenith > pi / 2 + std::acos(kRadius_m / (kRadius_m + height_m)) - 1e-9) continue;
      const double mu = std::cos(zenith);
      const glm::dvec3 off = glm::exp(-lookup.depth(height_m, mu)) -
                             glm::exp(-air_optical_depth(air, kRadius_m, height_m, mu, kEndless_m));
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(off[c]));
    }
  test::report_accuracy("clear air", "transmittance table against quadrature", worst, 1e-3, "1");
  EXPECT_LE(worst, 1e-3);
}

TEST(AirDepth, VerticalDepthIsTheClosedForm) {
  Air air;
  air.ozone_per_m = glm::dvec3{0.0};
  const glm::dvec3 found = air_optical_depth(air, kRadius_m, 0, 1, kEndless_m);
  const auto column_m = [&](double scale_m) { return -scale_m * std::expm1(-air.top_m / scale_m); };
  for (int c = 0; c < 3; ++c) {
    const double exact = air.rayleigh_per_m[c] * column_m(air.rayleigh_scale_m) +
                         air.aerosol_extinction_per_m[c] * column_m(air.aerosol_scale_m);
    EXPECT_NEAR(found[c], exact, 1e-6 * exact);
  }
}

TEST(AirTables, TheSkyDarkensWithoutJumpsToTheEndOfTwilight) {
  const AirLookup lookup(Air{}, kRadius_m, tables());
  double before = 0, worst = 0;
  for (int step = 0; step <= 190; ++step) {
    const SkyLight sky = lookup.sky(0, std::sin((1 - 0.1 * step) * pi / 180));
    const glm::dvec3 both = sky.up + sky.low;
    const double here = f64::luminance(both.r, both.g, both.b);
    if (step > 0) worst = std::max(worst, std::abs(std::log10(here / before)));
    before = here;
  }
  test::report_accuracy("clear air", "twilight, log10 of luminance per 0.1 degree", worst, 0.05,
                        "1");
  EXPECT_LE(worst, 0.05);
}

TEST(Water, ReflectsNoMoreThanItGets) {
  for (const double wind : {0.0, 6.0, 20.0})
    for (const double mu : {1e-5, 0.05, 0.3, 1.0}) {
      const double radiance =
          f64::water_radiance(0.05, 0, mu, 0.5, 1, 1, f64::water_slope_variance(wind), 1, 1);
      EXPECT_GT(radiance, 0);
      EXPECT_LE(radiance, 1);
    }
}

}  // namespace
}  // namespace nepho
