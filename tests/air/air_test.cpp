#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>

#include "accuracy_report.h"
#include "air/air_lookup.h"
#include "physics/physics_cpp.h"
#include "truth_table.h"

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
  double worst = 0, worst_low = 0;
  for (double height_m = 0; height_m < air.top_m; height_m += 997)
    for (double zenith_deg = 0; zenith_deg <= 91; zenith_deg += 0.25) {
      const double zenith = zenith_deg * pi / 180;
      if (zenith > pi / 2 + std::acos(kRadius_m / (kRadius_m + height_m)) - 1e-9) continue;
      const double mu = std::cos(zenith);
      const glm::dvec3 off = glm::exp(-lookup.depth(height_m, mu)) -
                             glm::exp(-air_optical_depth(air, kRadius_m, height_m, mu, kEndless_m));
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(off[c]));
        if (height_m < 0.9 * air.ozone_high_m) worst_low = std::max(worst_low, std::abs(off[c]));
      }
    }
  test::report_accuracy("clear air", "transmittance table against quadrature", worst, 2e-3, "1");
  test::report_accuracy("clear air", "the same under the corner where ozone ends", worst_low, 1e-3,
                        "1");
  EXPECT_LE(worst, 2e-3);
  EXPECT_LE(worst_low, 1e-3);
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

// The Chapman function is the exact depth of an exponential layer around a sphere.
TEST(AirTables, TransmittanceIsChapmansFunction) {
  const test::TruthTable truth(NEPHO_TRUTH_DIR "/chapman.csv");
  constexpr double kTruthRadius_m = 6371e3;
  double worst = 0, worst_table = 0;
  int rows = 0;
  for (const double scale_m : {8000.0, 1200.0}) {
    Air air;
    air.ozone_per_m = air.aerosol_extinction_per_m = glm::dvec3{0.0};
    air.rayleigh_scale_m = scale_m;
    Air endless = air;  // the truth has no top
    endless.top_m = 14 * scale_m;
    const AirTables made = make_air_tables(air, kTruthRadius_m, glm::dvec3{0.1});
    const AirLookup lookup(air, kTruthRadius_m, made);
    for (std::size_t r = 0; r < truth.rows(); ++r) {
      if (truth.at(r, "H_m") != scale_m) continue;
      const double h_m = truth.at(r, "h_m"), zenith = truth.at(r, "zenith_deg") * pi / 180;
      if (zenith > pi / 2 + std::acos(kTruthRadius_m / (kTruthRadius_m + h_m))) continue;
      ++rows;
      const double mu = std::cos(zenith);
      const double amount_m = scale_m * std::exp(-h_m / scale_m) * truth.at(r, "Chapman");
      const glm::dvec3 found = air_optical_depth(endless, kTruthRadius_m, h_m, mu, kEndless_m);
      const glm::dvec3 held = lookup.depth(h_m, mu);
      for (int c = 0; c < 3; ++c) {
        const double exact = air.rayleigh_per_m[c] * amount_m;
        const double through = std::exp(-exact);
        worst = std::max(worst, std::abs(std::exp(-found[c]) - through));
        worst_table = std::max(worst_table, std::abs(std::exp(-held[c]) - through));
      }
    }
  }
  EXPECT_GE(rows, 60);
  test::report_accuracy("clear air", "transmittance by quadrature against Chapman's function",
                        worst, 1e-6, "1");
  test::report_accuracy("clear air", "transmittance table against Chapman's function", worst_table,
                        2e-3, "1");
  EXPECT_LE(worst, 1e-6);
  EXPECT_LE(worst_table, 2e-3);
}

TEST(AirTables, BitsDoNotDependOnThreads) {
  const auto made_with = [](int threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                            std::size_t(threads));
    const std::clock_t begin = std::clock();
    AirTables made = make_air_tables(Air{}, kRadius_m, glm::dvec3{0.1});
    std::printf("measured: clear air: tables with %d threads: %.2f CPU s\n", threads,
                double(std::clock() - begin) / CLOCKS_PER_SEC);
    return made;
  };
  const AirTables one = made_with(1), eight = made_with(8);
  for (const auto table :
       {&AirTables::depth, &AirTables::multiple, &AirTables::multiple_p2, &AirTables::sky_up,
        &AirTables::sky_side, &AirTables::sky_down, &AirTables::sky_low}) {
    ASSERT_FALSE((one.*table).rgb.empty());
    ASSERT_EQ((one.*table).rgb.size(), (eight.*table).rgb.size());
    EXPECT_EQ(std::memcmp((one.*table).rgb.data(), (eight.*table).rgb.data(),
                          (one.*table).rgb.size() * sizeof(float)),
              0);
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

}  // namespace
}  // namespace nepho
