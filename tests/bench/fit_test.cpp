#include "bench/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace nepho::bench {
namespace {

TEST(Fit, a_power_law_gives_its_order_without_doubt) {
  std::vector<StepError> points;
  for (const double step : {0.25, 0.5, 1.0, 2.0})
    points.push_back({step, 0.03 * std::pow(step, 1.7)});
  std::string why;
  const auto fit = convergence_order(points, why);
  ASSERT_TRUE(fit) << why;
  EXPECT_NEAR(fit->order, 1.7, 1e-12);
  EXPECT_NEAR(fit->standard_error, 0, 1e-12);
  EXPECT_EQ(fit->points, 4);
}

// Anscombe's first set (1973, doi:10.2307/2682899): slope 0.500091, its standard error 0.117906.
TEST(Fit, agrees_with_published_data) {
  const double x[] = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const double y[] = {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  std::vector<StepError> points;
  for (int i = 0; i < 11; ++i) points.push_back({std::exp(x[i]), std::exp(y[i])});
  std::string why;
  const auto fit = convergence_order(points, why);
  ASSERT_TRUE(fit) << why;
  EXPECT_NEAR(fit->order, 0.500091, 1e-6);
  EXPECT_NEAR(fit->standard_error, 0.117906, 1e-6);
}

TEST(Fit, fewer_than_three_points_are_no_order) {
  std::string why;
  // A step of 0 and an error of 0 have no logarithm.
  EXPECT_FALSE(convergence_order(std::vector<StepError>{{1, 1}, {2, 4}, {0, 1}, {4, 0}}, why));
  EXPECT_NE(why.find("2 of the 3"), std::string::npos) << why;
  EXPECT_FALSE(convergence_order(std::vector<StepError>{{1, 1}, {1, 4}, {1, 2}}, why));
  EXPECT_NE(why.find("the same"), std::string::npos) << why;
}

TEST(Fit, median_and_quartiles_are_those_of_the_sorted_values) {
  const Spread five = spread_of(std::vector<double>{5, 1, 4, 2, 3});
  EXPECT_EQ(five.median, 3);
  EXPECT_EQ(five.low, 2);
  EXPECT_EQ(five.high, 4);
  EXPECT_EQ(five.runs, 5);
  const Spread four = spread_of(std::vector<double>{10, 0, 20, 30});
  EXPECT_EQ(four.median, 15);
  EXPECT_EQ(four.low, 7.5);
  EXPECT_EQ(spread_of(std::vector<double>{7}).high, 7);
  EXPECT_THROW(spread_of({}), std::invalid_argument);
}

}  // namespace
}  // namespace nepho::bench
