#pragma once

#include <glm/glm.hpp>
#include <span>

#include "image/image.h"
#include "scene/scene.h"

namespace nepho {

// From linear radiance to 8-bit sRGB: balanced so that `white` is grey, times 2^exposure_ev, tone
// map, IEC 61966-2-1, rounded. With `dither` an ordered 8x8 pattern of half a level breaks up the
// bands of a smooth sky. A planet's light is that of the sun outside its air: there it is `white`.
ByteImage to_display(const FloatImage& radiance, double exposure_ev, ToneMap tone_map,
                     bool dither = false, const glm::dvec3& white = glm::dvec3(1));

// The `white` of a scene that was drawn: a planet's sun, else 1.
glm::dvec3 display_white(const Scene& scene);

// The exposure that puts the bright end (95th percentile) of the cloud's luminance at
// kBrightCloud; pixels count where the view optical depth is above 0.1. Without a cloud, the whole
// picture counts; a black picture gets 0.
inline constexpr double kBrightCloud = 1.0;
double exposure_from(const FloatImage& radiance, std::span<const float> optical_depth);

// The same on a planet, where there is sky and ground, and perhaps a night side. `white` is the
// luminance of a white surface in this sun. Clouds in the dark (below a tenth of the picture's
// bright end, but for what only glint reaches) do not count; a grey sky stays grey, as no cloud is
// brought up by more than kGreyCloud's inverse; and where there is next to no cloud, what counts is
// the white surface, or the bright end of the picture where that is brighter: a low sun.
inline constexpr double kGreyCloud = 0.4;
double exposure_on_planet(const FloatImage& radiance, std::span<const float> optical_depth,
                          double white);

}  // namespace nepho
