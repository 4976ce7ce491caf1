#pragma once

#include <tbb/parallel_for.h>

#include "reference/ray_march.h"

namespace nepho::test {

// The whole picture by the reference march: exact, and slow.
inline HdrImage march_picture(const LevelSet& levels, const RenderRequest& request,
                              MarchSettings settings = {}) {
  const RayMarch march(levels, request, std::move(settings));
  HdrImage image;
  image.width = request.settings.width;
  image.height = request.settings.height;
  const auto pixels = std::size_t(image.width * image.height);
  image.rgb.resize(3 * pixels);
  image.optical_depth.resize(pixels);
  tbb::parallel_for(std::size_t{0}, pixels, [&](std::size_t p) {
    const MarchResult seen = march.trace(camera_ray(request.camera, image.width, image.height,
                                                    int(p) % image.width, int(p) / image.width));
    for (std::size_t c = 0; c < 3; ++c)
      image.rgb[3 * p + c] = float(seen.radiance_W_per_m2_sr_nm[int(c)]);
    image.optical_depth[p] = float(seen.optical_depth);
  });
  return image;
}

}  // namespace nepho::test
