#include "image/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "image/colour.h"
#include "image/tone.h"

namespace nepho {
namespace {

// CIELAB at evenly spaced places of the scale; all between them can be shown (a test says so).
constexpr std::array kError{glm::dvec3(0, 0, 0), glm::dvec3(24, 30, -38), glm::dvec3(48, 56, 5),
                            glm::dvec3(72, 26, 50), glm::dvec3(96, -8, 29)};
constexpr std::array kSigned{glm::dvec3(32, 14, -49), glm::dvec3(96, 0, 0), glm::dvec3(32, 52, 36)};

// `place` in [0, 1].
glm::dvec3 colour_at(std::span<const glm::dvec3> scale, double place) {
  const double at = place * double(scale.size() - 1);
  const auto step = std::min(std::size_t(at), scale.size() - 2);
  return linear_of_lab(glm::mix(scale[step], scale[step + 1], at - double(step)));
}

ByteImage coloured(const FloatImage& map, std::span<const glm::dvec3> scale, double low,
                   double high) {
  FloatImage light(map.width, map.height, 3);
  for (std::size_t p = 0; p < map.count(); ++p) {
    const double value = double(map.values[p * std::size_t(map.channels)]);
    const glm::dvec3 colour = colour_at(scale, std::clamp((value - low) / (high - low), 0.0, 1.0));
    for (int c = 0; c < 3; ++c) light.values[3 * p + std::size_t(c)] = float(colour[c]);
  }
  return to_display(light, 0, ToneMap::kNone);
}

}  // namespace

ByteDifference byte_difference(const ByteImage& picture, const ByteImage& truth) {
  if (picture.width != truth.width || picture.values.size() != truth.values.size() ||
      truth.values.empty())
    throw std::invalid_argument("byte_difference: pictures of one size");
  ByteDifference out;
  double squares = 0;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    const int apart = std::abs(int(picture.values[i]) - int(truth.values[i]));
    squares += double(apart) * apart;
    out.largest = std::max(out.largest, apart);
  }
  out.rmse = std::sqrt(squares / double(truth.values.size()));
#ifdef NEPHO_MUTANT_PSNR_OF_RMSE
  out.psnr_db = 10 * std::log10(255.0 * 255 / out.rmse);  // the root where the square belongs
#else
  out.psnr_db = 20 * std::log10(255 / out.rmse);
#endif
  return out;
}

double mean_of(const FloatImage& map) {
  double sum = 0;
  for (const float value : map.values) sum += double(value);
  return sum / double(map.values.size());
}

double largest_of(const FloatImage& map) {
  return map.values.empty() ? 0 : double(*std::max_element(map.values.begin(), map.values.end()));
}

ByteImage error_colours(const FloatImage& map, double full) {
  return coloured(map, kError, 0, full);
}

ByteImage signed_colours(const FloatImage& map, double full) {
  return coloured(map, kSigned, -full, full);
}

double round_scale(const FloatImage& map) {
  std::vector<double> sizes;
  for (const float value : map.values) sizes.push_back(std::abs(double(value)));
  if (sizes.empty()) return 1;
  const auto at = sizes.begin() + std::ptrdiff_t(std::ceil(0.99 * double(sizes.size() - 1)));
  std::nth_element(sizes.begin(), at, sizes.end());
  // Where hardly any pixel differs, those that do set it.
  const double size = *at > 0 ? *at : *std::max_element(sizes.begin(), sizes.end());
  if (!(size > 0)) return 1;
  const double ten = std::pow(10.0, std::floor(std::log10(size)));
  for (const double step : {1.0, 2.0, 5.0})
    if (size <= step * ten) return step * ten;
  return 10 * ten;
}

}  // namespace nepho
