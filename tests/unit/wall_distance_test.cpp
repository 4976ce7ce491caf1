#include "bricks/wall_distance.h"

#include <gtest/gtest.h>

#include <numbers>

#include "random.h"

namespace nepho::test {
namespace {

using std::numbers::pi;
constexpr double kRadius_m = 6378137;
constexpr double kEps = std::numeric_limits<float>::epsilon() / 2;

struct WorstError {
  double head_on = 0;       // relative, of rays whose own condition number is below 3
  double relative = 0;      // the same below 10
  double in_eps_kappa = 0;  // of all rays, over (float's eps * condition number)
  int rays = 0;
  void add(double got, double truth, double condition) {
    const double error = std::abs(got / truth - 1);
    ++rays;
    if (condition < 3) head_on = std::max(head_on, error);
    if (condition < 10) relative = std::max(relative, error);
    in_eps_kappa = std::max(in_eps_kappa, error / (kEps * condition));
  }
};

TEST(WallDistance, AngularWallsInFloat) {
  Random random;
  WorstError worst, floor_index;
  double naive_m = 0;
  for (int trial = 0; trial < 1000000; ++trial) {
    const std::int32_t n = 8 << random.integer(0, 20);
    const double spacing = pi / 2 / n;
    const double rho =
        kRadius_m * random.uniform(0.7, 1) +
        (random.integer(0, 3) ? random.uniform(0, 4e4) : random.log_uniform(4e4, 4e7));
    const double camera = random.uniform(0, n);
    const glm::dvec3 d = random.direction();
    const float radial = float(d.x), tangential = float(d.y);
    // A wall near the point that the ray reaches at a random distance.
    const double reach = random.log_uniform(1.7, 1e7);
    const double at = std::atan2(reach * tangential, rho + reach * radial) / spacing + camera;
    const auto wall = std::int32_t(at + (at > camera ? 1 : 0));
    // Truth: the plane through the axis, in extended precision.
    const long double w =
        ((long double)wall - n / 2.0L) * (std::numbers::pi_v<long double> / 2 / n);
    const long double a =
        ((long double)camera - n / 2.0L) * (std::numbers::pi_v<long double> / 2 / n);
    const long double dx = radial * cosl(a) - tangential * sinl(a);
    const long double dy = radial * sinl(a) + tangential * cosl(a);
    const long double ox = rho * cosl(a), oy = rho * sinl(a);
    const long double across = dy * cosl(w) - dx * sinl(w);
    const double truth = double((ox * sinl(w) - oy * cosl(w)) / across);
    const bool ahead = (ox + truth * dx) * cosl(w) + (oy + truth * dy) * sinl(w) > 0;
    if (!ahead || truth < 1.7 || truth > 1e7) continue;
    const double delta = double(w - a);
    const double condition =
        1 + (std::abs(tangential * std::cos(delta)) + std::abs(radial * std::sin(delta)) +
             std::abs(tangential * delta / std::sin(delta))) /
                std::abs(double(across));
    const WallFrame frame = make_wall_frame(rho, camera, spacing);
    worst.add(angular_wall_distance_m(frame, wall, radial, tangential), truth, condition);
    const double below = std::floor(camera);
    const WallFrame fraction = {float(rho), std::int32_t(below), float(camera - below),
                                float(spacing)};
    floor_index.add(angular_wall_distance_m(fraction, wall, radial, tangential), truth, condition);
    const float nx = float(-std::sin(double(w))), ny = float(std::cos(double(w)));
    const float naive = -(nx * float(ox) + ny * float(oy)) / (nx * float(dx) + ny * float(dy));
    if (truth < 1e4 && condition < 10)
      naive_m = std::max(naive_m, std::abs(double((naive - truth) * across)));
  }
  std::printf(
      "measured: angular walls, %d rays: worst relative %.2e (condition < 3), %.2e (< 10),"
      " %.2f eps kappa; floor index %.2e; plane equation in float %.2f m off\n",
      worst.rays, worst.head_on, worst.relative, worst.in_eps_kappa, floor_index.relative, naive_m);
  EXPECT_GT(worst.rays, 400000);
  EXPECT_LE(worst.in_eps_kappa, 4);
  EXPECT_GT(floor_index.relative, 10 * worst.relative);
}

TEST(WallDistance, SinCosIsRelative) {
  double worst_sin = 0, worst_cos = 0;
  for (double x = 1e-9; x < pi; x *= 1.0001) {
    const auto [s, c] = sin_cos(float(x));
    if (x < pi / 2) worst_sin = std::max(worst_sin, std::abs(s / std::sin(double(float(x))) - 1));
    worst_cos = std::max(worst_cos, std::abs(c - std::cos(double(float(x)))));
  }
  std::printf("measured: sin relative %.2e, cos absolute %.2e\n", worst_sin, worst_cos);
  EXPECT_LE(worst_sin, 3e-7);
  EXPECT_LE(worst_cos, 6e-7);
}

TEST(WallDistance, SpheresInFloat) {
  Random random;
  WorstError worst, rounded_height;
  for (int trial = 0; trial < 1000000; ++trial) {
    const std::int32_t n = 8 << random.integer(0, 16);
    const double spacing = 40000.0 / n;
    const double camera =
        random.integer(0, 3) ? random.uniform(0, n) : random.uniform(n, 1000.0 * n);
    const double r0 = kRadius_m + camera * spacing;
    const auto wall = std::int32_t(
        random.integer(0, 1) ? random.integer(0, n)
                             : std::nearbyint(std::min<double>(camera, n)) + random.integer(-2, 2));
    const float mu = float(random.integer(0, 1)
                               ? random.uniform(-1, 1)
                               : std::copysign(random.log_uniform(1e-6, 1), random.uniform(-1, 1)));
    const long double dh = ((long double)camera - wall) * spacing;
    const long double b = (long double)r0 * mu, product = dh * (2 * (long double)r0 - dh);
    const long double discriminant = b * b - product;
    if (discriminant <= 0) continue;
    const double condition = 1 + double((b * b + fabsl(product)) / discriminant);
    const long double q = -(b + copysignl(sqrtl(discriminant), b));
    const auto check = [&](WorstError& error, const Hits& hits) {
      for (const long double t : {q, product / q}) {
        if (t < 1.7 || t > 1e7) continue;
        const double got = std::abs(hits.near - t) < std::abs(hits.far - t) ? hits.near : hits.far;
        error.add(got, double(t), condition);
      }
    };
    check(worst, sphere_wall_distances_m(make_wall_frame(r0, camera, spacing), wall, mu));
    // Mutant: both altitudes as floats.
    const float drop = float(camera * spacing) - float(wall * spacing);
    check(rounded_height, sphere_wall_distances_m({float(r0), 0, drop, 1.0f}, 0, mu));
  }
  std::printf(
      "measured: spheres, %d hits: worst relative %.2e (condition < 3), %.2e (< 10), %.2f eps "
      "kappa; "
      "altitudes as floats %.2e\n",
      worst.rays, worst.head_on, worst.relative, worst.in_eps_kappa, rounded_height.relative);
  EXPECT_LE(worst.in_eps_kappa, 4);
  EXPECT_GT(rounded_height.relative, 10 * worst.relative);
}

}  // namespace
}  // namespace nepho::test
