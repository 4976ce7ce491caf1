#include "cli/target_probe.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.h"
#include "gl/frame_data.h"
#include "tree/forest.h"

namespace nepho {
namespace {

constexpr int kMostShrink = 8, kLeastPixels = 3000;
constexpr int kProbes = 48;
constexpr double kCheapestTolerance = 0.3, kLargestFirst_mib = 1024;

// Passes of a frame whose time goes with the pixels, and those whose time does not.
constexpr std::array<std::string_view, 3> kByPixel = {"surface", "view", "ground"};
constexpr std::array<std::string_view, 4> kByTree = {"sun depth", "sky visibility",
                                                     "light of clear samples", "sun map"};

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + '\n';
  return all;
}

}  // namespace

FrameTime frame_time(const RenderReport& report, double more_pixels) {
  double cpu_s = 0, gpu_s = 0;
  bool gpu = true;
  for (const PassReport& pass : report.passes) {
    const bool by_pixel = std::ranges::count(kByPixel, pass.name) > 0;
    if (!by_pixel && std::ranges::count(kByTree, pass.name) == 0) continue;
    const double times = by_pixel ? more_pixels : 1;
    cpu_s += times * pass.cpu_s;
    gpu_s += times * pass.gpu_s;
    gpu = gpu && pass.gpu_s >= 0;
  }
  return gpu ? FrameTime{1e3 * gpu_s, "GPU"} : FrameTime{1e3 * cpu_s, "CPU"};
}

RenderSettings with_setting(RenderSettings settings, const TargetSetting& setting) {
  settings.step_voxels.reset();
  settings.tolerance = setting.tolerance;
  settings.budget_mib = setting.budget_mib;
  settings.pixels_per_voxel = setting.pixels_per_voxel;
  return settings;
}

TargetProbe::TargetProbe(const RenderRequest& request, bool times)
    : request_(request), times_(times) {
  const auto pixels = [&](int shrink) {
    return (request.settings.width / shrink) * (request.settings.height / shrink);
  };
  while (shrink_ < kMostShrink && pixels(2 * shrink_) >= kLeastPixels) shrink_ *= 2;
}

RenderRequest TargetProbe::small(const TargetSetting& setting, int shrink) const {
  RenderRequest request = request_;
  RenderSettings& settings = request.settings;
  settings = with_setting(settings, setting);
  settings.width = std::max(settings.width / shrink, 1);
  settings.height = std::max(settings.height / shrink, 1);
  settings.pixels_per_voxel /= shrink;  // the same tree
  settings.probe_pixels = std::min(settings.probe_pixels, kProbes);
  settings.probe_paths = 0;  // the light model is none of the settings
  return request;
}

TargetSetting TargetProbe::first() {
  TargetSetting setting{kCheapestTolerance, 1, request_.settings.pixels_per_voxel};
  while (true) {
    const RenderRequest request = small(setting, shrink_);
    try {
      build_forest(request.volumes, gl::refinement_of(request));
      break;
    } catch (const Error& error) {
      if (error.parts().where != "budget" || setting.budget_mib >= kLargestFirst_mib) throw;
      setting.budget_mib *= 4;
    }
  }
  return setting;
}

TargetMeasure TargetProbe::measure(const TargetSetting& setting) {
  RenderResult result = render(small(setting, shrink_));
  // Compiled just now: the passes' times are not those of a frame.
  if (times_ && compiled_.insert(joined(result.report.shader_switches)).second)
    result = render(small(setting, shrink_));
  const auto of = [](const RenderSettings& s) { return double(s.width) * double(s.height); };
  const FrameTime time =
      frame_time(result.report, of(request_.settings) / of(small(setting, shrink_).settings));
  clock_ = time.clock;
  return {.setting = setting,
          .integration = std::max(result.error.integration, 0.0),
          .level_of_detail = std::max(result.error.level_of_detail, 0.0),
          .quantisation = std::max(result.error.quantisation, 0.0),
          .frame_ms = time.ms,
          .budget_bound = result.report.budget_bound};
}

}  // namespace nepho
