#include "statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "accuracy_report.h"

namespace nepho::test {
namespace {

using Generator = std::mt19937_64;

MeanVariance draw(Generator& random, int count, double mean, double sigma) {
  std::normal_distribution<double> normal(mean, sigma);
  MeanVariance out;
  for (int i = 0; i < count; ++i) out.add(normal(random));
  return out;
}

// Two values a each side of the mean: the mean and the variance are what is asked for.
MeanVariance samples_with(int count, double mean, double variance) {
  MeanVariance out;
  const double apart = std::sqrt(variance * (count - 1) / count);
  for (int i = 0; i < count; ++i) out.add(mean + (i % 2 ? apart : -apart));
  return out;
}

// Tables of any textbook: the two-sided points of 5 % and 0.1 %.
TEST(Statistics, z_and_t_are_those_of_the_tables) {
  EXPECT_NEAR(z_test({1.959964, 1}, {0, 0}).p, 0.05, 1e-7);
  EXPECT_NEAR(z_test({0, 0}, {3.290527, 1}).p, 0.001, 1e-8);
  EXPECT_NEAR(z_test({0, 0}, {3.290527, 1}).statistic, -3.290527, 1e-12);
  // 3-4-5: both errors count.
  EXPECT_NEAR(z_test({5 * 1.959964, 3}, {0, 4}).p, 0.05, 1e-7);
  EXPECT_NEAR(t_test(samples_with(6, 4.032143, 6), {0, 0}).p, 0.01, 1e-6);  // 5 degrees
  EXPECT_NEAR(t_test(samples_with(6, 6.868827, 6), {0, 0}).p, 0.001, 1e-7);
  // Two sets alike have the degrees of both: 10.
  EXPECT_NEAR(t_test(samples_with(6, 2.228139, 3), samples_with(6, 0, 3)).p, 0.05, 1e-6);
  // An exact second one leaves the first's.
  EXPECT_NEAR(t_test(samples_with(6, 4.032143, 6), samples_with(100, 0, 0)).p, 0.01, 1e-6);
  // A truth's error, taken as known, adds degrees: 5 (1 + 1)^2 / 1 = 20.
  EXPECT_NEAR(t_test(samples_with(6, std::sqrt(2) * 2.085963, 6), {0, 1}).p, 0.05, 1e-6);
  // The far tail, where 1 - (1 - p) has no digits: 2 (1 - Phi(10)).
  EXPECT_NEAR(z_test({10, 1}, {0, 0}).p / 1.523970604832e-23, 1, 1e-6);
}

TEST(Statistics, exact_numbers_are_equal_or_not_and_nan_is_never_accepted) {
  EXPECT_EQ(z_test({2, 0}, {2, 0}).p, 1);
  EXPECT_EQ(z_test({2, 0}, {2.0000001, 0}).p, 0);
  EXPECT_EQ(t_test(samples_with(6, 2, 0), {3, 0}).p, 0);
  EXPECT_EQ(t_test(samples_with(6, 2, 0), {2, 0}).p, 1);
  EXPECT_FALSE(z_test({NAN, 1}, {0, 0}).p > kAccept);
  EXPECT_FALSE(z_test({0, NAN}, {0, 0}).p > kAccept);
  MeanVariance single;
  single.add(2);
  EXPECT_FALSE(t_test(single, {2, 0}).p > kAccept);
  EXPECT_FALSE(z_test(mean_of(single), {2, 0}).p > kAccept);
  EXPECT_THROW(z_test({0, -1}, {0, 0}), std::invalid_argument);
}

// Mendel's 556 peas (1866), 9:3:3:1: Fisher's chi^2 of 0.470.
TEST(Statistics, chi_square_is_that_of_mendels_peas) {
  const double counts[] = {315, 101, 108, 32}, expected[] = {312.75, 104.25, 104.25, 34.75};
  const ChiSquare peas = chi_square(counts, expected);
  EXPECT_EQ(peas.bins, 4u);
  EXPECT_NEAR(peas.statistic, 0.470024, 1e-6);
  EXPECT_NEAR(peas.p, 0.925426, 1e-6);
  // 3 degrees reach 0.1 % at 16.266236.
  const double even[] = {100, 100, 100, 100}, d = std::sqrt(16.266236 * 100 / 4);
  EXPECT_NEAR(chi_square(std::vector{100 + d, 100 - d, 100 + d, 100 - d}, even).p, 1e-3, 1e-9);
  // A parameter that was fitted takes a degree: 2 degrees are exp(-x / 2).
  EXPECT_NEAR(chi_square(std::vector{110.0, 90.0, 100.0, 100.0}, even, 1).p, std::exp(-1), 1e-12);
}

TEST(Statistics, small_bins_are_pooled_and_none_is_lost) {
  // 1 + 2 + 3 become one bin of 6, 4 + 10 another: 9 counts against 6, 11 against 14, 20
  // against 20.
  const double expected[] = {10, 1, 2, 20, 3, 4}, counts[] = {8, 2, 3, 20, 4, 3};
  const ChiSquare found = chi_square(counts, expected);
  EXPECT_EQ(found.bins, 3u);
  EXPECT_NEAR(found.statistic, 9.0 / 6 + 9.0 / 14, 1e-12);
  EXPECT_NEAR(found.p, std::exp(-found.statistic / 2), 1e-12);
  // What is left over goes to the last bin.
  const double rest[] = {2, 2, 2, 2, 2, 2, 2}, same[] = {1, 3, 1, 3, 3, 1, 2};
  EXPECT_EQ(chi_square(same, rest).bins, 2u);
  EXPECT_NEAR(chi_square(same, rest).statistic, 1.0 / 6 + 1.0 / 8, 1e-12);
}

TEST(Statistics, what_cannot_be_is_rejected_in_any_pool) {
  const double expected[] = {1000, 1000, 0}, counts[] = {1000, 999, 1};
  EXPECT_EQ(chi_square(counts, expected).p, 0);
}

TEST(Statistics, counts_that_are_no_test_are_refused) {
  const auto test = [](std::vector<double> counts, std::vector<double> expected,
                       std::size_t fitted = 0) { chi_square(counts, expected, fitted); };
  EXPECT_THROW(test({10, 10}, {20}), std::invalid_argument);
  EXPECT_THROW(test({10, 10}, {10, 11}), std::invalid_argument);
  EXPECT_THROW(test({-1, 21}, {10, 10}), std::invalid_argument);
  EXPECT_THROW(test({10, 10}, {NAN, 10}), std::invalid_argument);
  EXPECT_THROW(test({2, 2}, {2, 2}), std::invalid_argument);
  EXPECT_THROW(test({10, 10}, {10, 10}, 1), std::invalid_argument);
  EXPECT_THROW(z_per_pixel({}, {}), std::invalid_argument);
  EXPECT_THROW(kolmogorov_smirnov({}, [](double x) { return x; }), std::invalid_argument);
}

// Exact 5 % points of the largest distance (Massey 1951, doi:10.2307/2280095, to the digits of
// later tables), met by evenly spaced samples that are shifted.
TEST(Statistics, largest_distances_are_those_of_the_tables) {
  double worst = 0;
  for (const auto& [count, distance] : {std::pair{10, 0.40925}, {20, 0.29408}, {100, 0.13403}}) {
    std::vector<double> samples;
    for (int i = 0; i < count; ++i) samples.push_back(std::max(0.0, (i + 1.0) / count - distance));
    const Verdict found = kolmogorov_smirnov(samples, [](double x) { return x; });
    EXPECT_NEAR(found.statistic, distance, 1e-12) << count;
    EXPECT_NEAR(found.p, 0.05, 0.002) << count;
    worst = std::max(worst, std::abs(found.p - 0.05));
  }
  report_accuracy("statistics", "p of Kolmogorov-Smirnov at exact 5 % points, 10 to 100 samples",
                  worst, 0.002, "1");
}

TEST(Statistics, worst_of_many_pixels_is_corrected_for_their_number) {
  EXPECT_NEAR(sidak(0.05, 1), 0.05, 1e-15);
  EXPECT_NEAR(sidak(0.05, 2), 0.0975, 1e-15);
  EXPECT_NEAR(sidak(1e-20, 1000) / 1e-17, 1, 1e-12);  // Bonferroni's where p is small
  EXPECT_EQ(sidak(1, 10), 1);
  std::vector<Estimate> measured(1000, {1, 0.1}), truth(1000, {1, 0});
  measured[417].value = 1 - 0.45;
  const PixelVerdict found = z_per_pixel(measured, truth);
  EXPECT_EQ(found.worst_pixel, 417u);
  EXPECT_NEAR(found.worst_z, -4.5, 1e-12);
  EXPECT_NEAR(found.p, 1 - std::pow(1 - 6.795346e-6, 1000), 1e-8);
  measured[3].standard_error = NAN;
  EXPECT_FALSE(z_per_pixel(measured, truth).p > kAccept);
  // Of pixels whose p is 0 the farthest off is the worst.
  measured[3].standard_error = 1e-3;
  measured[3].value = 2;
  measured[5] = {3, 1e-3};
  EXPECT_EQ(z_per_pixel(measured, truth).worst_pixel, 5u);
}

// If a test is right, its p is uniform where nothing is wrong: then "p > 1e-3" fails once in a
// thousand, not more and not less.
TEST(Statistics, p_is_uniform_where_all_is_well) {
  Generator random(20);
  std::vector<double> z, t, two, pixels, chi, distance;
  const std::vector<double> shares = {0.4, 0.3, 0.15, 0.1, 0.03, 0.01, 0.006, 0.003, 0.001};
  std::discrete_distribution<std::size_t> bin(shares.begin(), shares.end());
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const double truth = 3 + 0.05 * normal(random);  // known with an error of its own
    z.push_back(z_test(mean_of(draw(random, 400, 3, 1)), {truth, 0.05}).p);
    t.push_back(t_test(draw(random, 4, 3, 2), {3, 0}).p);
    two.push_back(t_test(draw(random, 6, 3, 2), draw(random, 8, 3, 1)).p);
    std::vector<Estimate> picture(50), reference(50, {1, 0.5});
    for (Estimate& pixel : picture) pixel = {1 + std::hypot(0.5, 1.2) * normal(random), 1.2};
    pixels.push_back(z_per_pixel(picture, reference).p);
    std::vector<double> counts(shares.size()), expected = shares, samples(30);
    for (int draws = 0; draws < 1000; ++draws) ++counts[bin(random)];
    for (double& share : expected) share *= 1000;
    chi.push_back(chi_square(counts, expected).p);
    for (double& sample : samples) sample = std::uniform_real_distribution<double>()(random);
    distance.push_back(kolmogorov_smirnov(samples, [](double x) { return x; }).p);
  }
  const auto uniform = [](std::vector<double> p) {
    return kolmogorov_smirnov(std::move(p), [](double x) { return x; }).p;
  };
  EXPECT_GT(uniform(z), kAccept) << "not uniform: z of means";
  EXPECT_GT(uniform(t), kAccept) << "not uniform: t of four samples";
  EXPECT_GT(uniform(two), kAccept) << "not uniform: t of two sets";
  EXPECT_GT(uniform(pixels), kAccept) << "not uniform: worst of the pixels";
  EXPECT_GT(uniform(chi), kAccept) << "not uniform: chi square";
  EXPECT_GT(uniform(distance), kAccept) << "not uniform: largest distance";
}

TEST(Statistics, power_is_that_of_the_tables) {
  // The textbook's 80 % at 5 %: 1.959964 + 0.841621 standard errors.
  EXPECT_NEAR(power(2.801585, 1, 0.05), 0.8, 1e-6);
  EXPECT_NEAR(power(-2.801585, 1, 0.05), 0.8, 1e-6);
  EXPECT_NEAR(power(0, 1, 0.05), 0.05, 1e-12);  // without a bias, all that is rejected is false
  EXPECT_EQ(power(0.02, 0), 1);
  EXPECT_NEAR(power(0.02, 0.02 / 3.290527), 0.5, 1e-6);
  // A bias of 2 % is caught 99 times of 100 by an error of 0.356 %.
  const double sigma = sigma_for_power(0.02, 0.99);
  EXPECT_NEAR(sigma, 0.02 / (3.290527 + 2.326348), 1e-8);
  EXPECT_NEAR(power(0.02, sigma), 0.99, 1e-9);
  EXPECT_THROW(sigma_for_power(0.02, 1e-4), std::invalid_argument);
  EXPECT_THROW(sigma_for_power(0, 0.9), std::invalid_argument);
}

TEST(Statistics, a_bias_of_two_percent_is_caught_as_often_as_power_says) {
  constexpr int kRuns = 2000, kSamples = 400;
  Generator random(3);
  for (const double promised : {0.5, 0.9}) {
    const double sigma = sigma_for_power(0.02, promised);
    const double of_one_sample = sigma * std::sqrt(kSamples);
    int caught = 0, false_alarms = 0;
    for (int run = 0; run < kRuns; ++run) {
      caught += z_test(mean_of(draw(random, kSamples, 1.02, of_one_sample)), {1, 0}).p <= kAccept;
      false_alarms +=
          z_test(mean_of(draw(random, kSamples, 1, of_one_sample)), {1, 0}).p <= kAccept;
    }
    // Binomial, five standard errors.
    EXPECT_NEAR(double(caught) / kRuns, promised, 5 * std::sqrt(promised * (1 - promised) / kRuns))
        << "caught";
    EXPECT_LE(false_alarms, 2 + 5 * std::sqrt(2)) << "false alarms";
  }
}

}  // namespace
}  // namespace nepho::test
