#include <gtest/gtest.h>

#include <cmath>

#include "common/metrics.h"
#include "core/error.h"

namespace nepho {
namespace {

HdrImage grey(int width, int height, float value, float optical_depth) {
  HdrImage image;
  image.width = width;
  image.height = height;
  image.rgb.assign(std::size_t(3 * width * height), value);
  image.optical_depth.assign(std::size_t(width * height), optical_depth);
  return image;
}

TEST(Metrics, a_picture_is_its_own_truth) {
  const PictureDifference d = difference(grey(7, 5, 0.3f, 1), grey(7, 5, 0.3f, 1));
  EXPECT_TRUE(d.same_bits);
  EXPECT_EQ(d.relative_rms, 0);
  EXPECT_EQ(d.relative_mse, 0);
  EXPECT_EQ(d.bias, 0);
}

// A tenth brighter everywhere: rms = bias = 0.1, relMSE = 0.01 / (1 + 0.01^2).
TEST(Metrics, a_tenth_brighter_is_a_tenth) {
  const PictureDifference d = difference(grey(8, 8, 1.1f, 1), grey(8, 8, 1.0f, 1));
  EXPECT_NEAR(d.relative_rms, 0.1, 1e-7);
  EXPECT_NEAR(d.bias, 0.1, 1e-7);
  EXPECT_NEAR(d.relative_mse, 0.01 / 1.0001, 1e-8);
  EXPECT_NEAR(d.relative_mse_luminance, 0.01 / 1.0001, 1e-8);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(d.bias_rgb[c], 0.1, 1e-7);
    EXPECT_NEAR(d.relative_mse_rgb[c], 0.01 / 1.0001, 1e-8);
  }
  EXPECT_NEAR(d.largest, 0.1, 1e-7);
  EXPECT_FALSE(d.same_bits);
  // Scaling the light of both changes no ratio.
  const PictureDifference bright = difference(grey(8, 8, 110, 1), grey(8, 8, 100, 1));
  EXPECT_NEAR(bright.relative_rms, 0.1, 1e-6);
  EXPECT_NEAR(bright.relative_mse, d.relative_mse, 1e-7);
}

TEST(Metrics, the_error_lines_rms_sees_only_the_cloud) {
  HdrImage truth = grey(10, 1, 1, 0), picture = truth;
  for (std::size_t p = 0; p < 5; ++p) truth.optical_depth[p] = 0.02f;  // cloud
  for (std::size_t c = 15; c < 30; ++c) picture.rgb[c] = 5;            // the sky is wrong
  EXPECT_EQ(difference(picture, truth).relative_rms, 0);
  EXPECT_GT(difference(picture, truth).relative_mse, 1);
  picture.rgb[0] = picture.rgb[1] = picture.rgb[2] = 2;  // one of five cloud pixels is off by 1
  EXPECT_NEAR(difference(picture, truth).relative_rms, std::sqrt(1.0 / 5), 1e-7);
}

TEST(Metrics, a_picture_without_cloud_has_no_cloud_error) {
  EXPECT_LT(difference(grey(3, 3, 1, 0), grey(3, 3, 1, 0)).relative_rms, 0);
}

// Red is 30 % too bright and blue 10 % too dark: each has its own numbers, and luminance the sum
// of both by its weights.
TEST(Metrics, channels_are_told_apart) {
  const HdrImage truth = grey(4, 4, 1, 1);
  HdrImage picture = truth;
  for (std::size_t p = 0; p < 16; ++p) {
    picture.rgb[3 * p] = 1.3f;
    picture.rgb[3 * p + 2] = 0.9f;
  }
  const PictureDifference d = difference(picture, truth);
  EXPECT_NEAR(d.bias_rgb[0], 0.3, 1e-6);
  EXPECT_EQ(d.bias_rgb[1], 0);
  EXPECT_NEAR(d.bias_rgb[2], -0.1, 1e-6);
  EXPECT_NEAR(d.relative_mse_rgb[0], 0.09 / 1.0001, 1e-6);
  EXPECT_EQ(d.relative_mse_rgb[1], 0);
  EXPECT_NEAR(d.relative_mse_rgb[2], 0.01 / 1.0001, 1e-6);
  EXPECT_NEAR(d.relative_mse, 0.1 / 3 / 1.0001, 1e-6);
  const double apart = 0.2126 * 0.3 - 0.0722 * 0.1;
  EXPECT_NEAR(d.bias, apart, 1e-6);
  EXPECT_NEAR(d.relative_mse_luminance, apart * apart / 1.0001, 1e-6);
}

TEST(Metrics, relative_differences_have_a_sign_and_a_floor) {
  HdrImage truth = grey(4, 1, 2, 1);
  for (std::size_t c = 0; c < 3; ++c) truth.rgb[c] = 0;  // mean 1.5, floor 0.015
  HdrImage picture = truth;
  for (std::size_t c = 0; c < 3; ++c) {
    picture.rgb[c] = 0.03f;
    picture.rgb[3 + c] = 1;
    picture.rgb[6 + c] = 3;
  }
  const std::vector<double> d = relative_luminance_differences(picture, truth);
  EXPECT_NEAR(d[0], 2, 1e-6);
  EXPECT_NEAR(d[1], -1 / std::hypot(2, 0.015), 1e-6);
  EXPECT_NEAR(d[2], 1 / std::hypot(2, 0.015), 1e-6);
  EXPECT_EQ(d[3], 0);
}

TEST(Metrics, over_a_black_truth_only_the_same_is_finite) {
  const PictureDifference none = difference(grey(2, 2, 0, 1), grey(2, 2, 0, 1));
  EXPECT_EQ(none.relative_mse + none.bias + none.relative_mse_luminance, 0);
  const PictureDifference some = difference(grey(2, 2, 1, 1), grey(2, 2, 0, 1));
  EXPECT_TRUE(std::isinf(some.bias));
  EXPECT_TRUE(std::isinf(some.relative_mse));
  EXPECT_TRUE(std::isinf(some.relative_mse_luminance));
}

TEST(Metrics, sizes_and_values_are_checked) {
  EXPECT_THROW(difference(grey(3, 3, 1, 1), grey(3, 4, 1, 1)), Error);
  EXPECT_THROW(difference(grey(3, 3, NAN, 1), grey(3, 3, 1, 1)), Error);
  EXPECT_THROW(difference(grey(3, 3, 1, 1), grey(3, 3, INFINITY, 1)), Error);
}

}  // namespace
}  // namespace nepho
