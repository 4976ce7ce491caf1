// The interim light model on slabs, against the exact radiance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "physics/physics_cpp.h"
#include "truth_table.h"

namespace nepho::test {
namespace {

struct Slab {
  double g, tau, mu0, mu, azimuth_rad;
};
struct Octave {
  double scattering, sun_depth, asymmetry;  // factors
};

// Light scattered once, per octave, out of a slab's top or base: the sun's depth is scaled, the
// view's is not.
struct Radiance {
  double up = 0, down = 0;
};
Radiance slab_radiance(const Slab& slab, int count, Octave (*octave)(int)) {
  const double sines =
      std::sqrt((1 - slab.mu * slab.mu) * (1 - slab.mu0 * slab.mu0)) * std::cos(slab.azimuth_rad);
  Radiance sum;
  for (int n = 0; n < count; ++n) {
    const auto [scattering, sun_depth, asymmetry] = octave(n);
    const auto phase = [&](double cosine) {
      return scattering * f64::hg_phase(1 - cosine, slab.g * asymmetry) * slab.tau / slab.mu;
    };
    const double slant_up = slab.tau * (1 / slab.mu + sun_depth / slab.mu0);
    const double slant_down = slab.tau * (sun_depth / slab.mu0 - 1 / slab.mu);
    const auto mean = [](double x) { return x == 0 ? 1 : -std::expm1(-x) / x; };
    sum.up += phase(sines - slab.mu * slab.mu0) * mean(slant_up);
    sum.down +=
        phase(sines + slab.mu * slab.mu0) * std::exp(-slab.tau / slab.mu) * mean(slant_down);
  }
  return sum;
}
Octave project_octave(int n) {
  return {f64::octave_scattering(n), -std::log(f64::octave_transmittance(n, 1)),
          f64::octave_asymmetry(n, 1)};
}
Octave halves(int n) {
  return {std::pow(0.5, n), std::pow(0.5, n), std::pow(0.5, n)};
}

// Root mean square factor between model and truth.
struct Factor {
  double sum = 0;
  int count = 0;
  void add(double got, double truth) {
    sum += std::pow(std::log(got / truth), 2);
    ++count;
  }
  double value() const { return std::exp(std::sqrt(sum / count)); }
};

TEST(Octaves, AreWithinAStatedFactorOnSlabs) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_radiance_conservative.csv");
  ASSERT_EQ(table.rows(), 544u);
  Factor up, down, up_halves, down_halves, up_three;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto at = [&](const char* name) { return table.at(row, name); };
    const Slab slab{at("g"), at("tau"), at("mu0"), at("mu_view"),
                    at("dphi_deg") * std::numbers::pi / 180};
    const Radiance project = slab_radiance(slab, 8, project_octave);
    const Radiance eight = slab_radiance(slab, 8, halves), three = slab_radiance(slab, 3, halves);
    up.add(project.up, at("I_up_top"));
    down.add(project.down, at("I_down_bottom_diffuse"));
    up_halves.add(eight.up, at("I_up_top"));
    down_halves.add(eight.down, at("I_down_bottom_diffuse"));
    up_three.add(three.up, at("I_up_top"));
  }
  const char* section = "light model, slabs (rms factor to truth)";
  report_accuracy(section, "octaves, reflected", up.value(), 2.25, "1");
  report_accuracy(section, "octaves, transmitted", down.value(), 1.8, "1");
  EXPECT_LE(up.value(), 2.25);
  EXPECT_LE(down.value(), 1.8);
  // The usual constants (all 1/2), which these replace: control of the slab formula.
  EXPECT_NEAR(up_halves.value(), 2.48, 0.01);
  EXPECT_NEAR(up_three.value(), 3.37, 0.01);
  EXPECT_GT(down_halves.value(), 10);
}

}  // namespace
}  // namespace nepho::test
