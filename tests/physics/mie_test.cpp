#include "optics/mie.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "accuracy_report.h"
#include "core/error.h"
#include "optics/hg_draine.h"
#include "optics/mie_table.h"
#include "physics/physics_cpp.h"
#include "truth_table.h"

namespace nepho::test {
namespace {

using std::numbers::pi;

struct Published {
  double x;
  std::complex<double> index;
  double extinction, scattering, asymmetry, backscattering;  // 0: not given
};

TEST(Mie, AgreesWithPublishedSpheres) {
  // MIEV0 (Wiscombe 1979), six decimals; Bohren & Huffman p. 482, five.
  const Published rows[] = {{10, {1.5, 0}, 2.881999, 2.881999, 0.742913, 0},
                            {100, {1.33, 1e-5}, 2.101321, 2.096594, 0.868959, 0},
                            {10000, {1.33, 1e-5}, 2.004089, 1.723857, 0.907840, 0},
                            {100, {1.5, 1}, 2.097502, 1.283697, 0.850252, 0},
                            {2 * pi * 0.525 / 0.6328, {1.55, 0}, 3.10543, 3.10543, 0, 2.92534}};
  double worst = 0;
  for (const Published& row : rows) {
    const MieEfficiencies q = mie_efficiencies(row.x, mie_coefficients(row.x, row.index));
    const auto check = [&](double got, double published) {
      if (published != 0) worst = std::max(worst, std::abs(got - published));
    };
    check(q.extinction, row.extinction);
    check(q.scattering, row.scattering);
    check(q.asymmetry, row.asymmetry);
    check(q.backscattering, row.backscattering);
  }
  report_accuracy("Mie", "published efficiencies and asymmetries", worst, 6e-6, "1");
  EXPECT_LE(worst, 6e-6);  // half a digit of the shortest
}

TEST(Mie, SmallSpheresAreRayleighs) {
  // x -> 0: Q = 8/3 x^4 |K|^2, K = (m^2 - 1) / (m^2 + 2); intensity ~ 1 + cos^2.
  const double x = 1e-3, m = 1.33, k = (m * m - 1) / (m * m + 2);
  const MieCoefficients coefficients = mie_coefficients(x, m);
  const MieEfficiencies q = mie_efficiencies(x, coefficients);
  EXPECT_NEAR(q.scattering / (8.0 / 3 * std::pow(x, 4) * k * k), 1, 1e-5);
  EXPECT_NEAR(q.asymmetry, 0, 1e-6);
  std::vector<double> intensity(3, 0.0);
  add_mie_intensity(coefficients, std::vector<double>{1, 0, -1}, 1, intensity);
  EXPECT_NEAR(intensity[0] / intensity[1], 2, 1e-5);
  EXPECT_NEAR(intensity[2] / intensity[1], 2, 1e-5);
}

TEST(MieTable, HoldsWhatTheProgramComputes) {
  // The smallest radius, which costs least; the same code fills every row.
  const MieColumn column = compute_mie_column(kMieRadii_m.front(), 0);
  const MieRow& row = mie_rows().front();
  ASSERT_EQ(row.effective_radius_m, kMieRadii_m.front());
  int apart = 0;
  for (std::size_t texel = 0; texel < column.log_phase_1e4.size(); ++texel)
    apart = std::max(apart, std::abs(column.log_phase_1e4[texel] - row.log_phase_1e4[0][texel]));
  EXPECT_LE(apart, 1);  // the last digit, where another libm rounds otherwise
  EXPECT_NEAR(column.asymmetry, row.bulk.asymmetry[0], 1e-6);
  EXPECT_NEAR(column.extinction_efficiency, row.bulk.extinction_efficiency[0], 1e-5);
  EXPECT_NEAR(column.co_albedo / row.bulk.co_albedo[0], 1, 1e-5);
}

TEST(MieTable, BulkAgreesWithTruth) {
  const TruthTable truth(NEPHO_TRUTH_DIR "/mie_bulk.csv");
  ASSERT_EQ(truth.rows(), 15u);
  double asymmetry = 0, extinction = 0, absorption = 0;
  for (std::size_t i = 0; i < truth.rows(); ++i) {
    Phase phase;
    phase.effective_radius_m = truth.at(i, "r_eff_um") * 1e-6;
    const PhaseBulk bulk = phase_bulk(phase);
    const double wavelength_m = truth.at(i, "lambda_um") * 1e-6;
    std::size_t at = 0;
    while (at < 2 && std::abs(kWavelengths_m[at] - wavelength_m) > 1e-9) ++at;
    asymmetry = std::max(asymmetry, std::abs(bulk.asymmetry[at] - truth.at(i, "g")));
    extinction =
        std::max(extinction, std::abs(bulk.extinction_efficiency[at] / truth.at(i, "Q_ext") - 1));
    absorption =
        std::max(absorption, std::abs(bulk.co_albedo[at] / truth.at(i, "one_minus_ssa") - 1));
  }
  report_accuracy("Mie", "asymmetry of droplets", asymmetry, 5e-4, "1");
  report_accuracy("Mie", "extinction efficiency of droplets", extinction, 1e-3, "1");
  EXPECT_LE(asymmetry, 5e-4);
  EXPECT_LE(extinction, 1e-3);
  EXPECT_LE(absorption, 0.05);  // the truth has two digits of it
}

// The curve that the table means, as a shader reads it.
double look_up(const std::vector<float>& table, double theta, std::size_t wavelength) {
  const double sine = std::sin(theta / 2);
  const double at = f64::phase_table_coordinate(2 * sine * sine) * (kPhaseTexels - 1);
  const auto texel = std::min(std::size_t(at), std::size_t(kPhaseTexels - 2));
  const double low = table[3 * texel + wavelength], high = table[3 * texel + 3 + wavelength];
  return std::exp(low + (at - double(texel)) * (high - low));
}

TEST(MieTable, AgreesWithTruthPointByPoint) {
  const TruthTable truth(NEPHO_TRUTH_DIR "/mie_phase.csv");
  ASSERT_GE(truth.rows(), 150u);
  double worst_mean = 0, worst = 0, worst_glory = 0;
  for (const int radius_um : {5, 8, 10, 14, 20}) {
    Phase phase;
    phase.effective_radius_m = radius_um * 1e-6;
    const std::vector<float> table = phase_table(phase);
    for (std::size_t w = 0; w < 3; ++w) {
      const std::string name = "P_re" + std::to_string(radius_um) + "_" +
                               std::to_string(std::lround(kWavelengths_m[w] * 1e9)) + "nm";
      double sum = 0;
      for (std::size_t row = 0; row < truth.rows(); ++row) {
        const double theta = truth.at(row, "theta_deg") * pi / 180;
        const double error = std::abs(look_up(table, theta, w) * 4 * pi / truth.at(row, name) - 1);
        sum += error;
        double& largest = theta < 178 * pi / 180 ? worst : worst_glory;
        largest = std::max(largest, error);
      }
      worst_mean = std::max(worst_mean, sum / double(truth.rows()));
    }
  }
  report_accuracy("Mie", "phase table, mean error of a column", worst_mean, 5e-3, "1");
  report_accuracy("Mie", "phase table, largest error below 178 deg", worst, 0.03, "1");
  // Texels are 0.35 deg apart there, as wide as the glory's centre of large droplets.
  report_accuracy("Mie", "phase table, largest error in the glory", worst_glory, 0.2, "1");
  EXPECT_LE(worst_mean, 5e-3);
  EXPECT_LE(worst, 0.03);
  EXPECT_LE(worst_glory, 0.2);
}

TEST(PhaseTable, IsNormalisedForAnyRadius) {
  double norm = 0, asymmetry = 0;
  for (double radius_um = 4; radius_um <= 30; radius_um *= 1.03) {
    Phase phase;
    phase.effective_radius_m = radius_um * 1e-6;
    const std::vector<float> table = phase_table(phase);
    ASSERT_EQ(table.size(), std::size_t(3 * kPhaseTexels));
    for (int w = 0; w < 3; ++w) {
      const PhaseMoments moments = phase_table_moments(table, w);
      norm = std::max(norm, std::abs(moments.integral - 1));
      asymmetry = std::max(
          asymmetry, std::abs(moments.asymmetry - phase_bulk(phase).asymmetry[std::size_t(w)]));
    }
  }
  report_accuracy("Mie", "phase table, norm at any radius", norm, 1e-3, "1");
  report_accuracy("Mie", "phase table, asymmetry at any radius", asymmetry, 5e-4, "1");
  EXPECT_LE(norm, 1e-3);
  EXPECT_LE(asymmetry, 5e-4);
}

TEST(PhaseTable, HoldsBetweenItsRows) {
  Phase phase;
  phase.effective_radius_m = std::sqrt(kMieRadii_m[0] * kMieRadii_m[1]);
  const MieColumn truth = compute_mie_column(phase.effective_radius_m, 0);
  const std::vector<float> table = phase_table(phase);
  double mean = 0;
  for (std::size_t texel = 0; texel < std::size_t(kPhaseTexels); ++texel)
    mean += std::abs(std::expm1(table[3 * texel] + std::log(4 * pi) -
                                kMieTableStep * truth.log_phase_1e4[texel])) /
            kPhaseTexels;
  const double asymmetry = std::abs(phase_table_moments(table, 0).asymmetry - truth.asymmetry);
  report_accuracy("Mie", "phase table between two radii, mean error", mean, 0.01, "1");
  report_accuracy("Mie", "asymmetry between two radii", asymmetry, 5e-4, "1");
  EXPECT_LE(mean, 0.01);
  EXPECT_LE(asymmetry, 5e-4);
}

TEST(PhaseTable, HoldsHenyeyGreenstein) {
  double worst = 0, norm = 0;
  for (const double g : {-0.7, 0.0, 0.75, 0.85, 0.95}) {
    Phase phase;
    phase.kind = PhaseKind::kHenyeyGreenstein;
    phase.asymmetry = g;
    const std::vector<float> table = phase_table(phase);
    for (double theta = 1e-3; theta < pi; theta *= 1.01) {
      const double sine = std::sin(theta / 2);
      worst = std::max(worst,
                       std::abs(look_up(table, theta, 1) / f64::hg_phase(2 * sine * sine, g) - 1));
    }
    norm = std::max(norm, std::abs(phase_table_moments(table, 1).asymmetry - g));
  }
  report_accuracy("Mie", "HG through the table", worst, 1e-4, "1");
  EXPECT_LE(worst, 1e-4);
  EXPECT_LE(norm, 1e-4);
}

// Against constants worked out apart from this program, the moments of its own curve, and Mie.
TEST(HgDraine, IsTheFitToDroplets) {
  const HgDraine fit = hg_draine_fit(10e-6);
  EXPECT_NEAR(fit.peak_asymmetry, 0.99461, 1e-6);
  EXPECT_NEAR(fit.draine_asymmetry, 0.593791, 1e-6);
  EXPECT_NEAR(fit.alpha, 27.113694, 1e-5);
  EXPECT_NEAR(fit.draine_part, 0.498159, 1e-6);
  EXPECT_NEAR(fit.asymmetry(), 0.87931, 1e-5);
  EXPECT_NEAR(fit.value(2), 0.13715 / (4 * pi), 1e-6);
  EXPECT_NEAR(hg_draine_fit(5e-6).asymmetry(), 0.864164, 1e-6);
  EXPECT_NEAR(hg_draine_fit(20e-6).asymmetry(), 0.889028, 1e-6);
}

TEST(HgDraine, IsHeldByItsTable) {
  double worst = 0, norm = 0, moment = 0, from_mie = 0;
  for (const double radius_m : {2.5e-6, 4e-6, 10e-6, 20e-6, 25e-6}) {
    const Phase phase{PhaseKind::kHgDraine, radius_m, 0};
    const HgDraine fit = hg_draine_fit(radius_m);
    const std::vector<float> table = phase_table(phase);
    for (double theta = 1e-3; theta < pi; theta *= 1.01) {
      const double sine = std::sin(theta / 2);
      worst = std::max(worst, std::abs(look_up(table, theta, 1) / fit.value(2 * sine * sine) - 1));
    }
    // Of the formula by the same quadrature: before the table is normalised they agree with it.
    std::vector<float> plain(table.size());
    for (int texel = 0; texel < kPhaseTexels; ++texel) {
      const double sine = std::sin(phase_texel_angle_rad(texel) / 2);
      plain[3 * std::size_t(texel)] = float(std::log(fit.value(2 * sine * sine)));
    }
    norm = std::max(norm, std::abs(phase_table_moments(plain, 0).integral - 1));
    moment = std::max(moment, std::abs(phase_table_moments(table, 1).asymmetry - fit.asymmetry()));
    EXPECT_EQ(phase_bulk(phase).asymmetry[0], fit.asymmetry());
    if (radius_m < 4e-6) continue;
    const double exact = phase_bulk({PhaseKind::kMie, radius_m, 0}).asymmetry[1];
    from_mie = std::max(from_mie, std::abs(fit.asymmetry() - exact));
  }
  report_accuracy("Mie", "HG + Draine through the table", worst, 1e-3, "1");
  report_accuracy("Mie", "HG + Draine, integral", norm, 2e-4, "1");
  report_accuracy("Mie", "HG + Draine through the table, asymmetry", moment, 1e-4, "1");
  report_accuracy("Mie", "HG + Draine instead of Mie, asymmetry", from_mie, 0.02, "1");
  EXPECT_LE(worst, 1e-3);
  EXPECT_LE(norm, 2e-4);
  EXPECT_LE(moment, 1e-4);
  EXPECT_LE(from_mie, 0.02);
}

TEST(PhaseTable, RefusesWhatItDoesNotHold) {
  Phase phase;
  for (const double radius_m : {0.0, 2.4e-6, 26e-6, std::nan("")}) {
    phase = {PhaseKind::kHgDraine, radius_m, 0};
    EXPECT_THROW(phase_table(phase), Error);
    EXPECT_THROW(phase_bulk(phase), Error);
  }
  phase = {};
  for (const double radius_m : {0.0, 3.9e-6, 31e-6, std::nan("")}) {
    phase.effective_radius_m = radius_m;
    EXPECT_THROW(phase_table(phase), Error);
    EXPECT_THROW(phase_bulk(phase), Error);
  }
  phase.kind = PhaseKind::kHenyeyGreenstein;
  for (const double g : {1.0, -1.0, std::nan("")}) {
    phase.asymmetry = g;
    EXPECT_THROW(phase_table(phase), Error);
  }
}

}  // namespace
}  // namespace nepho::test
