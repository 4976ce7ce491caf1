#pragma once

#include <glm/glm.hpp>

namespace nepho {

// Colours of a display with Rec. 709 primaries, white D65. Light is linear, 0 to 1.

// The inverse of physics' srgb_encode: IEC 61966-2-1, value in [0, 1].
double srgb_decode(double value);

// CIE XYZ over that of white (so that white is 1, 1, 1), and back.
glm::dvec3 xyz_of(const glm::dvec3& linear);
glm::dvec3 linear_of_xyz(const glm::dvec3& xyz);

// CIELAB (CIE 15:2004): L* 0 to 100. `linear_of_lab` may leave [0, 1] where the display has no
// such colour.
glm::dvec3 lab_of(const glm::dvec3& linear);
glm::dvec3 linear_of_lab(const glm::dvec3& lab);

}  // namespace nepho
