#include "reference/probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "physics/physics_cpp.h"
#include "reference/error_metric.h"
#include "reference/light_model_probe.h"
#include "reference/light_model_table.h"
#include "reference/planet_model.h"
#include "reference/ray_march.h"

namespace nepho {
namespace {

// Below the picture's own: what is finer still is left out of the term, and the line says so.
constexpr int kFinerLevels = 3, kFinerLevelsOfPlanet = 1;
constexpr std::size_t kBatch = 16;        // probes
constexpr std::size_t kLeastProbes = 64;  // before a term can be settled
constexpr double kSettled = 0.15;         // relative standard error
constexpr std::size_t kLeastFiner = 32;   // probes, before level of detail can be
constexpr double kNegligible = 0.1;       // of the integration term
constexpr std::uint64_t kManyBricks = 2000;
constexpr std::size_t kLightProbes = 32;
constexpr std::size_t kFewFiner = 16, kFinerAtOnce = 8;  // probes where each reads many

// Every second bit, from bit 0.
std::uint32_t even_bits(std::uint64_t code) {
  std::uint32_t bits = 0;
  for (int bit = 0; bit < 16; ++bit) bits |= std::uint32_t(code >> 2 * bit & 1) << bit;
  return bits;
}

// Calls with each pixel in Morton's order: neighbours on that curve are neighbours on the picture.
template <class Visit>
void each_pixel(std::uint32_t width, std::uint32_t height, const Visit& visit) {
  constexpr std::uint32_t kBlock = 64;
  // The order within a block is the same in all; blocks that are outside of the picture are passed.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> within;
  for (std::uint64_t code = 0; code < kBlock * kBlock; ++code)
    within.emplace_back(even_bits(code), even_bits(code >> 1));
  const std::uint64_t side = std::bit_ceil((std::max(width, height) + kBlock - 1) / kBlock);
  for (std::uint64_t code = 0; code < side * side; ++code) {
    const std::uint32_t left = kBlock * even_bits(code), top = kBlock * even_bits(code >> 1);
    if (left >= width || top >= height) continue;
    for (const auto& [x, y] : within)
      if (left + x < width && top + y < height) visit(left + x, top + y);
  }
}

struct Chosen {
  std::size_t pixel;
  double weight;  // pixels of which it is one
};

// One pixel of each of `count` patches of equal size; `shown` in Morton's order.
void choose(const std::vector<std::size_t>& shown, std::size_t count, std::mt19937_64& engine,
            std::vector<Chosen>& chosen) {
  const std::size_t n = std::min(shown.size(), count);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t low = s * shown.size() / n, high = (s + 1) * shown.size() / n;
    chosen.push_back({shown[low + engine() % (high - low)], double(shown.size()) / double(n)});
  }
}

// Of the pixels with some cloud; over a planet also of all others but those on the sun's disc,
// which would be most of any mean: at least half of the probes where there is cloud, as most errors
// are. Whether a pixel was marched or interpolated counts for nothing.
std::vector<Chosen> choose_pixels(const RenderRequest& request, const HdrImage& picture,
                                  const CameraRays& rays, const PlanetModel* planet) {
  std::vector<std::size_t> cloudy, clear;
  each_pixel(std::uint32_t(picture.width), std::uint32_t(picture.height),
             [&](std::uint32_t x, std::uint32_t y) {
               const std::size_t p = std::size_t(y) * std::size_t(picture.width) + x;
               const bool cloud = double(picture.optical_depth[p]) > kShownOpticalDepth;
               if (!cloud && !planet) return;
               if (planet && planet->sees_sun(rays.ray(int(x), int(y)).direction)) return;
               (cloud ? cloudy : clear).push_back(p);
             });
  const auto count = std::size_t(std::max(request.settings.probe_pixels, 0));
  const std::size_t whole = std::max<std::size_t>(cloudy.size() + clear.size(), 1);
  std::size_t of_clear = std::min(count * clear.size() / whole, (count + 1) / 2);
  if (cloudy.size() < count - of_clear) of_clear = count - cloudy.size();
  of_clear = clear.empty() ? 0 : std::clamp<std::size_t>(of_clear, 1, clear.size());
  std::vector<Chosen> chosen;
  std::mt19937_64 engine(request.settings.seed);
  choose(cloudy, count - std::min(of_clear, count), engine, chosen);
  choose(clear, of_clear, engine, chosen);
  return chosen;
}

bool holds_everything(const Forest& cut) {
  for (const VolumeTree& tree : cut.volumes)
    for (const TreeNode& node : tree.nodes)
      if (node.kind != NodeKind::kInner && node.error_bound_per_m != 0) return false;
  return true;
}

// Whether some volume goes on below what the level-of-detail term looks at.
bool reaches_deeper(const Forest& cut, int finer) {
  return std::ranges::any_of(cut.volumes, [finer](const VolumeTree& tree) {
    return tree.finest_level_used + finer < tree.source->info().lattice.max_level();
  });
}

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

struct Probe {
  double weight = 1;
  double picture = 0, cut = 0, finest = 0, noisy = 0, light_model = 0;
  bool marched = false, marched_finest = false;
};

// Whether more probes would hardly change the rms: its standard error, from the spread of squares.
bool settled(const std::vector<Probe>& probes) {
  double weights = 0, squares = 0, spread = 0;
  std::size_t count = 0;
  const auto square = [](const Probe& p) { return (p.picture - p.cut) * (p.picture - p.cut); };
  for (const Probe& p : probes) {
    if (!p.marched) continue;
    ++count;
    weights += p.weight;
    squares += p.weight * square(p);
  }
  if (count < kLeastProbes) return false;
  const double mean = squares / weights;
  for (const Probe& p : probes)
    if (p.marched) spread += p.weight * p.weight * (square(p) - mean) * (square(p) - mean);
  // Half of the mean square's: of a root.
  return 0.5 * std::sqrt(spread) / weights <= kSettled * mean;
}

// Whether finer bricks change next to nothing on the probes so far.
bool negligible(const std::vector<Probe>& probes) {
  double finer = 0, integration = 0;
  std::size_t count = 0;
  for (const Probe& p : probes) {
    if (!p.marched_finest) continue;
    ++count;
    finer += p.weight * (p.finest - p.cut) * (p.finest - p.cut);
    integration += p.weight * (p.picture - p.cut) * (p.picture - p.cut);
  }
  return count >= kLeastFiner && finer < kNegligible * kNegligible * integration;
}

bool stopped(const ProbeLimits& limits) {
  return limits.stop && *limits.stop;
}

// kLightProbes of them, evenly in their order.
std::vector<LightModelPixel> some_of(const std::vector<LightModelPixel>& pixels) {
  const std::size_t count = std::min(kLightProbes, pixels.size());
  std::vector<LightModelPixel> some;
  for (std::size_t p = 0; p < count; ++p) some.push_back(pixels[p * pixels.size() / count]);
  return some;
}

}  // namespace

ErrorEstimate estimate_error(const RenderRequest& request, const Forest& cut,
                             const HdrImage& picture, std::shared_ptr<const AirTables> tables,
                             const ProbeLimits& limits) {
  const RenderSettings& settings = request.settings;
  ErrorEstimate estimate;
  if (settings.probe_pixels <= 0) return estimate;
  std::shared_ptr<const PlanetModel> planet;
  if (request.planet) planet = std::make_shared<const PlanetModel>(request, std::move(tables));
  const CameraRays rays(request.camera, picture.width, picture.height);
  const std::vector<Chosen> pixels = choose_pixels(request, picture, rays, planet.get());
  if (pixels.empty()) return estimate;
  const auto ray_of = [&](std::size_t p) {
    const auto width = std::size_t(picture.width);
    return rays.ray(int(pixels[p].pixel % width), int(pixels[p].pixel / width));
  };

  const CutLevels cut_levels(cut);
  const NoisyCutLevels noisy_levels(cut, settings.seed);
  const int finer = planet ? kFinerLevelsOfPlanet : kFinerLevels;
  const FinestLevels finest_levels(request.volumes, limits.finest_mib, &cut, finer);
  const RayMarch cut_march(cut_levels, request, {}, planet),
      noisy_march(noisy_levels, request, {}, planet);
  std::optional<RayMarch> finest_march;
  if (!holds_everything(cut)) finest_march.emplace(finest_levels, request, MarchSettings{}, planet);
  const int octaves = settings.light == Light::kOctaves ? settings.octaves : 1;

  // In batches, each over all of the picture.
  const std::size_t batches = std::max<std::size_t>(pixels.size() / kBatch, 1);
  std::vector<Probe> probes(pixels.size());
  const auto each_of_batch = [&](std::size_t batch, const auto& work) {
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t p) {
      if (p % batches == batch && !stopped(limits)) work(p);
    });
  };
  std::size_t marched = 0;
  for (; marched < batches && !settled(probes) && !stopped(limits); ++marched)
    each_of_batch(marched, [&](std::size_t p) {
      const Ray ray = ray_of(p);
      const MarchResult exact = cut_march.trace(ray);
      Probe& probe = probes[p];
      probe.marched = true;
      probe.picture = pixel_luminance(picture, pixels[p].pixel);
      probe.weight = pixels[p].weight;
      probe.cut = luminance(exact.radiance_W_per_m2_sr_nm);
      probe.noisy = luminance(noisy_march.trace(ray).radiance_W_per_m2_sr_nm);
      probe.finest = probe.cut;
      const glm::dvec3 apart = glm::normalize(request.sun.to_sun) - ray.direction;
      probe.light_model =
          luminance(exact.scattered_W_per_m2_sr_nm) *
          light_model_error(octaves, exact.optical_depth, 0.5 * glm::dot(apart, apart));
    });

  // Over a planet until many bricks were read, as one that is worked out as it is read has no end
  // of them, or until they are seen to matter little.
  const std::size_t parts = std::max<std::size_t>(pixels.size() / batches / kFinerAtOnce, 1);
  std::size_t finer_probes = 0;
  for (std::size_t part = 0; finest_march && part < marched * parts; ++part) {
    const bool many = finer_probes >= kFewFiner && finest_levels.bricks_read() >= kManyBricks;
    if (stopped(limits) || (planet && (many || negligible(probes)))) break;
    each_of_batch(part / parts, [&](std::size_t p) {
      if (p / batches % parts != part % parts) return;
      probes[p].finest = luminance(finest_march->trace(ray_of(p)).radiance_W_per_m2_sr_nm);
      probes[p].marched_finest = true;
    });
    finer_probes = std::size_t(std::ranges::count_if(probes, &Probe::marched_finest));
  }

  if (stopped(limits)) return {};
  std::vector<PixelPair> integration, level_of_detail, quantisation, light_model;
  std::vector<LightModelPixel> light_pixels;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    const Probe& probe = probes[p];
    if (!probe.marched) continue;
    ++estimate.probe_pixels;
    integration.push_back({probe.picture, probe.cut, probe.weight});
    if (!finest_march || probe.marched_finest)
      level_of_detail.push_back({probe.cut, probe.finest, probe.weight});
    quantisation.push_back({probe.noisy, probe.cut, probe.weight});
    light_model.push_back({probe.cut + probe.light_model, probe.cut, probe.weight});
    light_pixels.push_back({ray_of(p), pixels[p].pixel, probe.cut, probe.weight});
  }
  estimate.integration = relative_rms(integration);
  estimate.level_of_detail = relative_rms(level_of_detail);
  estimate.quantisation = relative_rms(quantisation);
  estimate.light_model = relative_rms(light_model);
#ifdef NEPHO_MUTANT_THIRD_ESTIMATE
  for (double* term : {&estimate.integration, &estimate.level_of_detail, &estimate.quantisation})
    *term /= 3;
#endif
  estimate.light_model_basis = "table, slabs";
  const LightModelError measured =
      measure_light_model(cut, request, some_of(light_pixels), limits.stop);
  if (stopped(limits)) return {};
  if (measured.error >= 0) {
    estimate.light_model = measured.error;
    estimate.light_model_basis = std::to_string(measured.paths) + " paths a pixel";
  }
  if (planet) estimate.light_model_basis += "; all terms over the whole picture";
  if (reaches_deeper(cut, finer))
    estimate.light_model_basis += "; level of detail against " + std::to_string(finer) +
                                  (finer > 1 ? " finer levels" : " finer level");
  return estimate;
}

}  // namespace nepho
