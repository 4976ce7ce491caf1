#pragma once

#include <vector>

#include "gl/pixel_plan.h"

namespace nepho {

// How far from the eye what each pixel shows is, m: the cloud where it hides enough, else the
// ground; kNoGround_m where there is neither. `values.met` has the ground of a planet.
std::vector<float> seen_distances(const gl::PixelValues& values, bool planet);

}  // namespace nepho
