#pragma once

#include <span>

#include "image/image.h"
#include "scene/scene.h"

namespace nepho {

// From linear radiance to 8-bit sRGB: times 2^exposure_ev, tone map, IEC 61966-2-1, rounded. With
// `dither` an ordered 8x8 pattern of half a level breaks up the bands of a smooth sky.
ByteImage to_display(const FloatImage& radiance, double exposure_ev, ToneMap tone_map,
                     bool dither = false);

// The exposure that puts the bright end (95th percentile) of the cloud's luminance at
// kBrightCloud; pixels count where the view optical depth is above 0.1. Without a cloud, the whole
// picture counts; a black picture gets 0.
inline constexpr double kBrightCloud = 1.0;
double exposure_from(const FloatImage& radiance, std::span<const float> optical_depth);

}  // namespace nepho
