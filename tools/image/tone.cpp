#include "image/tone.h"

#include <algorithm>
#include <cmath>

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
  return std::uint8_t(std::clamp(std::floor(value * 255 + 0.5 + threshold), 0.0, 255.0));
}

}  // namespace

ByteImage to_display(const FloatImage& radiance, double exposure_ev, ToneMap tone_map,
                     bool dither) {
  ByteImage out(radiance.width, radiance.height, 3);
  const double scale = std::exp2(exposure_ev);
  for (std::size_t p = 0; p < radiance.count(); ++p) {
    const float* in = radiance.values.data() + p * std::size_t(radiance.channels);
    double shown[3];
    for (int c = 0; c < 3; ++c) {
      const double value = scale * double(in[c]);
      shown[c] = std::isnan(value) ? 0 : std::clamp(value, 0.0, 1e30);
    }
    if (tone_map == ToneMap::kAces)
      f64::aces_tone(shown[0], shown[1], shown[2], shown[0], shown[1], shown[2]);
    const auto x = int(p % std::size_t(out.width)), y = int(p / std::size_t(out.width));
    const double threshold = dither ? bayer(x, y) : 0;
    for (std::size_t c = 0; c < 3; ++c)
      out.values[3 * p + c] = to_byte(f64::srgb_encode(std::min(shown[c], 1.0)), threshold);
  }
  return out;
}

double exposure_from(const FloatImage& radiance, std::span<const float> optical_depth) {
  std::vector<double> cloud, all;
  for (std::size_t p = 0; p < radiance.count(); ++p) {
    const float* in = radiance.values.data() + p * std::size_t(radiance.channels);
    const double y = f64::luminance(double(in[0]), double(in[1]), double(in[2]));
    if (!std::isfinite(y)) continue;
    all.push_back(y);
    if (p < optical_depth.size() && optical_depth[p] > 0.1f) cloud.push_back(y);
  }
  std::vector<double>& counted = cloud.empty() ? all : cloud;
  if (counted.empty()) return 0;
  const auto bright = counted.begin() + std::ptrdiff_t(0.95 * double(counted.size() - 1));
  std::nth_element(counted.begin(), bright, counted.end());
  // Hundredths, so that the number that is printed is the number that is used.
  return *bright > 0 ? std::round(100 * std::log2(kBrightCloud / *bright)) / 100 : 0;
}

}  // namespace nepho
