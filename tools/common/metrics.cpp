#include "common/metrics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
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

}  // namespace

PictureDifference difference(const HdrImage& picture, const HdrImage& truth) {
  if (picture.width != truth.width || picture.height != truth.height)
    throw Error({"pictures differ in size", "", size_text(truth), size_text(picture), ""});
  checked_sum(picture, "picture");
  const double floor = 0.01 * checked_sum(truth, "truth") / double(truth.rgb.size());
  PictureDifference result;
  double luminance = 0, luminance_truth = 0;
  for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
    const double a = double(picture.rgb[i]), b = double(truth.rgb[i]);
    if (a != b) {
      result.same_bits = false;
      result.relative_mse += (a - b) * (a - b) / (b * b + floor * floor);
      result.largest = std::max(result.largest, std::abs(a - b));
    }
  }
  result.relative_mse /= double(truth.rgb.size());
  for (std::size_t p = 0; p < truth.rgb.size() / 3; ++p) {
    luminance += pixel_luminance(picture, p);
    luminance_truth += pixel_luminance(truth, p);
  }
  if (luminance != luminance_truth) result.bias = luminance / luminance_truth - 1;
  result.relative_rms = picture_error(picture, truth);
  return result;
}

}  // namespace nepho
