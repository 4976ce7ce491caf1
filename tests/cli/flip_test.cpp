#include "image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "accuracy_report.h"
#include "image/colour.h"
#include "image/difference.h"

namespace nepho {
namespace {

ByteImage filled(int width, int height, std::array<int, 3> rgb) {
  ByteImage image(width, height, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = std::uint8_t(rgb[i % 3]);
  return image;
}

// A pattern with edges, points and every hue; with `changed` a square of it is brighter and one
// green in five is turned over.
ByteImage pattern(bool changed) {
  ByteImage image(32, 20, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int value = (5 * x + 3 * y + 40 * c + (x * y * (c + 1)) % 37) % 256;
        if (changed && x >= 12 && x < 20 && y >= 6 && y < 14) value = (value + 60 * (c + 1)) % 256;
        if (changed && (x + 2 * y) % 5 == 0 && c == 1) value = 255 - value;
        image.values[std::size_t(3 * (32 * y + x) + c)] = std::uint8_t(value);
      }
  return image;
}

double flip_mean(const ByteImage& a, const ByteImage& b) {
  return mean_of(flip_map(a, b));
}

TEST(Flip, the_same_picture_is_zero_everywhere) {
  const FloatImage map = flip_map(pattern(true), pattern(true));
  EXPECT_EQ(largest_of(map), 0);
}

TEST(Flip, green_and_blue_are_one_apart) {
  const FloatImage map = flip_map(filled(30, 20, {0, 255, 0}), filled(30, 20, {0, 0, 255}));
  for (const float value : map.values) EXPECT_NEAR(value, 1, 1e-6);
}

// Even pictures have no features, and blurring does nothing: what is left is the distance of two
// colours. Of greys it is that of lightness, 100 for black and white and (Y > 0.008856)
// 116 cbrt(Y) - 16; the largest, green against blue, is 203.31.
TEST(Flip, even_greys_are_a_closed_form) {
  const auto hunt = [](glm::dvec3 lab) { return lab * glm::dvec3(1, lab.x / 100, lab.x / 100); };
  const glm::dvec3 green = hunt(lab_of({0, 1, 0})), blue = hunt(lab_of({0, 0, 1}));
  const double widest = std::abs(green.x - blue.x) + std::hypot(green.y - blue.y, green.z - blue.z);
  EXPECT_NEAR(widest, 203.31, 0.01);
  const double most = std::pow(widest, 0.7), bend = 0.4 * most;
  const double black_white = 0.95 + 0.05 * (std::pow(100, 0.7) - bend) / (most - bend);
  EXPECT_NEAR(flip_mean(filled(9, 9, {0, 0, 0}), filled(9, 9, {255, 255, 255})), black_white, 1e-6);
  EXPECT_NEAR(black_white, 0.96738, 1e-5);
  const auto lightness = [](int byte) {
    return 116 * std::cbrt(std::pow((byte / 255.0 + 0.055) / 1.055, 2.4)) - 16;
  };
  for (const int byte : {100, 129, 200}) {
    const double distance = std::pow(std::abs(lightness(byte) - lightness(128)), 0.7);
    EXPECT_NEAR(flip_mean(filled(9, 9, {byte, byte, byte}), filled(9, 9, {128, 128, 128})),
                0.95 / bend * distance, 1e-6)
        << byte;
  }
}

// Made once with a program of its own: the paper's filters as full squares rather than products of
// two lines, in NumPy, with the same edges.
TEST(Flip, pattern_has_the_values_of_an_independent_program) {
  struct Row {
    double per_degree, mean, first, middle, last;
  };
  double worst = 0;
  for (const Row& row :
       {Row{kPixelsPerDegree, 0.3921146999, 0.9748419295, 0.6747022952, 0.2994707891},
        Row{20, 0.3671532582, 0.9877055182, 0.9437143768, 0.0727148306}}) {
    const FloatImage map = flip_map(pattern(true), pattern(false), row.per_degree);
    EXPECT_NEAR(mean_of(map), row.mean, 1e-7) << row.per_degree;
    worst = std::max(worst, std::abs(mean_of(map) - row.mean));
    EXPECT_NEAR(map.values[0], row.first, 1e-6) << row.per_degree;
    EXPECT_NEAR(map.values[9 * 32 + 15], row.middle, 1e-6) << row.per_degree;
    EXPECT_NEAR(map.values[19 * 32 + 31], row.last, 1e-6) << row.per_degree;
  }
  test::report_accuracy("pictures", "mean FLIP of a pattern, against whole squares of weights",
                        worst, 1e-7, "1");
}

TEST(Flip, either_picture_can_be_the_truth) {
  const FloatImage there = flip_map(pattern(true), pattern(false));
  EXPECT_EQ(there.values, flip_map(pattern(false), pattern(true)).values);
}

ByteImage noisy(double amplitude) {
  ByteImage image = filled(48, 48, {120, 130, 140});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (std::uint8_t& value : image.values)
    value = std::uint8_t(std::lround(value + amplitude * noise(random)));
  return image;
}

TEST(Flip, grows_with_noise) {
  double before = 0;
  for (const double amplitude : {2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
    const double now = flip_mean(noisy(amplitude), noisy(0));
    EXPECT_GT(now, 1.2 * before) << amplitude;
    before = now;
  }
}

// A step between two greys, smeared over more and more pixels.
ByteImage smeared(int pixels) {
  ByteImage image(64, 16, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const double x = double(i / 3 % 64) - 31.5;
    const double part = std::clamp(0.5 + x / std::max(1, pixels), 0.0, 1.0);
    image.values[i] = std::uint8_t(std::lround(60 + 140 * part));
  }
  return image;
}

TEST(Flip, grows_with_blur) {
  double before = 0;
  for (const int pixels : {3, 5, 9, 17, 33}) {
    const double now = flip_mean(smeared(pixels), smeared(1));
    EXPECT_GT(now, 1.2 * before) << pixels;
    before = now;
  }
}

// What the eye does not resolve from afar it sees from near.
TEST(Flip, fine_noise_fades_with_distance) {
  double before = 2;
  for (const double per_degree : {20.0, 40.0, kPixelsPerDegree, 130.0}) {
    const double now = mean_of(flip_map(noisy(30), noisy(0), per_degree));
    EXPECT_LT(now, 0.95 * before) << per_degree;
    before = now;
  }
}

TEST(Flip, sizes_are_checked) {
  EXPECT_THROW(flip_map(filled(3, 3, {}), filled(3, 4, {})), std::invalid_argument);
  EXPECT_THROW(flip_map(ByteImage(), ByteImage()), std::invalid_argument);
  EXPECT_THROW(flip_map(filled(3, 3, {}), filled(3, 3, {}), 0), std::invalid_argument);
  EXPECT_THROW(flip_map(filled(3, 3, {}), filled(3, 3, {}), NAN), std::invalid_argument);
}

}  // namespace
}  // namespace nepho
