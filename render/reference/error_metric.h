#pragma once

#include <cstdint>
#include <span>

#include "renderer.h"

namespace nepho {

// The error of a picture (lattice.md 9), one function for whoever speaks of it: rms of the
// difference in linear luminance over the pixels that show some volume, over those pixels' mean
// luminance in the reference.
inline constexpr double kShownOpticalDepth = 0.01;  // a pixel counts above it

struct PixelPair {
  double luminance, reference;
  double weight = 1;  // how many pixels it stands for
};
// Of pixels that count. Negative where there are none; infinite where the reference is black and
// the picture is not.
double relative_rms(std::span<const PixelPair> pixels);

// Pixels count by the reference's optical depth, or all of them: over a planet there is no nothing.
// Throws std::invalid_argument where sizes differ.
enum class Counts : std::uint8_t { kWithCloud, kAll };
double picture_error(const HdrImage& picture, const HdrImage& reference,
                     Counts counts = Counts::kWithCloud);

double pixel_luminance(const HdrImage& picture, std::size_t pixel);

}  // namespace nepho
