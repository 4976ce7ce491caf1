#pragma once

#include <cstdint>
#include <memory>

#include "bricks/surface_map.h"

namespace nepho::noise {

// Continents: fractal noise on the sphere above the level that leaves `land` (0..1) of its area
// dry, on a grid of half a degree. Flat, at height 0. Null where land is 0: all is sea.
std::shared_ptr<const SurfaceMap> make_land(double land, std::uint32_t seed);

}  // namespace nepho::noise
