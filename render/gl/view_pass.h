#pragma once

#include <string>

#include "gl/object.h"
#include "gl/pixel_plan.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho::gl {

struct ViewReport {
  bool interpolates = false;
  std::string why_all;  // where it does not
  double marched_share = 1, predicted_rms = 0;
  std::size_t checks = 0;
};

// The marches of the view: all pixels, or some with the others interpolated (pixel_plan.h). Buffers
// and textures of the scene are bound; `values.met` holds the ground's distances over a planet, and
// is empty elsewhere. Returns with all of `values`.
ViewReport march_view(const RenderRequest& request, const Forest& forest, const Program& program,
                      PixelValues& values);

}  // namespace nepho::gl
