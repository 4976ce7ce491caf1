#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/accumulator.h"

namespace nepho::test {

// Whether a measured number agrees with a truth that has an error bar of its own. Every p is
// two-sided: the chance of a difference at least this large, either way, where both agree. Tests
// accept at p > kAccept. What is not a number is not accepted: its p is NaN.
inline constexpr double kAccept = 1e-3;

struct Estimate {
  double value = 0;
  double standard_error = 0;  // of the value, not of one sample; 0: exact
};
// The mean of independent samples; of fewer than two the standard error is NaN.
Estimate mean_of(const MeanVariance& samples);

struct Verdict {
  double statistic = 0;
  double p = 1;
};
// Difference over sigma, sigma^2 = measured^2 + truth^2; for standard errors that are known well
// (some hundred samples). Where both are exact, p is 1 or 0.
// All of these throw std::invalid_argument for a negative standard error.
Verdict z_test(const Estimate& measured, const Estimate& truth);
// The same where few samples leave the standard error in doubt: Student's t, with the degrees of
// freedom of Welch (1947, doi:10.1093/biomet/34.1-2.28).
Verdict t_test(const MeanVariance& measured, const Estimate& truth);
Verdict t_test(const MeanVariance& measured, const MeanVariance& truth);

// The chance that the smallest of `tests` independent p is at most this one: 1 - (1 - p)^tests
// (Sidak 1967, doi:10.1080/01621459.1967.10482935).
double sidak(double smallest_p, std::size_t tests);

struct PixelVerdict {
  double p = 1;  // of the worst pixel, after Sidak's correction for all of them
  double worst_z = 0;
  std::size_t worst_pixel = 0;
};
// z at each pixel. Blind to a small bias of the whole picture: test its mean as well. Throws
// std::invalid_argument where the sizes differ or are 0.
PixelVerdict z_per_pixel(std::span<const Estimate> measured, std::span<const Estimate> truth);

struct ChiSquare {
  double statistic = 0, p = 1;
  std::size_t bins = 0;  // after pooling
};
// Pearson's goodness of fit: counts against expected counts, which must have the same sum (to
// 1e-6). Bins of fewer than 5 expected counts are pooled, smallest first, until each holds 5
// (Cochran 1954, doi:10.2307/3001666). A count where none can be (expected 0) makes p 0.
// `fitted` parameters of the expectation came from the same counts. Throws std::invalid_argument
// for different sizes or sums, negative numbers, and too few bins to have a degree of freedom.
ChiSquare chi_square(std::span<const double> counts, std::span<const double> expected,
                     std::size_t fitted = 0);

// Largest distance between the samples' distribution and `cdf` (continuous); its p by Stephens'
// form of Kolmogorov's series (1970, doi:10.1111/j.2517-6161.1970.tb00821.x), within 0.002 from 10
// samples on. Throws std::invalid_argument without samples.
Verdict kolmogorov_smirnov(std::vector<double> samples, const std::function<double(double)>& cdf);

// The chance that z_test rejects (p <= level) where the truth is off by `bias` and the difference
// has the standard error `sigma`, both in the same unit or both relative.
double power(double bias, double sigma, double level = kAccept);
// The largest sigma at which a bias is caught with this power, which must be above `level`.
double sigma_for_power(double bias, double wanted_power, double level = kAccept);

}  // namespace nepho::test
