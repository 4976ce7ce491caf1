// Terms of made-up pictures, whose errors are known.
#include "bench/terms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/references.h"

namespace nepho::bench {
namespace {

constexpr int kWidth = 32, kHeight = 16;

// Grey, with a pattern; every pixel counts.
HdrImage picture(double level, double pattern = 0, int period = 2) {
  HdrImage image{kWidth, kHeight, {}, {}};
  for (int p = 0; p < kWidth * kHeight; ++p) {
    const double value = level + (p / period % 2 ? pattern : -pattern);
    for (int c = 0; c < 3; ++c) image.rgb.push_back(float(value));
    image.optical_depth.push_back(1);
  }
  return image;
}

struct Made {
  HdrImage drawn = picture(1.10, 0.01), codes = picture(1.1301, 0.0);
  Reference fine{picture(1.12), 0}, converged{picture(1.13), 0}, finest{picture(1.05, 0.02, 4), 0};
  Truth truth{picture(1.0), 0, 64};
  std::vector<Term> terms() const {
    return decompose({&drawn, &fine, &converged, &codes, &finest, &truth}, {});
  }
  const Term& term(const std::vector<Term>& all, const char* name) const {
    return *find_term(all, name);
  }
};

TEST(Terms, each_is_the_difference_of_its_two_pictures) {
  const Made made;
  const std::vector<Term> terms = made.terms();
  const struct {
    const char* name;
    double rms, bias;
  } expected[] = {{kTotal, std::hypot(0.10, 0.01), 0.10},
                  {kMarch, std::hypot(0.05, std::hypot(0.01, 0.02)) / 1.05, 0.05 / 1.05},
                  {kIntegration, std::hypot(0.03, 0.01) / 1.13, -0.03 / 1.13},
                  {kSteps, std::hypot(0.02, 0.01) / 1.12, -0.02 / 1.12},
                  {kLightCache, 0.01 / 1.13, -0.01 / 1.13},
                  {kLevelOfDetail, std::hypot(0.08, 0.02) / 1.05, 0.08 / 1.05},
                  {kLightModel, std::hypot(0.05, 0.02), 0.05},
                  {kQuantisation, 0.0001 / 1.13, 0.0001 / 1.13}};
  ASSERT_EQ(terms.size(), std::size(expected));
  for (const auto& [name, rms, bias] : expected) {
    ASSERT_TRUE(made.term(terms, name).told()) << name;
    EXPECT_NEAR(made.term(terms, name).rms, rms, 2e-6) << name;
    EXPECT_NEAR(made.term(terms, name).bias, bias, 2e-6) << name;
  }
}

TEST(Terms, biases_add_up_to_the_totals) {
  const Made made;
  const std::vector<Term> terms = made.terms();
  double sum = 0;
  for (const char* name : {kSteps, kLightCache, kLevelOfDetail, kLightModel})
    sum += made.term(terms, name).bias_of_truth;
  EXPECT_NEAR(sum, made.term(terms, kTotal).bias_of_truth, 1e-6);
  EXPECT_NEAR(made.term(terms, kTotal).bias_of_truth, 0.10, 1e-6);
}

TEST(Terms, noise_of_the_truth_is_taken_out) {
  Made made;
  // A pattern of 2 % stands for noise of 2 %, beside a bias of 11 %.
  made.truth.picture = picture(1.0, 0.02);
  made.truth.noise = 0.02;
  made.drawn = picture(1.11);
  const Term total = made.term(made.terms(), kTotal);
  ASSERT_TRUE(total.told()) << total.withheld;
  const double rms = total.rms;
  EXPECT_NEAR(rms, 0.11, 1e-5);
}

TEST(Terms, what_is_noise_is_not_told) {
  Made made;
  made.truth.picture = picture(1.0, 0.03);
  made.truth.noise = 0.03;  // above a fifth of 10 %
  const std::vector<Term> terms = made.terms();
  EXPECT_FALSE(made.term(terms, kTotal).told());
  EXPECT_FALSE(made.term(terms, kLightModel).told());
  EXPECT_TRUE(made.term(terms, kMarch).told());  // has nothing to do with paths
  EXPECT_EQ(made.term(terms, kTotal).rms, 0);
  // 64 paths; the noise of 3 % has to be a fifth of what is there; and a fifth in hand.
  const std::string& why = made.term(terms, kTotal).withheld;
  EXPECT_NE(why.find("--spp"), std::string::npos) << why;
  const double needed = std::stod(why.substr(why.find("about ") + 6));
  // The patterns of picture and truth are alike: (0.03 - 0.01)^2 is what their difference has.
  const double measured = std::sqrt(0.10 * 0.10 + 0.02 * 0.02 - 0.03 * 0.03);
  EXPECT_NEAR(needed, 1.2 * 64 * std::pow(5 * 0.03 / measured, 2), 0.02 * needed) << why;
  EXPECT_EQ(made.term(terms, kTotal).below, 0);
}

TEST(Terms, a_march_that_has_not_converged_is_no_reference) {
  Made made;
  made.fine.change = 0.005;  // above a fifth of 2 %
  made.finest.change = 0.002;
  const std::vector<Term> terms = made.terms();
  EXPECT_FALSE(made.term(terms, kSteps).told());
  EXPECT_NE(made.term(terms, kSteps).withheld.find("--finest-step"), std::string::npos);
  EXPECT_GE(made.term(terms, kSteps).below, 0.02);
  EXPECT_FALSE(made.term(terms, kLightCache).told());
  EXPECT_TRUE(made.term(terms, kIntegration).told());
  EXPECT_TRUE(made.term(terms, kLevelOfDetail).told());
}

TEST(Terms, the_same_picture_is_off_by_nothing) {
  Made made;
  made.drawn = made.fine.picture;
  made.fine.change = 1e-3;
  const Term steps = made.term(made.terms(), kSteps);
  EXPECT_TRUE(steps.told());
  EXPECT_EQ(steps.rms, 0);
}

TEST(Terms, without_paths_there_is_no_total) {
  const Made made;
  const std::vector<Term> terms =
      decompose({&made.drawn, &made.fine, &made.converged, &made.codes, &made.finest, nullptr}, {});
  EXPECT_EQ(find_term(terms, kTotal), nullptr);
  EXPECT_EQ(find_term(terms, kLightModel), nullptr);
  ASSERT_NE(find_term(terms, kMarch), nullptr);
}

}  // namespace
}  // namespace nepho::bench
