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

TEST(Metrics, sizes_and_values_are_checked) {
  EXPECT_THROW(difference(grey(3, 3, 1, 1), grey(3, 4, 1, 1)), Error);
  EXPECT_THROW(difference(grey(3, 3, NAN, 1), grey(3, 3, 1, 1)), Error);
  EXPECT_THROW(difference(grey(3, 3, 1, 1), grey(3, 3, INFINITY, 1)), Error);
}

}  // namespace
}  // namespace nepho
