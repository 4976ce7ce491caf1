#pragma once

#include <functional>
#include <vector>

#include "reference/path/path_tracer.h"

namespace nepho {

// A picture by paths through the middles of its pixels, as the renderer's. Same bits for any number
// of threads: each sample has random numbers of its own, and sums run in the order of samples.
struct PathPicture {
  HdrImage image;                     // means; the optical depth is zero where nothing scattered
  std::vector<float> standard_error;  // of the mean luminance, 1 per pixel
  std::uint32_t samples = 0;          // per pixel
  double noise = -1;                  // rms of the standard errors over the mean luminance
  bool stopped = false;               // before what was asked for
};

struct PathGoal {
  std::uint32_t samples = 0;  // per pixel; 0: by `noise` alone
  double noise = 0;           // as PathPicture::noise; 0: by `samples` alone
};
// Asked about every second with what there is so far; true: enough, keep that.
using PathStop = std::function<bool(const PathPicture&)>;

// Until the goal is met; noise is looked at after 8, 16, 32, ... samples. Throws
// std::invalid_argument without a goal.
PathPicture path_trace(const PathTracer& tracer, const RenderRequest& request, const PathGoal& goal,
                       const PathStop& stop);

// The forest that holds the finest level of each source, or the coarsest that is the same (no error
// bound left), within `budget_mib` of host memory. Throws Error, with what would be enough, where
// that is too little.
Forest finest_forest(const RenderRequest& request, double budget_mib);

}  // namespace nepho
