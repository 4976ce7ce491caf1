#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace nepho::noise {

// The functions behind the closure, from + - * / and sqrt only: a C library's own differ in the
// last bits between machines, and every brick hangs on them. Compiled with -ffp-contract=off.

// exp(-x) for x >= 0; relative error <= 4e-16 x + 1e-15, 0 beyond 700.
double exp_minus(double x);

// Distribution and density of the standard normal. Relative error of the tail <= 1.3e-7
// (Numerical Recipes, 3rd ed., 6.2: erfc as a Chebyshev fit of its logarithm).
double normal_cdf(double x);
double normal_density(double x);
// Inverse of normal_cdf for 0 < p < 1, to 1e-12, by bisection: for tables, not for samples.
double normal_quantile(double p);

// tan(pi/4 s) for s in [-1, 1]: odd, exactly -1, 0, 1 at -1, 0, 1; relative error <= 1e-15.
double tan_quarter_turn(double s);

// cos and sin of any angle below 1e6 rad; error <= 1e-15 + 1.2e-16 of the angle.
glm::dvec2 cosine_sine(double angle_rad);

// floor() without a call, for |x| < 2^31.
inline std::int32_t floor_to_int(double x) {
  const auto whole = std::int32_t(x);
  return whole - (double(whole) > x);
}

// Beyond so many standard deviations the closure ends at an exact zero (E max(0, Z - 4) = 7e-6),
// and noise is clipped.
inline constexpr double kTail = 4.0;

// E max(0, m + s Z) = m Phi(m/s) + s phi(m/s) and E max(0, m + s Z)^2, Z standard normal
// (docs/lattice.md 2, "Procedural"). s = 0: without expectation. Exactly 0 where m <= -kTail s.
struct Moments {
  double mean = 0, square = 0;
};
Moments expected_excess(double m, double s);

}  // namespace nepho::noise
