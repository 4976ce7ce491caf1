#include "reference/error_metric.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "physics/physics_cpp.h"

namespace nepho {

double relative_rms(std::span<const PixelPair> pixels) {
  if (pixels.empty()) return -1;
  double squares = 0, sum = 0, n = 0;
  for (const PixelPair& p : pixels) {
    const double difference = p.luminance - p.reference;
#if defined(NEPHO_MUTANT_METRIC_MEAN)
    squares += p.weight * std::abs(difference);
#else
    squares += p.weight * difference * difference;
#endif
    sum += p.weight * p.reference;
    n += p.weight;
  }
#if defined(NEPHO_MUTANT_METRIC_MEAN)
  const double rms = squares / n;
#else
  const double rms = std::sqrt(squares / n);
#endif
  if (rms == 0) return 0;
  return sum > 0 ? rms / (sum / n) : std::numeric_limits<double>::infinity();
}

double pixel_luminance(const HdrImage& picture, std::size_t pixel) {
  const float* rgb = &picture.rgb[3 * pixel];
  return f64::luminance(double(rgb[0]), double(rgb[1]), double(rgb[2]));
}

double picture_error(const HdrImage& picture, const HdrImage& reference,
                     [[maybe_unused]] Counts counts) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw std::invalid_argument("picture_error: pictures differ in size");
  std::vector<PixelPair> pairs;
  for (std::size_t p = 0; p < reference.optical_depth.size(); ++p)
#if !defined(NEPHO_MUTANT_METRIC_ALL_PIXELS)
    if (counts == Counts::kAll || double(reference.optical_depth[p]) > kShownOpticalDepth)
#endif
      pairs.push_back({pixel_luminance(picture, p), pixel_luminance(reference, p)});
  return relative_rms(pairs);
}

}  // namespace nepho
