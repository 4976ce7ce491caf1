#include "sources/noise/normal.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nepho::noise {
double exp_minus(double x) {
  if (!(x < 700)) return 0;
  // exp(-x) = 2^-n exp(-r), |r| <= ln 2 / 2; ln 2 in two parts, so that n ln 2 is exact.
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = -((x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10);
  double term = 1;
  for (int k = 13; k > 0; --k) term = 1 + r * term / k;
  return term * std::bit_cast<double>(std::uint64_t(1023 - std::int64_t(n)) << 52);
}

double normal_density(double x) {
  return 0.3989422804014327 * exp_minus(0.5 * x * x);
}

double normal_cdf(double x) {
  const double z = std::abs(x) * 0.7071067811865476, t = 1 / (1 + 0.5 * z);
  constexpr double c[] = {-1.26551223, 1.00002368,  0.37409196, 0.09678418,  -0.18628806,
                          0.27886807,  -1.13520398, 1.48851587, -0.82215223, 0.17087277};
  double sum = 0;
  for (int k = 9; k >= 0; --k) sum = c[k] + t * sum;
  // exp(sum) with sum in [-1.27, 0]
  const double tail = 0.5 * t * exp_minus(z * z - sum);
  return x > 0 ? 1 - tail : tail;
}

double normal_quantile(double p) {
  double low = -9, high = 9;
  while (high - low > 1e-13) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double tan_quarter_turn(double s) {
  const double a = std::abs(s);
  if (a == 1) return s;
  // tan x = x / (1 - x^2/(3 - x^2/(5 - ...))) (Lambert), x in [0, pi/4].
  const double x = 0.78539816339744831 * a, square = x * x;
  double denominator = 21;
  for (int odd = 19; odd > 0; odd -= 2) denominator = odd - square / denominator;
  return std::copysign(x / denominator, s);
}

glm::dvec2 cosine_sine(double angle_rad) {
  constexpr double kTurn = 6.2831853071795865;
  const double x = (angle_rad - kTurn * std::floor(angle_rad / kTurn + 0.5)) / 8;  // |x| < 0.4
  double sine = 1, cosine = 1;
  for (int k = 17; k > 1; k -= 2) sine = 1 - sine * x * x / (k * (k - 1));
  for (int k = 16; k > 0; k -= 2) cosine = 1 - cosine * x * x / (k * (k - 1));
  glm::dvec2 at = {cosine, x * sine};
  for (int doubling = 0; doubling < 3; ++doubling)
    at = {at.x * at.x - at.y * at.y, 2 * at.x * at.y};
  return at;
}

Moments expected_excess(double m, double s) {
#ifdef NEPHO_MUTANT_CLOSURE
  s = 0;  // octaves beyond Nyquist are dropped rather than replaced by their expectation
#endif
  if (!(s > 0)) return {std::max(m, 0.0), std::max(m, 0.0) * std::max(m, 0.0)};
  const double x = m / s;
  if (x <= -kTail) return {};
  if (x >= 2 * kTail) return {m, m * m + s * s};
  const double phi = normal_density(x), below = normal_cdf(x);
  return {m * below + s * phi, (m * m + s * s) * below + m * s * phi};
}

}  // namespace nepho::noise
