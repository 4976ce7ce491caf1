// Land and water give back no more light than they get, at any angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "air/gauss.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

using std::numbers::pi;

constexpr double kWinds_m_per_s[] = {0.0, 2.0, 6.0, 12.0, 25.0};

double glint(double mu, double mu_sun, double azimuth, double slope_variance) {
  // From the surface to the eye and to the sun.
  const double sine = std::sqrt((1 - mu) * (1 + mu)), sun_sine = std::sqrt(1 - mu_sun * mu_sun);
  const double cos_apart = mu * mu_sun + sine * sun_sine * std::cos(azimuth);
  const double length = std::sqrt(std::max(2 * (1 + cos_apart), 1e-300));
  return f64::water_glint(mu, mu_sun, (mu + mu_sun) / length, length / 2, slope_variance);
}

// Integral of radiance(mu, azimuth) mu over the upper half of all directions, symmetric in azimuth.
// Azimuths lie dense around the one away from the sun, where the glint is.
template <class Radiance>
double flux(Radiance&& radiance) {
  static const GaussRule rule(160);
  double sum = 0;
  for (std::size_t m = 0; m < rule.node.size(); ++m) {
    const double mu = rule.node[m] * rule.node[m];
    for (std::size_t a = 0; a < rule.node.size(); ++a) {
      const double u = rule.node[a], azimuth = pi * (1 - u * u * u);
      sum += rule.weight[m] * rule.weight[a] * 4 * rule.node[m] * mu * 3 * pi * u * u *
             radiance(mu, azimuth);
    }
  }
  return sum;
}

TEST(Water, SlopesAreADistribution) {
  static const GaussRule rule(64);
  double worst = 0, worst_variance = 0;
  for (const double wind : kWinds_m_per_s) {
    const double variance = f64::water_slope_variance(wind);
    double whole = 0, second = 0;
    const double end = 6 * std::sqrt(variance);  // exp(-36) beyond
    for (std::size_t n = 0; n < rule.node.size(); ++n) {
      const double slope = end * rule.node[n];
      const double part = rule.weight[n] * end * 2 * pi * slope *
                          f64::water_slope_density(1 / std::hypot(1, slope), variance);
      whole += part;
      second += slope * slope * part;
    }
    worst = std::max(worst, std::abs(whole - 1));
    worst_variance = std::max(worst_variance, std::abs(second / variance - 1));
  }
  test::report_accuracy("ground", "water: integral of the slopes' density", worst, 1e-9, "1");
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(worst_variance, 1e-9);
}

// Overhead, where no wave hides another, the glint is Fresnel's part of the sun's light.
TEST(Water, GlintUnderAHighSunIsFresnels) {
  double worst = 0;
  for (const double wind : kWinds_m_per_s) {
    const double variance = f64::water_slope_variance(wind);
    const double found =
        flux([&](double mu, double azimuth) { return glint(mu, 1, azimuth, variance); });
    worst = std::max(worst, std::abs(found / f64::water_fresnel(1) - 1));
  }
  test::report_accuracy("ground", "water: glint of a sun overhead against Fresnel", worst, 0.02,
                        "relative");
  EXPECT_LE(worst, 0.02);
}

// Up to the albedo of milky water: the approximate mean of Fresnel's part is too small for a white
// body under a raking sun, where 1.01 would come back.
TEST(Water, GivesBackNoMoreThanItGets) {
  double most_sun = 0, most_sky = 0;
  for (const double wind : kWinds_m_per_s) {
    const double variance = f64::water_slope_variance(wind);
    for (const double albedo : {0.0, 0.042, 0.5}) {
      for (const double mu_sun : {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
        const double out = flux([&](double mu, double azimuth) {
          const double sine = std::sqrt((1 - mu) * (1 + mu) * (1 - mu_sun) * (1 + mu_sun));
          const double length = std::sqrt(2 * (1 + mu * mu_sun + sine * std::cos(azimuth)));
          return f64::water_radiance(albedo, 1, mu, mu_sun, (mu + mu_sun) / length, length / 2,
                                     variance, 0, 0);
        });
        most_sun = std::max(most_sun, out / mu_sun);
      }
      const double out = flux([&](double mu, double) {
        return f64::water_radiance(albedo, 0, mu, 0.5, 1, 1, variance, 1, 1);
      });
      most_sky = std::max(most_sky, out / pi);
    }
  }
  test::report_accuracy("ground", "water: part of the sun's light that comes back, at most",
                        most_sun, 1, "1");
  test::report_accuracy("ground", "water: part of an even sky's light that comes back, at most",
                        most_sky, 1, "1");
  EXPECT_LE(most_sun, 1);
  EXPECT_LE(most_sky, 1);
}

TEST(Land, GivesBackItsAlbedo) {
  for (const double albedo : {0.0, 0.12, 1.0}) {
    const auto sunlit = [&](double, double) { return f64::land_radiance(albedo, 1, 0.3, 0, 0); };
    const auto under_sky = [&](double, double) { return f64::land_radiance(albedo, 0, 0.3, 1, 1); };
    EXPECT_NEAR(flux(sunlit) / 0.3, albedo, 1e-6);
    EXPECT_NEAR(flux(under_sky) / pi, albedo, 1e-6);
  }
}

// In floats, as shaders have it.
TEST(Water, IsFiniteAtGrazingAngles) {
  for (const double wind : kWinds_m_per_s) {
    const float variance = f32::water_slope_variance(float(wind));
    for (const float mu : {0.0f, 1e-30f, 1e-8f, 1e-5f, 1e-3f, 1.0f})
      for (const float mu_sun : {-1.0f, 0.0f, 1e-30f, 1e-8f, 1e-5f, 1e-3f, 1.0f})
        for (const float cos_tilt : {-1.0f, 0.0f, 1e-20f, 1e-6f, 1e-2f, 1.0f, 1.0000001f})
          for (const float cos_half : {-1e-7f, 0.0f, 1e-7f, 0.5f, 1.0000001f}) {
            const float radiance =
                f32::water_radiance(0.05f, 1, mu, mu_sun, cos_tilt, cos_half, variance, 0.1f, 0.1f);
            ASSERT_TRUE(std::isfinite(radiance) && radiance >= 0)
                << mu << ' ' << mu_sun << ' ' << cos_tilt << ' ' << cos_half << ' ' << wind;
          }
  }
}

}  // namespace
}  // namespace nepho
