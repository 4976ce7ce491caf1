#include "bricks/quantise.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "codes.h"

namespace nepho::test {
namespace {

TEST(Quantise, ZeroIsExactlyZeroOverEightDecades) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (double top = 1e-8; top < 10; top *= 10) {
    std::vector<double> values(729);
    for (double& value : values) value = uniform(random) < 0.5 ? 0 : top * uniform(random);
    values[0] = top;
    const Codes codes = code_values(values);
    for (std::size_t at = 0; at < values.size(); ++at) {
      if (values[at] == 0) {
        EXPECT_EQ(codes.decode(at), 0.0f);
      }
      EXPECT_LE(std::abs(codes.decode(at) - values[at]), codes.q.max_abs_error);
      EXPECT_LE(codes.decode(at), decoded_bound(top));
    }
    // Half a step and 2 float epsilon of the top: 0.5156 steps.
    EXPECT_LE(codes.q.max_abs_error, top * 0.5157 / 65535);
  }
}

TEST(Quantise, OffsetOnlyWithoutZero) {
  EXPECT_EQ(code_values({0.0, 0.5}).q.offset, 0);
  const Codes hazy = code_values({0.4, 0.5});
  EXPECT_NEAR(hazy.q.offset, 0.4, 1e-7);
  EXPECT_LE(hazy.q.scale, 0.1001 / 65535);
}

TEST(Quantise, ConstantHasNoStep) {
  const Codes codes = code_values({0.125, 0.125});
  EXPECT_EQ(codes.q.scale, 0);
  EXPECT_EQ(codes.decode(1), 0.125f);
  EXPECT_EQ(code_values({0.0, 0.0}).decode(0), 0.0f);
}

// Half a step is not the bound here: float has no finer steps around 0.3 than 3e-8.
TEST(Quantise, NarrowRangeIsBoundByFloat) {
  const std::vector<double> values = {0.3, 0.3 + 1e-7, 0.3 + 0.77e-7};
  const Codes codes = code_values(values);
  double worst = 0;
  for (std::size_t at = 0; at < values.size(); ++at)
    worst = std::max(worst, std::abs(codes.decode(at) - values[at]));
  EXPECT_GT(worst, 0.5 * codes.q.scale);
  EXPECT_LE(worst, codes.q.max_abs_error);
}

// Within one brick: a column 1e-4 of the thickest one is still right to 0.1 % ... per 8 samples.
TEST(Quantise, ColumnOpticalDepth) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0.5, 1);
  for (const double thin : {1e-1, 1e-2, 1e-3, 1e-4}) {
    double worst = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      std::vector<double> values(18, 0.0);
      for (std::size_t k = 0; k < 9; ++k) {
        values[k] = uniform(random);
        values[9 + k] = thin * uniform(random);
      }
      const Codes codes = code_values(values);
      double decoded = 0;
      for (std::size_t k = 9; k < 18; ++k) decoded += codes.decode(k);
      const double truth = std::accumulate(values.begin() + 9, values.end(), 0.0);
      worst = std::max(worst, std::abs(decoded / truth - 1));
    }
    std::printf("measured: column of %.0e of the brick's maximum: worst error %.1e\n", thin, worst);
    if (thin >= 1e-2) {
      EXPECT_LE(worst, 1e-3);
    }
  }
}

TEST(Quantise, RefusesWhatIsNotExtinction) {
  EXPECT_THROW(code_values({-1.0}), std::domain_error);
  EXPECT_THROW(code_values({std::numeric_limits<double>::infinity()}), std::domain_error);
  EXPECT_THROW(code_values({std::nan("")}), std::domain_error);
}

}  // namespace
}  // namespace nepho::test
