#pragma once

#include <atomic>
#include <memory>

#include "air/air_tables.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho {

struct ProbeLimits {
  double finest_mib = 256;                  // for the finest bricks
  const std::atomic<bool>* stop = nullptr;  // once it is set: ends within a ray, telling nothing
};

// The error line of a picture, measured on up to settings.probe_pixels of its pixels: drawn by
// settings.seed, one from each of as many compact patches of the pixels that show some volume; over
// a planet, of all pixels but those on the sun's disc, as its air and ground are the picture too.
// Each is marched again by the CPU (ray_march.h), exactly:
//   integration       picture              against the same bricks
//   level of detail   finer bricks         against these bricks: up to three levels deeper, over a
//                     planet one, and there on fewer probes where that reads thousands of bricks
//   quantisation      these bricks + noise against these bricks (uniform, +-1/2 step; over a planet
//                     on half of the probes)
//   light model       these bricks by the light model's equations against paths through them
//                     (light_model_probe.h); with settings.probe_paths = 0 a table by optical
//                     depth and scattering angle, measured on slabs: of the clouds' light alone
// From 64 probes on, no more are marched once the standard error of the integration term is under
// 15 % of it; over a planet level of detail is left at 32 where it is under a tenth of that term.
// `tables`: of the planet's air, as the picture was made with; null: made again. Same numbers for
// any number of threads. Costs about three exact rays per probe, each with seven
// shadow rays per cell. Throws Error where a source fails.
ErrorEstimate estimate_error(const RenderRequest& request, const Forest& cut,
                             const HdrImage& picture,
                             std::shared_ptr<const AirTables> tables = nullptr,
                             const ProbeLimits& limits = {});

}  // namespace nepho
