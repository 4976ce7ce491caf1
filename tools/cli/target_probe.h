#pragma once

#include <set>
#include <string>

#include "cli/target_search.h"
#include "renderer.h"

namespace nepho {

// Settings measured on a small picture of the same view with the same tree: as many times fewer
// pixels as voxels have fewer of them. Its light passes are those of the whole picture, its view
// costs up to 64 times less. Needs a current OpenGL context; throws Error as render() does.
class TargetProbe {
 public:
  // `times`: frame times are wanted too; shaders are then compiled before they are measured.
  TargetProbe(const RenderRequest& request, bool times);

  // The cheapest: its memory is the least of 1, 4, 16, ... MiB that holds the scene's roots.
  TargetSetting first();
  TargetMeasure measure(const TargetSetting& setting);
  // "CPU" or "GPU": whose time frame_ms is, of the last measurement.
  const std::string& clock() const { return clock_; }

 private:
  RenderRequest small(const TargetSetting& setting, int shrink) const;

  const RenderRequest& request_;
  bool times_;
  int shrink_ = 1;
  std::set<std::string> compiled_;
  std::string clock_ = "CPU";
};

// The whole picture's settings with a choice in them.
RenderSettings with_setting(RenderSettings settings, const TargetSetting& setting);

// Light passes and view, ms: of the GPU's clock where every pass has its time, else process CPU
// time (`clock`: which). `more_pixels`: of the picture that is meant, over this one's.
struct FrameTime {
  double ms = 0;
  const char* clock = "CPU";
};
FrameTime frame_time(const RenderReport& report, double more_pixels = 1);

}  // namespace nepho
