// Stiff cases of phase functions, air and display: each computes its naive form beside the
// project's.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "air/air_lookup.h"
#include "expect_stable.h"
#include "optics/phase_table.h"
#include "physics/physics_cpp.h"

namespace nepho::test {
namespace {

using std::numbers::pi;

// Logarithm of the green phase function between the table's texels.
double log_phase(const std::vector<float>& table, double angle_rad) {
  const double sine = std::sin(angle_rad / 2);
  const double at = f64::phase_table_coordinate(2 * sine * sine) * (kPhaseTexels - 1);
  const auto i = std::min(std::size_t(at), std::size_t(kPhaseTexels - 2));
  const double low = double(table[3 * i + 1]), high = double(table[3 * i + 4]);
  return low + (at - double(i)) * (high - low);
}

TEST(Phase, TableKeepsThePeak) {
  double worst = 0, naive = 0;
  for (const double radius_um : {4.0, 10.0, 20.0, 30.0}) {
    Phase phase;
    phase.effective_radius_m = radius_um * 1e-6;
    const std::vector<float> table = phase_table(phase);
    worst = std::max(worst, std::abs(phase_table_moments(table, 1).integral - 1));
    // The same number of texels, even in angle.
    std::vector<double> even(kPhaseTexels);
    for (int i = 0; i < kPhaseTexels; ++i)
      even[std::size_t(i)] = log_phase(table, pi * i / (kPhaseTexels - 1));
    double sum = 0;
    constexpr int kSteps = 400000;
    for (int step = 0; step < kSteps; ++step) {
      const double angle = pi * (step + 0.5) / kSteps, at = angle / pi * (kPhaseTexels - 1);
      const auto i = std::min(std::size_t(at), std::size_t(kPhaseTexels - 2));
      const double value = std::exp(even[i] + (at - double(i)) * (even[i + 1] - even[i]));
      sum += value * 2 * pi * std::sin(angle) * pi / kSteps;
    }
    naive = std::max(naive, std::abs(sum - 1));
  }
  expect_stable("08", worst, 1e-3, naive, "of the integral over the sphere");
}

TEST(Air, TransmittanceAtTheHorizon) {
  constexpr double kRadius_m = 6378137, kEndless_m = 1e30;
  const Air air;
  const AirTables tables = make_air_tables(air, kRadius_m, glm::dvec3(0.1));
  const AirLookup lookup(air, kRadius_m, tables);
  double worst = 0, naive = 0;
  for (const double height_m : {0.0, 500.0, 4000.0, 12000.0}) {
    const auto depth = [&](double mu) {
      return air_optical_depth(air, kRadius_m, height_m, mu, kEndless_m);
    };
    // As many texels as the table has, even in the cosine of the zenith angle; heights exact.
    std::vector<glm::dvec3> even(std::size_t(tables.depth.width));
    const double texels = tables.depth.width - 1;
    const double horizon = pi / 2 + std::acos(kRadius_m / (kRadius_m + height_m));
    for (std::size_t i = 0; i < even.size(); ++i)
      even[i] = depth(std::max(2 * double(i) / texels - 1, std::cos(horizon)));
    for (double zenith_deg = 85; zenith_deg <= 91; zenith_deg += 0.05) {
      if (zenith_deg * pi / 180 > horizon - 1e-9) continue;
      const double mu = std::cos(zenith_deg * pi / 180), at = 0.5 * (mu + 1) * texels;
      const auto i = std::size_t(at);
      const glm::dvec3 exact = glm::exp(-depth(mu));
      const glm::dvec3 held = glm::exp(-lookup.depth(height_m, mu));
      const glm::dvec3 usual = glm::exp(-(even[i] + (at - double(i)) * (even[i + 1] - even[i])));
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(held[c] - exact[c]));
        naive = std::max(naive, std::abs(usual[c] - exact[c]));
      }
    }
  }
  expect_stable("18", worst, 1e-3, naive, "of transmittance, zenith angles 85 to 91 deg");
}

// The sun's disc, 2e7 W m-2 sr-1, at exposures from -20 to 20 stops, and next to nothing.
TEST(Tone, TheSunsDiscIsFinite) {
  int shown = 0, bad = 0, naive = 0;
  for (const float light : {2e7f, 1.0f, 0.0f})
    for (float stop = -20; stop <= 20; stop += 0.5f) {
      const float exposed = light * std::exp2(stop);
      std::array<float, 3> rgb{};
      f32::aces_tone(exposed, exposed, exposed, rgb[0], rgb[1], rgb[2]);
      for (const float value : rgb) bad += !(value >= 0 && value <= 1);
      // Stored as half, then the curve as written.
      const float stored = light > 65504 ? std::numeric_limits<float>::infinity() : light;
      const float x = stored * std::exp2(stop);
      const float curve =
          (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
      naive += !std::isfinite(curve);
      ++shown;
    }
  expect_stable("44", double(bad) / shown, 0, double(naive) / shown, "of the pixels not in 0 .. 1");
}

}  // namespace
}  // namespace nepho::test
