#include "image/tone.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/physics_cpp.h"

namespace nepho {
namespace {

// Bayer's 8x8 matrix, from the bits of x xor y and y interleaved: thresholds in (-1/2, 1/2).
double bayer(int x, int y) {
  int value = 0;
  for (int bit = 0; bit < 3; ++bit)
    value |= (((x ^ y) >> bit & 1) << (5 - 2 * bit)) | ((y >> bit & 1) << (4 - 2 * bit));
  return (value + 0.5) / 64 - 0.5;
}

std::uint8_t to_byte(double value, double threshold) {
  return std::uint8_t(std::clamp(value * 255 + 0.5 + threshold, 0.0, 255.0));
}

// to_byte(srgb_encode(value), threshold) for values up to 1: the same bytes, most without a power,
// by a table whose lines are below the curve by no more than is known of each.
class SrgbBytes {
 public:
  SrgbBytes() : code_(kSteps + 1) {
    for (std::size_t i = 0; i <= kSteps; ++i) code_[i] = f64::srgb_encode(double(i) / kSteps);
  }
  std::uint8_t operator()(double value, double threshold) const {
    const double place = value * kSteps;
    const auto i = std::size_t(place);
    if (i < kFirst || i >= kSteps) return to_byte(f64::srgb_encode(value), threshold);
    const double low = code_[i], step = code_[i + 1] - low, line = low + (place - double(i)) * step;
    // Of a concave curve: an eighth of the second difference, which is greatest before the step.
    const double most = line + 0.25 * (low - code_[i - 1] - step) + 1e-12;
    const std::uint8_t byte = to_byte(line - 1e-12, threshold);
    return byte == to_byte(most, threshold) ? byte : to_byte(f64::srgb_encode(value), threshold);
  }

 private:
  static constexpr std::size_t kSteps = 4096, kFirst = 16;  // behind the curve's straight part
  std::vector<double> code_;
};

// Hundredths, so that the number that is printed is the number that is used.
double exposure_for(double luminance) {
  return luminance > 0 ? std::round(100 * std::log2(kBrightCloud / luminance)) / 100 : 0;
}

struct Luminances {
  std::vector<double> cloud, all;
};
Luminances luminances(const FloatImage& radiance, std::span<const float> optical_depth) {
  Luminances out;
  for (std::size_t p = 0; p < radiance.count(); ++p) {
    const float* in = radiance.values.data() + p * std::size_t(radiance.channels);
    const double y = f64::luminance(double(in[0]), double(in[1]), double(in[2]));
    if (!std::isfinite(y)) continue;
    out.all.push_back(y);
    if (p < optical_depth.size() && optical_depth[p] > 0.1f) out.cloud.push_back(y);
  }
  return out;
}

// 0 of nothing.
double percentile(std::vector<double>& values, double part) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ptrdiff_t(part * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

ByteImage to_display(const FloatImage& radiance, double exposure_ev, ToneMap tone_map, bool dither,
                     const glm::dvec3& white) {
  ByteImage out(radiance.width, radiance.height, 3);
  const SrgbBytes to_bytes;
  const double grey = f64::luminance(white.x, white.y, white.z);
  glm::dvec3 scale(std::exp2(exposure_ev));
  for (int c = 0; c < 3; ++c)
    if (white[c] > 0) scale[c] *= grey / white[c];
  for (std::size_t p = 0; p < radiance.count(); ++p) {
    const float* in = radiance.values.data() + p * std::size_t(radiance.channels);
    double shown[3];
    for (int c = 0; c < 3; ++c) {
      const double value = scale[c] * double(in[c]);
      shown[c] = std::isnan(value) ? 0 : std::clamp(value, 0.0, 1e30);
    }
    if (tone_map == ToneMap::kAces)
      f64::aces_tone(shown[0], shown[1], shown[2], shown[0], shown[1], shown[2]);
    const auto x = int(p % std::size_t(out.width)), y = int(p / std::size_t(out.width));
    const double threshold = dither ? bayer(x, y) : 0;
    for (std::size_t c = 0; c < 3; ++c)
      out.values[3 * p + c] = to_bytes(std::min(shown[c], 1.0), threshold);
  }
  return out;
}

glm::dvec3 display_white(const Scene& scene) {
  return scene.planet ? scene.sun.irradiance_W_per_m2_nm.value_or(glm::dvec3(1)) : glm::dvec3(1);
}

double exposure_from(const FloatImage& radiance, std::span<const float> optical_depth) {
  Luminances y = luminances(radiance, optical_depth);
  return exposure_for(percentile(y.cloud.empty() ? y.all : y.cloud, 0.95));
}

double exposure_on_planet(const FloatImage& radiance, std::span<const float> optical_depth,
                          double white) {
  constexpr double kNextToNone = 0.005, kDark = 0.1, kClear = 0.8;
  Luminances y = luminances(radiance, optical_depth);
  // The sun's glint on the sea is far brighter than any cloud or ground.
  const double lit = std::max(white, percentile(y.cloud, 0.995));
  [[maybe_unused]] const double dark = kDark * std::min(percentile(y.all, 0.995), lit);
#ifndef NEPHO_MUTANT_DARK_COUNTS
  std::erase_if(y.cloud, [&](double cloud) { return cloud < dark; });
#endif
  if (double(y.cloud.size()) <= kNextToNone * double(y.all.size()))
    return exposure_for(std::max(kClear * white, kClear * percentile(y.all, 0.95)));
  return exposure_for(std::max(percentile(y.cloud, 0.95), kGreyCloud * white));
}

}  // namespace nepho
