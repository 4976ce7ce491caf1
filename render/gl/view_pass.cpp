#include "gl/view_pass.h"

#include <optional>

#include "gl/pixel_strides.h"

namespace nepho::gl {

PixelReport march_view(const RenderRequest& request, const Forest& forest, const Program& program,
                       PixelValues& values) {
  const int width = request.settings.width, height = request.settings.height;
  PixelReport report;
  report.why_all = why_all_pixels(request);
  if (report.why_all.empty()) {
    PixelPlan plan({width, height, request.settings.tolerance, pixel_strides(request, forest)},
                   values);
    if (!plan.saves_little()) {
      values.seen.resize(values.met.size());
      if (request.keep_depths) values.depths.resize(values.met.size());
      // Where the eye is below the clouds' tops, every ray misses.
      std::optional<FrontAir> front;
      if (request.planet->air) {
        front.emplace(width, height, request.settings.tolerance);
        march_front(program, *front);
      }
      PixelValues found;
      for (auto list = plan.next(found, values); !list.empty(); list = plan.next(found, values))
        found = march_pixels(program, list, width, values, front ? &*front : nullptr,
                             request.keep_depths);
      report.interpolates = true;
      report.marched_share = plan.marched_share();
      report.predicted_rms = plan.predicted_rms();
      report.checks = plan.checks();
      return report;
    }
    report.why_all = "the smallest voxels are no wider than a pixel, or the picture is small";
  }
  const std::vector<std::uint32_t> list = all_pixels(width, height);
  const PixelValues found =
      march_pixels(program, list, width, values, nullptr, request.keep_depths);
  values.seen.resize(list.size());
  values.met.resize(list.size());
  if (request.keep_depths) values.depths.resize(list.size());
  for (std::size_t n = 0; n < list.size(); ++n) {
    if (request.keep_depths) values.depths[list[n]] = found.depths[n];
    values.seen[list[n]] = found.seen[n];
    values.met[list[n]] = found.met[n];
  }
  return report;
}

}  // namespace nepho::gl
