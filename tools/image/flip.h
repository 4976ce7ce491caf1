#pragma once

#include "image/image.h"

namespace nepho {

// How different two pictures look to someone who flips between them: LDR-FLIP (Andersson et al.
// 2020, doi:10.1145/3406183), with the paper's constants and in double. 0 is the same; 1 is the
// difference of pure green and pure blue, the largest that a display can show.

// Of a 0.7 m wide display of 3840 pixels seen from 0.7 m, as in the paper: 67.02.
inline constexpr double kPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

// One channel, a value for each pixel. Beyond the picture its edge goes on. Both pictures are sRGB
// with 3 channels; `pixels_per_degree` is above 0. Throws std::invalid_argument otherwise, and
// where the sizes differ.
FloatImage flip_map(const ByteImage& picture, const ByteImage& truth,
                    double pixels_per_degree = kPixelsPerDegree);

}  // namespace nepho
