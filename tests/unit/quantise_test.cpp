#include "bricks/quantise.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "accuracy_report.h"
#include "codes.h"

namespace nepho::test {
namespace {

TEST(Quantise, ZeroIsExactlyZeroOverEightDecades) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (double top = 1e-8; top < 10; top *= 10) {
    std::vector<double> values(729);
    for (double& value : values) value = uniform(random) < 0.5 ? 0 : top * uniform(random);
    values[0] = top;
    const Codes codes = code_values(values);
    for (std::size_t at = 0; at < values.size(); ++at) {
      if (values[at] == 0) {
        EXPECT_EQ(codes.decode(at), 0.0f);
      }
      const double error = std::abs(double(codes.decode(at)) - values[at]);
      EXPECT_LE(error, codes.q.max_abs_error);
      worst = std::max(worst, error / codes.q.max_abs_error);
      EXPECT_LE(codes.decode(at), decoded_bound(top));
    }
    // Half a step and 2 float epsilon of the top: 0.5156 steps.
    EXPECT_LE(codes.q.max_abs_error, top * 0.5157 / 65535);
  }
  report_accuracy("codes", "u16 over 8 decades: error / max_abs_error", worst, 1, "1");
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
      report_accuracy("codes", "optical depth of a column at 1 % or more of the brick's maximum",
                      worst, 1e-3, "1");
      EXPECT_LE(worst, 1e-3);
    }
  }
}

TEST(Quantise, RefusesWhatIsNotExtinction) {
  EXPECT_THROW(code_values({-1.0}), std::domain_error);
  EXPECT_THROW(code_values({std::numeric_limits<double>::infinity()}), std::domain_error);
  EXPECT_THROW(code_values({std::nan("")}), std::domain_error);
}

// u8 is a decision of the volume: one scale for all bricks, no offset, so that equal values have
// equal codes in every brick, and a face that two bricks share decodes to the same bits.
TEST(Quantise, FixedScaleOf8Bits) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double most = 0.08;
  const float scale = float(most / kTopCode8);
  double worst = 0;
  std::vector<std::uint16_t> code_of_face;
  for (int brick = 0; brick < 50; ++brick) {
    const double top = most * std::exp2(-0.2 * brick);
    std::vector<double> values(729);
    for (double& value : values) value = uniform(random) < 0.3 ? 0 : top * uniform(random);
    for (std::size_t at = 0; at < 9; ++at)
      values[at] = most * 1e-3 * double(at);  // the shared face
    const Codes codes = code_values(values, kTopCode8, scale);
    EXPECT_EQ(codes.q.scale, scale);
    EXPECT_EQ(codes.q.offset, 0);
    for (std::size_t at = 0; at < values.size(); ++at) {
      EXPECT_LE(codes.code[at], kTopCode8);
      if (values[at] == 0) {
        EXPECT_EQ(codes.decode(at), 0.0f);
      }
      const double error = std::abs(double(codes.decode(at)) - values[at]);
      EXPECT_LE(error, codes.q.max_abs_error);
      worst = std::max(worst, error / codes.q.max_abs_error);
    }
    const std::vector<std::uint16_t> face(codes.code.begin(), codes.code.begin() + 9);
    if (brick == 0) code_of_face = face;
    EXPECT_EQ(face, code_of_face);
  }
  report_accuracy("codes", "u8 with a fixed scale: error / max_abs_error", worst, 1, "1");
}

TEST(Quantise, FixedScaleRefusesWhatIsAboveIt) {
  EXPECT_EQ(code_values({255.0}, kTopCode8, 1.0f).code[0], 255);
  EXPECT_EQ(code_values({255.5}, kTopCode8, 1.0f).code[0], 255);  // still half a step
  EXPECT_THROW(code_values({255.6}, kTopCode8, 1.0f), std::domain_error);
  EXPECT_EQ(code_values({65535.0}, kTopCode16, 1.0f).code[0], 65535);
  EXPECT_THROW(code_values({65536.0}, kTopCode16, 1.0f), std::domain_error);
}

// u8 with a scale of its own: 255 steps between the brick's ends.
TEST(Quantise, OwnScaleOf8Bits) {
  const Codes codes = code_values({0.0, 0.3, 1.0}, kTopCode8);
  EXPECT_EQ(codes.code[2], 255);
  EXPECT_EQ(codes.decode(0), 0.0f);
  EXPECT_NEAR(codes.decode(1), 0.3, codes.q.max_abs_error);
  EXPECT_NEAR(codes.q.max_abs_error, 0.5 / 255, 1e-6);
}

// Ice beside the total: each channel has its own scale, so thin ice in thick water keeps its
// digits.
TEST(Quantise, SecondChannelHasItsOwnScale) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> total(729), ice(729);
  for (std::size_t at = 0; at < total.size(); ++at) {
    ice[at] = uniform(random) < 0.5 ? 0 : 1e-6 * uniform(random);
    total[at] = 0.1 * uniform(random) + ice[at];
  }
  const Codes of_total = code_values(total), of_ice = code_values(ice);
  EXPECT_LT(of_ice.q.max_abs_error, 1e-10);
  EXPECT_GT(of_total.q.max_abs_error, 1e-7);
  for (std::size_t at = 0; at < ice.size(); ++at) {
    EXPECT_NEAR(of_ice.decode(at), ice[at], of_ice.q.max_abs_error);
    EXPECT_NEAR(of_total.decode(at), total[at], of_total.q.max_abs_error);
    if (ice[at] == 0) {
      EXPECT_EQ(of_ice.decode(at), 0.0f);
    }
  }
}

// The bound says what it can: no looser than 4 epsilon, and never below a decoded top code.
TEST(Quantise, DecodedBoundIsTight) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 20000; ++trial) {
    const double top = std::pow(10.0, 10 * uniform(random) - 9), low = top * uniform(random);
    const Codes codes = code_values({low, top});
    EXPECT_LE(codes.decode(1), decoded_bound(top));
    EXPECT_LE(decoded_bound(top), top * (1 + 6e-7));
  }
  EXPECT_EQ(decoded_bound(0), 0);
}

}  // namespace
}  // namespace nepho::test
