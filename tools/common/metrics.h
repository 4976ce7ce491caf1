#pragma once

#include <array>
#include <vector>

#include "renderer.h"

namespace nepho {

// How far a picture is from the truth. All in linear light unless said.
struct PictureDifference {
  double relative_rms = -1;  // of luminance where there is cloud: the error line's measure
                             // (reference/error_metric.h); -1 where no pixel shows any
  double relative_mse = 0;   // mean over pixels and channels of (a - b)^2 / (b^2 + floor^2)
  double relative_mse_luminance = 0;
  std::array<double, 3> relative_mse_rgb{};  // their mean is relative_mse
  double bias = 0;                           // mean luminance over the truth's, minus 1
  std::array<double, 3> bias_rgb{};          // the same of each channel
  double largest = 0;                        // largest |a - b| of a channel
  bool same_bits = true;
};
// The floor keeps black pixels from ruling the mean: 1 % of the truth's mean over its channels, of
// its mean luminance for luminance. Over a truth that is black all ratios but those of the same
// pixels are infinite. Throws Error where the sizes differ or a value is not finite.
PictureDifference difference(const HdrImage& picture, const HdrImage& truth);

// (a - b) / sqrt(b^2 + floor^2) of each pixel's luminance: its mean square is
// relative_mse_luminance. Throws Error where the sizes differ.
std::vector<double> relative_luminance_differences(const HdrImage& picture, const HdrImage& truth);

}  // namespace nepho
