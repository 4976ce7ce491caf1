#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "reference/chart_ray.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho {

// A pixel whose light is known by the light model's own equations, exactly (ray_march.h).
struct LightModelPixel {
  Ray ray;
  std::size_t pixel = 0;
  double luminance = 0;  // W m-2 sr-1 nm-1
  double weight = 1;     // pixels for which it stands
};

struct LightModelError {
  double error = -1;        // rms of the difference over the mean of the truth; negative: no pixels
  std::uint32_t paths = 0;  // on each pixel
};

// What the light model misses: against paths (path_tracer.h) through the same bricks, with all of
// scattering, air and ground. The squares' own noise is subtracted; half of the noise of that is
// the least that is returned, as less is not known. Rounds of 8, 16, 32,
// ... paths a pixel until their noise is under 30 % of the mean square, or `settings.probe_paths`
// were sent, or the next would bring their scatterings above 20000. A path is worth 13 times the
// square of its light in noise: few pixels with many paths know more than many with few. Droplets'
// phase functions are smoothed after four scatterings ("smoothed late orders": some percent, where
// the light model misses tens). Same numbers for any number of threads. Once `stop` is set it ends
// within a path, and what it returns says nothing.
LightModelError measure_light_model(const Forest& cut, const RenderRequest& request,
                                    std::span<const LightModelPixel> pixels,
                                    const std::atomic<bool>* stop = nullptr);

}  // namespace nepho
