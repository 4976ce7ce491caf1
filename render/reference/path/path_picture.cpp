#include "reference/path/path_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "physics/physics_cpp.h"
#include "reference/ray_march.h"

namespace nepho {
namespace {

constexpr std::uint32_t kFirstCheck = 8, kLongestCheck = 128;  // samples, of noise
constexpr double kRound_s = 1;

// Sums over one pixel's samples. Welford's, so that many samples of nearly the same do not cancel.
struct Tally {
  glm::dvec3 mean{0.0};
  double luminance = 0, squares = 0, scattered = 0;
  std::uint32_t samples = 0;

  void add(const PathSample& sample) {
    ++samples;
    const glm::dvec3& c = sample.radiance_W_per_m2_sr_nm;
    mean += (c - mean) / double(samples);
    const double before = f64::luminance(c.r, c.g, c.b) - luminance;
    luminance += before / samples;
    squares += before * (f64::luminance(c.r, c.g, c.b) - luminance);
    scattered += sample.scatterings > 0;
  }
  double standard_error() const {
    return samples < 2 ? 0 : std::sqrt(squares / (double(samples) - 1) / samples);
  }
};

PathPicture picture_of(const std::vector<Tally>& tallies, int width, int height) {
  PathPicture picture;
  picture.image.width = width;
  picture.image.height = height;
  double variance = 0, luminance = 0;
  for (const Tally& tally : tallies) {
    for (int c = 0; c < 3; ++c) picture.image.rgb.push_back(float(tally.mean[c]));
    // Of the part of the paths that meet something, the depth of it: an estimate, for masks.
    const double part = tally.scattered / std::max(tally.samples, 1u);
    picture.image.optical_depth.push_back(
        float(-std::log(std::max(1 - part, 0.5 / std::max(tally.samples, 1u)))));
    picture.standard_error.push_back(float(tally.standard_error()));
    variance += tally.standard_error() * tally.standard_error();
    luminance += tally.luminance;
  }
  const double n = double(tallies.size());
  picture.samples = tallies.front().samples;
  picture.noise = luminance > 0 ? std::sqrt(variance / n) / (luminance / n) : 0;
  return picture;
}

}  // namespace

PathPicture path_trace(const PathTracer& tracer, const RenderRequest& request, const PathGoal& goal,
                       const PathStop& stop) {
  if (!goal.samples && !(goal.noise > 0))
    throw std::invalid_argument("path_trace: neither samples nor noise to reach");
  const RenderSettings& settings = request.settings;
  const int width = settings.width, height = settings.height;
  std::vector<Tally> tallies(std::size_t(width) * std::size_t(height));
  std::uint32_t done = 0, next_check = kFirstCheck, round = 1;
  while (true) {
    // Rounds are as long as a user waits; where noise is looked at does not depend on them, nor on
    // the machine.
    const std::uint32_t last = goal.samples ? std::min(next_check, goal.samples) : next_check;
    const std::uint32_t end = std::min(done + round, last);
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(std::size_t{0}, tallies.size(), [&](std::size_t pixel) {
      const Ray ray = camera_ray(request.camera, width, height, int(pixel % std::size_t(width)),
                                 int(pixel / std::size_t(width)));
      for (std::uint32_t s = done; s < end; ++s) {
        Random random(settings.seed, pixel, s);
        tallies[pixel].add(tracer.sample(ray, random));
      }
    });
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (spent.count() < kRound_s / 2) round *= 2;
    if (spent.count() > kRound_s) round = std::max(round / 2, 1u);
    done = end;
    PathPicture picture = picture_of(tallies, width, height);
    if (goal.samples && done >= goal.samples) return picture;
    if (done == next_check) {
      if (goal.noise > 0 && picture.noise <= goal.noise) return picture;
      next_check += std::min(next_check, kLongestCheck);
    }
    if (stop && stop(picture)) {
      picture.stopped = true;
      return picture;
    }
  }
}

Forest finest_forest(const RenderRequest& request, double budget_mib) {
  Refinement refinement;
  refinement.camera = request.camera;
  refinement.settings = request.settings;
  refinement.settings.pixels_per_voxel = 0;
  refinement.settings.tolerance = 0;
  refinement.settings.budget_mib = budget_mib;
  refinement.cost.node_bytes = sizeof(TreeNode) + Leaves::kNodeBytes;
  refinement.cost.brick_bytes = sizeof(LeafBrick);
  Forest forest = build_forest(request.volumes, refinement);
  if (forest.budget_bound)
    throw Error({.what = "the finest level does not fit into memory",
                 .where = "path tracer",
                 .expected = "more than " + std::to_string(budget_mib) + " MiB",
                 .found = "refinement stopped there",
                 .hint = "raise --budget-mib, or set --max-level for a coarser reference"});
  return forest;
}

}  // namespace nepho
