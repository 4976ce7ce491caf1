#pragma once

#include "image/image.h"

namespace nepho {

// How far apart two 8-bit pictures are, over all pixels and channels.
struct ByteDifference {
  double rmse = 0;     // root of the mean square, 0 to 255
  double psnr_db = 0;  // 20 log10(255 / rmse); infinite where they are the same
  int largest = 0;
};
// Throws std::invalid_argument where sizes or channels differ.
ByteDifference byte_difference(const ByteImage& picture, const ByteImage& truth);

double mean_of(const FloatImage& map);
double largest_of(const FloatImage& map);

// Maps as colours that are straight lines in CIELAB with even steps of lightness, so that equal
// differences look equally large. Values beyond the ends take the ends' colours.
// From black (0) through violet and red to pale yellow (`full`).
ByteImage error_colours(const FloatImage& map, double full);
// From blue (-full) through almost white (0) to red (full).
ByteImage signed_colours(const FloatImage& map, double full);

// A round number (1, 2 or 5 times a power of ten) that is not below 99 % of the values' sizes;
// 1 where all are 0.
double round_scale(const FloatImage& map);

}  // namespace nepho
