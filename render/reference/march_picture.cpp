#include "reference/march_picture.h"

#include <tbb/parallel_for.h>

#include <mutex>
#include <numeric>

namespace nepho {

std::vector<MarchResult> march_pixels(const RayMarch& march, const RenderRequest& request,
                                      std::span<const std::size_t> pixels,
                                      const MarchProgress& progress) {
  const RenderSettings& settings = request.settings;
  const CameraRays rays(request.camera, settings.width, settings.height);
  const auto width = std::size_t(settings.width);
  std::vector<MarchResult> seen(pixels.size());
  std::mutex telling;
  std::size_t done = 0;
  // Rays differ by a hundred in their cost: few at a time.
  constexpr std::size_t kGrain = 16;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pixels.size(), kGrain), [&](const auto& range) {
        for (std::size_t p = range.begin(); p < range.end(); ++p)
          seen[p] = march.trace(rays.ray(int(pixels[p] % width), int(pixels[p] / width)));
        if (!progress) return;
        const std::lock_guard lock(telling);
        done += range.size();
        progress(done);
      });
  return seen;
}

HdrImage march_picture(const RayMarch& march, const RenderRequest& request,
                       const MarchProgress& progress) {
  HdrImage image{request.settings.width, request.settings.height, {}, {}};
  std::vector<std::size_t> pixels(std::size_t(image.width) * std::size_t(image.height));
  std::iota(pixels.begin(), pixels.end(), std::size_t{0});
  image.rgb.reserve(3 * pixels.size());
  image.optical_depth.reserve(pixels.size());
  for (const MarchResult& seen : march_pixels(march, request, pixels, progress)) {
    for (int c = 0; c < 3; ++c) image.rgb.push_back(float(seen.radiance_W_per_m2_sr_nm[c]));
    image.optical_depth.push_back(float(seen.optical_depth));
  }
  return image;
}

HdrImage march_picture(const LevelSet& levels, const RenderRequest& request,
                       MarchSettings settings) {
  return march_picture(RayMarch(levels, request, std::move(settings)), request);
}

}  // namespace nepho
