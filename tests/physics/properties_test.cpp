// What must hold of the shared equations beyond single values: norms, limits, ends of the range.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "accuracy_report.h"
#include "physics/physics_cpp.h"

namespace nepho::test {
namespace {

using std::numbers::pi;

// Midpoint rule in theta = pi v^3, dense in the forward peak: integral and mean cosine.
template <typename PhaseFunction>
std::pair<double, double> moments(PhaseFunction phase) {
  const int steps = 100000;
  double sum = 0, first = 0;
  for (int i = 0; i < steps; ++i) {
    const double v = (i + 0.5) / steps, theta = pi * v * v * v, sine = std::sin(theta / 2);
    const double part = phase(2 * sine * sine) * 2 * pi * std::sin(theta) * 3 * pi * v * v / steps;
    sum += part;
    first += part * std::cos(theta);
  }
  return {sum, first / sum};
}

TEST(PhaseFunctions, IntegrateToOneWithTheirAsymmetry) {
  double norm = 0, asymmetry = 0;
  for (const double g : {0.0, 0.3, -0.5, 0.85, 0.99, 0.999}) {
    const auto [sum, mean] = moments([&](double x) { return f64::hg_phase(x, g); });
    norm = std::max(norm, std::abs(sum - 1));
    asymmetry = std::max(asymmetry, std::abs(mean - g));
    const auto [cs_sum, cs_mean] =
        moments([&](double x) { return f64::cornette_shanks_phase(x, g); });
    norm = std::max(norm, std::abs(cs_sum - 1));
    asymmetry = std::max(asymmetry, std::abs(cs_mean - 3 * g * (4 + g * g) / (5 * (2 + g * g))));
  }
  const auto [sum, mean] = moments([](double x) { return f64::rayleigh_phase(x); });
  norm = std::max(norm, std::abs(sum - 1));
  asymmetry = std::max(asymmetry, std::abs(mean));
  report_accuracy("phase functions", "norm of HG, Cornette-Shanks, Rayleigh", norm, 1e-6, "1");
  report_accuracy("phase functions", "mean cosine of the same", asymmetry, 1e-6, "1");
  EXPECT_LE(norm, 1e-6);
  EXPECT_LE(asymmetry, 1e-6);
}

TEST(Transport, EndsOfTheRange) {
  EXPECT_EQ(f32::exp_e0(0), 1);
  EXPECT_EQ(f32::exp_w1(0), 0.5f);
  EXPECT_EQ(f32::step_radiance(1, 2, 0), 0);
  // A thick step shows its near end, and nothing overflows.
  EXPECT_NEAR(f32::step_radiance(3, 7, 1e8f), 3, 1e-5);
  EXPECT_TRUE(std::isfinite(f32::step_radiance(1, 1, 1e38f)));
  // Both branches meet: the series' last value against the quotient's first.
  const float below = std::nextafter(1.0f, 0.0f);
  EXPECT_NEAR(f32::exp_e0(below) / f32::exp_e0(1), 1, 3e-7);
  EXPECT_NEAR(f32::exp_w1(below) / f32::exp_w1(1), 1, 6e-7);
}

TEST(Transport, StepsAreExactForALinearSource) {
  // Any cut of a uniform cell into steps gives the same light, whatever their depth.
  const double tau = 7, s0 = 0.2, s1 = 1.7, whole = f64::step_radiance(s0, s1, tau);
  for (const int steps : {2, 10, 1000}) {
    double light = 0, transmittance = 1;
    for (int i = 0; i < steps; ++i) {
      const double a = s0 + (s1 - s0) * i / steps, b = s0 + (s1 - s0) * (i + 1) / steps;
      light += transmittance * f64::step_radiance(a, b, tau / steps);
      transmittance *= std::exp(-tau / steps);
    }
    EXPECT_NEAR(light / whole, 1, 1e-8);
  }
}

TEST(Walls, EndsOfTheRange) {
  EXPECT_EQ(f32::arc_tangent(0, 0), 0);
  EXPECT_EQ(f32::arc_tangent(0, -1), float(pi));
  EXPECT_EQ(f32::arc_tangent(1, 0), float(pi / 2));
  float first = 0, second = 0;
  // On the sphere, looking up: here, and at the antipode behind.
  f32::sphere_wall_distances(6.4e6f, 0, 0.5f, first, second);
  EXPECT_EQ(first, -6.4e6f);
  EXPECT_EQ(second, 0);
  // From above, looking away: both behind. Looking past: none.
  f32::sphere_wall_distances(6.4e6f, 1000, 0.5f, first, second);
  EXPECT_LT(second, 0);
  f32::sphere_wall_distances(6.4e6f, 1000, 0, first, second);
  EXPECT_EQ(first, f32::no_hit());
  EXPECT_EQ(second, f32::no_hit());
  // Tangential from on the sphere: touches where it stands.
  f32::sphere_wall_distances(6.4e6f, 0, 0, first, second);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 0);
  // Along the wall, on it and beside it.
  const float scale = f32::box_spacing_over_direction(1, 0);
  EXPECT_EQ(f32::box_wall_distance(5, 5, 0, scale), f32::no_hit());
  EXPECT_EQ(f32::box_wall_distance(9, 5, 0, scale), f32::no_hit());
  EXPECT_EQ(f32::box_wall_distance(9, 5, 0, f32::box_spacing_over_direction(1, 1e-44f)),
            f32::no_hit());
  EXPECT_EQ(f32::angular_wall_distance(6.4e6f, 0.1f, 1, std::tan(0.1f)) > 0, true);
  EXPECT_EQ(f32::angular_wall_distance(6.4e6f, 0, 1, 0), f32::no_hit());
}

// Against both spheres in double: the same wall, and its height as good as a float of the layer's
// thickness and of the way there.
TEST(Walls, AheadInALayer) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> part(0, 1);
  double worst = 0;
  int lower_ones = 0, missed = 0;
  for (int n = 0; n < 20000; ++n) {
    const float radius = 6.36e6f + 4e4f * part(random), thickness = 200 + 16000 * part(random);
    const float above_low = thickness * part(random), above_high = above_low - thickness;
    const float mu = 0.2f * (part(random) - 0.5f) * (n % 3 == 0 ? 1.0f : 0.1f);
    float distance = 0;
    bool lower = false;
    f32::layer_wall_distance(radius, above_low, above_high, mu, mu < 0, distance, lower);
    double near = 0, far = 0, high_near = 0, high_far = 0;
    f64::sphere_wall_distances(radius, above_low, mu, near, far);
    f64::sphere_wall_distances(radius, above_high, mu, high_near, high_far);
    const bool expected = mu < 0 && near < f64::no_hit();
    ASSERT_EQ(lower, expected) << radius << ' ' << above_low << ' ' << mu;
    lower_ones += lower;
    missed += mu < 0 && !lower;
    const double wall = lower ? -above_low : -above_high;
    ASSERT_LT(distance, 2e6f);
    const double t = distance, off = f64::height_along_ray(radius, t, mu) - wall;
    const double slope = std::abs((double(radius) * mu + t) / radius);
    worst = std::max(worst, std::abs(off) / (thickness + t * slope));
  }
  EXPECT_GT(lower_ones, 1000);
  EXPECT_GT(missed, 1000);
  EXPECT_LT(worst, 3e-7);
}

// Places along a ray through a leaf, in its cells, against the arc tangent.
TEST(Walls, ParabolaOfAnAngle) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> part(0, 1);
  for (const double leaf_rad : {0.1, 0.03}) {
    double worst = 0;
    for (int n = 0; n < 5000; ++n) {
      const double turn = 2 * std::numbers::pi * part(random), level = 0.2 + 0.8 * part(random);
      const double radial = level * std::cos(turn), tangential = level * std::sin(turn);
      const double t = 0.3 * part(random);
      const double reach = 0.5 * leaf_rad * std::hypot(1 + t * radial, t * tangential);
      const double middle = f64::angle_along_ray(1, t, radial, tangential);
      const auto away = [&](double u) {
        return f64::angle_along_ray(1, t + u, radial, tangential) - middle;
      };
      if (std::abs(away(reach) - away(-reach)) > leaf_rad) continue;
      double rise = 0, fade = 0;
      f64::angle_growth_along_ray(1, t, radial, tangential, reach, rise, fade);
      for (double u = -reach; u <= reach; u += 0.125 * reach)
        worst = std::max(worst, std::abs(rise * u * (1 - fade * u) - away(u)) * 8 / leaf_rad);
    }
    EXPECT_LT(worst, 0.2 * leaf_rad * leaf_rad);
    EXPECT_GT(worst, 0.02 * leaf_rad * leaf_rad);
  }
}

TEST(Sky, IsContinuousAndReachesItsThreeColours) {
  const double zenith = 3, horizon = 7, below = 1;
  EXPECT_EQ(f64::sky_radiance(1, zenith, horizon, below), zenith);
  EXPECT_EQ(f64::sky_radiance(0, zenith, horizon, below), horizon);
  EXPECT_EQ(f64::sky_radiance(-1, zenith, horizon, below), below);
  double last = zenith;
  for (double s = 1; s >= -1; s -= 1e-4) {
    const double now = f64::sky_radiance(s, zenith, horizon, below);
    EXPECT_LE(std::abs(now - last), 0.02);  // the steepest: 1.5 * 6 / 0.052 * 1e-4
    last = now;
  }
  // A white world stays white, whatever part of it is seen from where.
  EXPECT_NEAR(f64::sky_source(1, 1, 1, 2, 2, 2), 2, 1e-15);
}

TEST(Tone, IsMonotoneAndFiniteOverFortyStops) {
  float last = -1;
  for (float stop = -20; stop <= 20; stop += 0.25f) {
    float r = 0, g = 0, b = 0;
    const float light = std::exp2(stop);
    f32::aces_tone(light, light, light, r, g, b);
    for (const float shown : {r, g, b}) {
      EXPECT_GE(shown, 0);
      EXPECT_LE(shown, 1);
    }
    EXPECT_GE(g, last);
    EXPECT_NEAR(r, g, 2e-4);  // grey stays grey: the rows of Hill's matrices sum to 1
    last = g;
  }
  EXPECT_GT(last, 0.99f);
  float r = 0, g = 0, b = 0;
  f32::aces_tone(std::numeric_limits<float>::max(), 0, -1, r, g, b);
  EXPECT_TRUE(std::isfinite(r) && std::isfinite(g) && std::isfinite(b));
  EXPECT_EQ(f32::srgb_encode(0), 0);
  EXPECT_NEAR(f32::srgb_encode(1), 1, 1e-6);
  EXPECT_NEAR(f32::srgb_encode(0.5f), 0.735357, 1e-6);
  EXPECT_NEAR(f64::luminance(1, 1, 1), 1, 1e-15);
}

}  // namespace
}  // namespace nepho::test
