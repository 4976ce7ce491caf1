#include "reference/error_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace nepho {
namespace {

HdrImage grey(std::vector<float> values, std::vector<float> optical_depth) {
  HdrImage image;
  image.width = int(values.size());
  image.height = 1;
  for (const float v : values) image.rgb.insert(image.rgb.end(), 3, v);
  image.optical_depth = std::move(optical_depth);
  return image;
}

TEST(ErrorMetric, IsRmsOverMeanOfTheReference) {
  // Differences 3 and 4 on means of 10: sqrt(12.5) / 10.
  const HdrImage reference = grey({8, 12}, {1, 1}), picture = grey({11, 8}, {1, 1});
  EXPECT_NEAR(picture_error(picture, reference), std::sqrt(12.5) / 10, 1e-6);
}

TEST(ErrorMetric, CountsOnlyPixelsThatShowAVolumeInTheReference) {
  const HdrImage reference = grey({10, 10, 999}, {1, 0.5f, 0.01f});
  const HdrImage picture = grey({11, 9, 0}, {1, 0, 1});
  EXPECT_NEAR(picture_error(picture, reference), 0.1, 1e-6);
}

TEST(ErrorMetric, WeighsChannelsAsLuminance) {
  HdrImage reference = grey({1}, {1}), picture = reference;
  picture.rgb[1] = 2;
  EXPECT_NEAR(picture_error(picture, reference), 0.7152, 1e-6);
  picture.rgb[1] = 1;
  picture.rgb[2] = 2;
  EXPECT_NEAR(picture_error(picture, reference), 0.0722, 1e-6);
}

TEST(ErrorMetric, IsTheSameForBrighterPicturesAndNoneForNone) {
  const HdrImage reference = grey({8, 12}, {1, 1}), picture = grey({11, 8}, {1, 1});
  const HdrImage bright = grey({8000, 12000}, {1, 1}), other = grey({11000, 8000}, {1, 1});
  EXPECT_NEAR(picture_error(picture, reference), picture_error(other, bright), 1e-6);
  EXPECT_EQ(picture_error(picture, picture), 0);
  EXPECT_LT(picture_error(picture, grey({8, 12}, {0, 0})), 0);
  EXPECT_TRUE(std::isinf(picture_error(picture, grey({0, 0}, {1, 1}))));
  EXPECT_THROW(picture_error(picture, grey({1}, {1})), std::invalid_argument);
}

}  // namespace
}  // namespace nepho
