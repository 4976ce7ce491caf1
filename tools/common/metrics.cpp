#include "common/metrics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "physics/physics_cpp.h"
#include "reference/error_metric.h"

namespace nepho {
namespace {

std::string size_text(const HdrImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

double checked_sum(const HdrImage& image, const char* which) {
  double sum = 0;
  for (const float v : image.rgb) sum += double(v);
  if (!std::isfinite(sum)) throw Error({"not finite", which, "finite values", "inf or NaN", ""});
  return sum;
}

void check_sizes(const HdrImage& picture, const HdrImage& truth) {
  if (picture.width != truth.width || picture.height != truth.height)
    throw Error({"pictures differ in size", "", size_text(truth), size_text(picture), ""});
}

// By how much a sum is above the truth's, relative.
double over(double sum, double truth) {
  if (sum == truth) return 0;
#ifdef NEPHO_MUTANT_BIAS_SIGN
  return 1 - sum / truth;
#else
  return sum / truth - 1;
#endif
}

}  // namespace

PictureDifference difference(const HdrImage& picture, const HdrImage& truth) {
  check_sizes(picture, truth);
  checked_sum(picture, "picture");
  const double floor = 0.01 * checked_sum(truth, "truth") / double(truth.rgb.size());
  PictureDifference result;
  std::array<double, 3> sum{}, sum_truth{};
  for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
    const double a = double(picture.rgb[i]), b = double(truth.rgb[i]);
    sum[i % 3] += a;
    sum_truth[i % 3] += b;
    if (a == b) continue;
    result.same_bits = false;
    result.relative_mse_rgb[i % 3] += (a - b) * (a - b) / (b * b + floor * floor);
    result.largest = std::max(result.largest, std::abs(a - b));
  }
  const auto pixels = double(truth.rgb.size() / 3);
  for (std::size_t c = 0; c < 3; ++c) {
    result.relative_mse_rgb[c] /= pixels;
    result.relative_mse += result.relative_mse_rgb[c] / 3;
    result.bias_rgb[c] = over(sum[c], sum_truth[c]);
  }
  result.bias = over(f64::luminance(sum[0], sum[1], sum[2]),
                     f64::luminance(sum_truth[0], sum_truth[1], sum_truth[2]));
  for (const double d : relative_luminance_differences(picture, truth))
    result.relative_mse_luminance += d * d / pixels;
  result.relative_rms = picture_error(picture, truth);
  return result;
}

std::vector<double> relative_luminance_differences(const HdrImage& picture, const HdrImage& truth) {
  check_sizes(picture, truth);
  const std::size_t pixels = truth.rgb.size() / 3;
  double mean = 0;
  for (std::size_t p = 0; p < pixels; ++p) mean += pixel_luminance(truth, p) / double(pixels);
  std::vector<double> out;
  for (std::size_t p = 0; p < pixels; ++p) {
    const double a = pixel_luminance(picture, p), b = pixel_luminance(truth, p);
    out.push_back(a == b ? 0 : (a - b) / std::hypot(b, 0.01 * mean));
  }
  return out;
}

}  // namespace nepho
