#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gl/pixel_plan.h"
#include "renderer.h"

namespace nepho::gl {

struct MarchCounters {  // march.glsl: CounterBuffer
  std::uint32_t overruns = 0, rays = 0, extinction_samples = 0, source_samples = 0;
};

// Does `work`, waits for its end, and adds what it cost. Throws Error where OpenGL reports one.
void timed(std::vector<PassReport>& passes, const char* name, const std::function<void()>& work);

HdrImage picture_of(const PixelValues& values, int width, int height);

}  // namespace nepho::gl
