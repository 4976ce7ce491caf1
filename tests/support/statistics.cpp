#include "statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace nepho::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFewestExpected = 5;

[[noreturn]] void refuse(const char* why) {
  throw std::invalid_argument(std::string("statistics: ") + why);
}

// Both tails of a symmetric distribution; boost throws at what is not finite.
template <typename Distribution>
double two_sided(const Distribution& distribution, double statistic) {
  if (std::isnan(statistic)) return kNan;
  if (std::isinf(statistic)) return 0;
  const double tail = cdf(complement(distribution, std::abs(statistic)));
#ifdef NEPHO_MUTANT_ONE_SIDED
  return tail;
#else
  return 2 * tail;
#endif
}

double over_error(double difference, double standard_error) {
  if (standard_error < 0) refuse("a standard error is negative");
  // Exact on both sides: the same, or not.
  if (standard_error == 0 && difference == 0) return 0;
  return difference / standard_error;
}

double squared_error(const Estimate& estimate) {
  if (estimate.standard_error < 0) refuse("a standard error is negative");
  return estimate.standard_error * estimate.standard_error;
}

// Welch and Satterthwaite: the variance of a sum of two variances of means, each with its own
// degrees of freedom.
Verdict welch(double difference, double square_a, double degrees_a, double square_b,
              double degrees_b) {
  const double square = square_a + square_b;
  Verdict out{over_error(difference, std::sqrt(square)), 1};
  const double degrees =
      square * square / (square_a * square_a / degrees_a + square_b * square_b / degrees_b);
  if (square > 0 && degrees > 0)
    out.p = two_sided(boost::math::students_t(degrees), out.statistic);
  else
    out.p = two_sided(boost::math::normal(), out.statistic);  // exact on both sides, or NaN
  return out;
}

// Bins with few expected counts become one, smallest first: which bins those are does not depend
// on what was counted.
struct Bin {
  double count = 0, expected = 0;
};
std::vector<Bin> pooled(std::span<const double> counts, std::span<const double> expected) {
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  std::vector<Bin> bins;
  Bin pool;
  for (const std::size_t i : order) {
    pool.count += counts[i];
    pool.expected += expected[i];
#ifndef NEPHO_MUTANT_NO_POOLING
    if (pool.expected < kFewestExpected) continue;
#else
    if (pool.expected == 0) continue;
#endif
    bins.push_back(pool);
    pool = {};
  }
  if (!bins.empty()) {
    bins.back().count += pool.count;
    bins.back().expected += pool.expected;
  }
  return bins;
}

}  // namespace

Estimate mean_of(const MeanVariance& samples) {
#ifdef NEPHO_MUTANT_SIGMA_FOR_ERROR
  return {samples.mean(), std::sqrt(samples.variance())};
#else
  return {samples.mean(), samples.standard_error()};
#endif
}

Verdict z_test(const Estimate& measured, const Estimate& truth) {
  const double sigma = std::sqrt(squared_error(measured) + squared_error(truth));
  const double z = over_error(measured.value - truth.value, sigma);
  return {z, two_sided(boost::math::normal(), z)};
}

Verdict t_test(const MeanVariance& measured, const Estimate& truth) {
  const Estimate mean = mean_of(measured);
  return welch(mean.value - truth.value, squared_error(mean), double(measured.count()) - 1,
               squared_error(truth), kInfinity);
}

Verdict t_test(const MeanVariance& measured, const MeanVariance& truth) {
  const Estimate a = mean_of(measured), b = mean_of(truth);
  return welch(a.value - b.value, squared_error(a), double(measured.count()) - 1, squared_error(b),
               double(truth.count()) - 1);
}

double sidak(double smallest_p, std::size_t tests) {
#ifdef NEPHO_MUTANT_NO_SIDAK
  tests = 1;
#endif
  // By logarithms: 1 - (1 - p)^n loses a p of 1e-17 altogether.
  return smallest_p >= 1 ? 1 : -std::expm1(double(tests) * std::log1p(-smallest_p));
}

PixelVerdict z_per_pixel(std::span<const Estimate> measured, std::span<const Estimate> truth) {
  if (measured.empty() || measured.size() != truth.size()) refuse("pictures differ in size");
  PixelVerdict worst;
  double smallest_p = 2;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Verdict verdict = z_test(measured[i], truth[i]);
    if (std::isnan(verdict.p)) return {kNan, verdict.statistic, i};
    // By z where p has run out of range.
    if (verdict.p > smallest_p ||
        (verdict.p == smallest_p && std::abs(verdict.statistic) <= std::abs(worst.worst_z)))
      continue;
    smallest_p = verdict.p;
    worst = {0, verdict.statistic, i};
  }
  worst.p = sidak(smallest_p, measured.size());
  return worst;
}

ChiSquare chi_square(std::span<const double> counts, std::span<const double> expected,
                     std::size_t fitted) {
  if (counts.size() != expected.size()) refuse("counts and expected counts differ in number");
  double count = 0, sum = 0;
  bool impossible = false;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!(counts[i] >= 0) || !(expected[i] >= 0)) refuse("a count is negative or not a number");
    impossible = impossible || (expected[i] == 0 && counts[i] > 0);
    count += counts[i];
    sum += expected[i];
  }
  if (std::abs(count - sum) > 1e-6 * sum) refuse("counts and expected counts differ in sum");
  const std::vector<Bin> bins = pooled(counts, expected);
  if (bins.size() < fitted + 2) refuse("too few bins of 5 expected counts for a test");
  ChiSquare out;
  out.bins = bins.size();
  for (const Bin& bin : bins)
    out.statistic += (bin.count - bin.expected) * (bin.count - bin.expected) / bin.expected;
  const boost::math::chi_squared distribution(double(out.bins - 1 - fitted));
  out.p = impossible ? 0 : cdf(complement(distribution, out.statistic));
  return out;
}

Verdict kolmogorov_smirnov(std::vector<double> samples, const std::function<double(double)>& cdf) {
  if (samples.empty()) refuse("no samples");
  std::sort(samples.begin(), samples.end());
  const auto n = double(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double value = cdf(samples[i]);
    if (std::isnan(value)) return {kNan, kNan};
    distance = std::max({distance, value - double(i) / n, double(i + 1) / n - value});
  }
  const double scaled = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
  if (scaled < 0.2) return {distance, 1};  // 1 - 1e-11, where the series alternates without end
  double p = 0;
  for (int k = 1; k <= 20; ++k) p += (k % 2 ? 2 : -2) * std::exp(-2.0 * k * k * scaled * scaled);
  return {distance, std::clamp(p, 0.0, 1.0)};
}

double power(double bias, double sigma, double level) {
  if (!(sigma >= 0) || !(level > 0 && level < 1)) refuse("power of a bad sigma or level");
  const boost::math::normal normal;
  const double limit = quantile(complement(normal, level / 2));
  const double shift = std::abs(over_error(bias, sigma));
  if (std::isinf(shift)) return 1;
  return cdf(normal, shift - limit) + cdf(normal, -shift - limit);
}

double sigma_for_power(double bias, double wanted_power, double level) {
  if (!(wanted_power > level && wanted_power < 1) || bias == 0) refuse("no such power");
  // Power falls with sigma; halve the interval of bias / sigma.
  double low = 0, high = 60;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (power(middle, 1, level) < wanted_power ? low : high) = middle;
  }
  return std::abs(bias) / high;
}

}  // namespace nepho::test
