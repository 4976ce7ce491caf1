#pragma once

#include "gl/pixel_march.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho::gl {

// The marches of the view: all pixels, or some with the others interpolated (pixel_plan.h). Buffers
// and textures of the scene are bound; `values.met` holds the ground's distances over a planet, and
// is empty elsewhere. Returns with all of `values`.
PixelReport march_view(const RenderRequest& request, const Forest& forest, const Program& program,
                       PixelValues& values);

}  // namespace nepho::gl
