#pragma once

#include "renderer.h"

namespace nepho {

// How far a picture is from the truth. All in linear light unless said.
struct PictureDifference {
  double relative_rms = -1;  // of luminance where there is cloud: the error line's measure
                             // (reference/error_metric.h); -1 where no pixel shows any
  double relative_mse = 0;   // mean over pixels and channels of (a - b)^2 / (b^2 + floor^2)
  double bias = 0;           // mean luminance over the truth's, minus 1
  double largest = 0;        // largest |a - b| of a channel
  bool same_bits = true;
};
// The floor keeps black pixels from ruling the mean: 1 % of the truth's mean over its channels.
// Throws Error where the sizes differ or a value is not finite.
PictureDifference difference(const HdrImage& picture, const HdrImage& truth);

}  // namespace nepho
