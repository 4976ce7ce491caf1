// Light under clouds against adding-doubling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accuracy_report.h"
#include "physics/physics_cpp.h"

namespace nepho::test {
namespace {

// Transmitted flux, direct and scattered, of slabs of Henyey-Greenstein droplets, g = 0.85, without
// absorption over black ground: adding-doubling, 128 streams, nine digits, of which six stand here.
struct Row {
  double tau, overhead, half, low;  // mu0 = 1, 0.5, 0.2
};
constexpr Row kSlabs[] = {{0.1, 0.996289, 0.982888, 0.906794}, {1, 0.957684, 0.835122, 0.581283},
                          {2, 0.908982, 0.719815, 0.485673},   {4, 0.809085, 0.583978, 0.393683},
                          {8, 0.641568, 0.441922, 0.298517},   {16, 0.442791, 0.302595, 0.204466},
                          {32, 0.272192, 0.185979, 0.125668},  {128, 0.082180, 0.056151, 0.037942}};

TEST(Daylight, UnderEvenClouds) {
  double high = 0, low = 0;
  for (const Row& row : kSlabs)
    for (const double mu0 : {1.0, 0.5, 0.2}) {
      const double truth = mu0 == 1.0 ? row.overhead : mu0 == 0.5 ? row.half : row.low;
      const double got = f64::cloud_daylight(row.tau / mu0, row.tau, mu0, 0.85);
      double& worst = mu0 >= 0.5 ? high : low;
      worst = std::max(worst, std::abs(got / truth - 1));
    }
  report_accuracy("air", "daylight under even clouds, mu0 >= 0.5", high, 0.05, "1");
  report_accuracy("air", "daylight under even clouds, mu0 = 0.2", low, 0.2, "1");
  EXPECT_LE(high, 0.05);
  EXPECT_LE(low, 0.2);
}

TEST(Daylight, BesideTheCloudItIsTheBeamAlone) {
  EXPECT_EQ(f64::cloud_daylight(0, 0, 0.7, 0.85), 1);
  EXPECT_EQ(f64::cloud_daylight(0, 20, 0.7, 0.85), 1);
  EXPECT_NEAR(f64::cloud_daylight(3, 0, 0.7, 0.85), std::exp(-3.0), 1e-12);
  // Never more than without clouds, and ever less as they thicken.
  double before = 1;
  for (double tau = 0; tau < 100; tau += 0.25) {
    const double now = f64::cloud_daylight(tau / 0.6, tau, 0.6, 0.85);
    EXPECT_LE(now, before + 1e-12) << tau;
    before = now;
  }
}

}  // namespace
}  // namespace nepho::test
