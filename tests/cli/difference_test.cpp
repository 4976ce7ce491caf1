#include "image/difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/colour.h"

namespace nepho {
namespace {

ByteImage bytes(std::vector<std::uint8_t> values) {
  ByteImage image(int(values.size() / 3), 1, 3);
  image.values = std::move(values);
  return image;
}

FloatImage floats(std::vector<float> values) {
  FloatImage image(int(values.size()), 1, 1);
  image.values = std::move(values);
  return image;
}

// The textbook's numbers: off by one everywhere is 48.13 dB, black for white 0 dB.
TEST(ByteDifference, constant_offsets_are_a_closed_form) {
  const ByteDifference one = byte_difference(bytes({1, 9, 77}), bytes({2, 8, 78}));
  EXPECT_DOUBLE_EQ(one.rmse, 1);
  EXPECT_NEAR(one.psnr_db, 48.1308036, 1e-7);
  EXPECT_EQ(one.largest, 1);
  const ByteDifference most = byte_difference(bytes({0, 0, 0}), bytes({255, 255, 255}));
  EXPECT_DOUBLE_EQ(most.rmse, 255);
  EXPECT_NEAR(most.psnr_db, 0, 1e-12);
  // Ten times the error is 20 dB less.
  EXPECT_NEAR(byte_difference(bytes({10, 10, 10}), bytes({20, 20, 20})).psnr_db, 28.1308036, 1e-7);
  // One channel in three off by 6: sqrt(36 / 3).
  EXPECT_DOUBLE_EQ(byte_difference(bytes({7, 8, 9}), bytes({7, 2, 9})).rmse, std::sqrt(12));
  const ByteDifference none = byte_difference(bytes({1, 2, 3}), bytes({1, 2, 3}));
  EXPECT_EQ(none.rmse, 0);
  EXPECT_TRUE(std::isinf(none.psnr_db) && none.psnr_db > 0);
  EXPECT_THROW(byte_difference(bytes({1, 2, 3}), bytes({1, 2, 3, 4, 5, 6})), std::invalid_argument);
}

// CIELAB of the primaries as published for sRGB under D65 (ASTM E308, 2 degrees), to two decimals.
TEST(Colour, lab_is_that_of_the_tables_and_back) {
  const auto near = [](glm::dvec3 found, glm::dvec3 published) {
    EXPECT_NEAR(found.x, published.x, 0.02);
    EXPECT_NEAR(found.y, published.y, 0.02);
    EXPECT_NEAR(found.z, published.z, 0.02);
  };
  near(lab_of({1, 0, 0}), {53.24, 80.09, 67.20});
  near(lab_of({0, 1, 0}), {87.73, -86.18, 83.18});
  near(lab_of({0, 0, 1}), {32.30, 79.19, -107.86});
  near(lab_of({1, 1, 1}), {100, 0, 0});
  near(lab_of(glm::dvec3(0.184186518)), {50, 0, 0});
  for (const glm::dvec3& linear : {glm::dvec3(0.2, 0.5, 0.9), {0.001, 0.0005, 0.002}, {0, 1, 0}})
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(linear_of_lab(lab_of(linear))[c], linear[c], 1e-12);
      EXPECT_NEAR(linear_of_xyz(xyz_of(linear))[c], linear[c], 1e-12);
    }
}

TEST(Colour, srgb_is_that_of_the_standard) {
  EXPECT_EQ(srgb_decode(0), 0);
  EXPECT_EQ(srgb_decode(1), 1);
  EXPECT_NEAR(srgb_decode(0.735357), 0.5, 1e-6);
  EXPECT_NEAR(srgb_decode(0.04045), 0.04045 / 12.92, 1e-15);
}

double lightness(const ByteImage& image, std::size_t pixel) {
  const std::uint8_t* rgb = &image.values[3 * pixel];
  return lab_of({srgb_decode(rgb[0] / 255.0), srgb_decode(rgb[1] / 255.0),
                 srgb_decode(rgb[2] / 255.0)})
      .x;
}

// Also says that no colour of the scale is out of the display's reach: clipped, it would have
// another lightness.
TEST(ColourMap, lightness_is_even_along_the_scale) {
  std::vector<float> steps;
  for (int i = 0; i <= 100; ++i) steps.push_back(float(i) / 50);
  const ByteImage error = error_colours(floats(steps), 2);
  for (std::size_t i = 0; i < steps.size(); ++i)
    EXPECT_NEAR(lightness(error, i), 0.96 * double(i), 0.5) << i;
  for (float& step : steps) step -= 1;
  const ByteImage both = signed_colours(floats(steps), 1);
  for (std::size_t i = 0; i < steps.size(); ++i)
    EXPECT_NEAR(lightness(both, i), 96 - 64 * std::abs(double(steps[i])), 0.5) << i;
}

TEST(ColourMap, sign_is_a_hue_and_the_ends_hold) {
  const ByteImage both = signed_colours(floats({-1, 0, 1, -9, 9}), 1);
  const auto at = [&](std::size_t p, std::size_t c) { return int(both.values[3 * p + c]); };
  EXPECT_GT(at(0, 2), at(0, 0) + 80);  // darker than the truth is blue
  EXPECT_GT(at(2, 0), at(2, 2) + 80);  // brighter is red
  EXPECT_LE(std::abs(at(1, 0) - at(1, 2)), 1);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(at(0, c), at(3, c));
    EXPECT_EQ(at(2, c), at(4, c));
  }
}

TEST(ColourMap, scales_are_round_and_hold_the_values) {
  EXPECT_DOUBLE_EQ(round_scale(floats({0.03f, -0.02f})), 0.05);
  EXPECT_DOUBLE_EQ(round_scale(floats({-0.7f})), 1);
  EXPECT_DOUBLE_EQ(round_scale(floats({150})), 200);
  EXPECT_EQ(round_scale(floats({0, 0})), 1);
  std::vector<float> values(1000, 0.01f);
  values[7] = 50;  // one pixel in a thousand does not hide the rest
  EXPECT_NEAR(round_scale(floats(values)), 0.01, 1e-9);
  std::fill(values.begin(), values.end(), 0.0f);
  values[7] = 3;
  EXPECT_DOUBLE_EQ(round_scale(floats(values)), 5);
}

}  // namespace
}  // namespace nepho
