#pragma once

#include "gl/frame_data.h"
#include "gl/pixel_march.h"
#include "gl/planet_data.h"
#include "tree/forest.h"

namespace nepho::gl {

// Adds the light of what is behind all air and cloud to `values.seen`, through `values.met`: of the
// ground in all pixels that show some, or in some of them with the others interpolated
// (pixel_plan.h); elsewhere of the night sky and the sun's disc. `program`: of ground.comp; buffers
// and textures of the scene are bound.
PixelReport light_ground(const RenderRequest& request, const Forest& forest, const FrameData& frame,
                         const PlanetScene& planet, const Program& program, PixelValues& values);

}  // namespace nepho::gl
