#include "reference/light_model_probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/physics_cpp.h"
#include "reference/path/path_tracer.h"

namespace nepho {
namespace {

constexpr std::uint32_t kFirstRound = 8;  // paths a pixel
constexpr double kKnown = 0.3;            // what the paths' noise may add to the mean square
constexpr std::uint64_t kMostScatterings = 20'000;
constexpr int kExactOrders = 4;
// Paths of the probe have numbers of their own: not those of a picture by the same seed.
constexpr std::uint64_t kStream = 0x6c69676874ULL;

struct Tally {
  double mean = 0, squares = 0;
  std::uint64_t scatterings = 0;
  std::uint32_t count = 0;

  void add(const PathSample& sample) {
    const glm::dvec3& c = sample.radiance_W_per_m2_sr_nm;
    const double value = f64::luminance(c.r, c.g, c.b), before = value - mean;
    ++count;
    mean += before / count;
    squares += before * (value - mean);
    scatterings += std::uint64_t(sample.scatterings);
  }
  double variance_of_mean() const { return squares / (double(count) - 1) / count; }
};

struct MeanSquare {
  double value = 0, luminance = 0;
  double noise = 0;  // of the paths: its standard error on these pixels
};

// Of the differences without their noise, each unbiased and of either sign.
MeanSquare mean_square(std::span<const LightModelPixel> pixels, const std::vector<Tally>& tallies) {
  const auto square = [&](std::size_t p) {
    const double apart = pixels[p].luminance - tallies[p].mean;
    return apart * apart - tallies[p].variance_of_mean();
  };
  MeanSquare result;
  double weights = 0, noise = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    weights += pixels[p].weight;
    result.value += pixels[p].weight * square(p);
    result.luminance += pixels[p].weight * tallies[p].mean;
  }
  result.value /= weights;
  result.luminance /= weights;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    // Of a normal variable's square about its mean.
    const double own = tallies[p].variance_of_mean();
    noise += pixels[p].weight * pixels[p].weight * own * (2 * own + 4 * std::max(square(p), 0.0));
  }
  result.noise = std::sqrt(noise) / weights;
  return result;
}

}  // namespace

LightModelError measure_light_model(const Forest& cut, const RenderRequest& request,
                                    std::span<const LightModelPixel> pixels,
                                    const std::atomic<bool>* stop) {
  const auto most = std::uint32_t(std::max(request.settings.probe_paths, 0));
  if (pixels.empty() || most < 2) return {};
  const PathTracer tracer(cut, request, {.exact_orders = kExactOrders});
  std::vector<Tally> tallies(pixels.size());
  std::uint32_t done = 0;
  MeanSquare found;
  for (std::uint32_t end = std::min(kFirstRound, most);; end = std::min(2 * end, most)) {
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t p) {
      for (std::uint32_t s = done; s < end; ++s) {
        if (stop && *stop) return;
        Random random(request.settings.seed ^ kStream, pixels[p].pixel, s);
        tallies[p].add(tracer.sample(pixels[p].ray, random));
      }
    });
    done = end;
    if (stop && *stop) return {};
    found = mean_square(pixels, tallies);
    std::uint64_t scatterings = 0;
    for (const Tally& tally : tallies) scatterings += tally.scatterings;
    if (done == most || 2 * scatterings > kMostScatterings) break;
    if (found.noise <= kKnown * found.value) break;
  }
  if (!(found.luminance > 0)) return {.error = -1, .paths = done};
  return {std::sqrt(std::max(found.value, 0.5 * found.noise)) / found.luminance, done};
}

}  // namespace nepho
