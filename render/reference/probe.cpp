#include "reference/probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "physics/physics_cpp.h"
#include "reference/error_metric.h"
#include "reference/light_model_table.h"
#include "reference/planet_model.h"
#include "reference/ray_march.h"

namespace nepho {
namespace {

constexpr double kFinestCache_MiB = 256;
// Below the picture's own: what is finer still is left out of the term, and the line says so.
constexpr int kFinerLevels = 3;

// Neighbours on the picture are neighbours on this curve.
std::uint64_t morton(std::uint32_t x, std::uint32_t y) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 16; ++bit)
    code |= std::uint64_t(x >> bit & 1) << 2 * bit | std::uint64_t(y >> bit & 1) << (2 * bit + 1);
  return code;
}

Ray pixel_ray(const RenderRequest& request, const HdrImage& picture, std::size_t pixel) {
  const auto width = std::size_t(picture.width);
  return camera_ray(request.camera, picture.width, picture.height, int(pixel % width),
                    int(pixel / width));
}

struct Chosen {
  std::size_t pixel;
  double weight;  // pixels of which it is one
};

// One pixel of each of `count` patches of equal size.
void choose(std::vector<std::size_t> shown, std::size_t width, std::size_t count,
            std::mt19937_64& engine, std::vector<Chosen>& chosen) {
  std::ranges::sort(shown, {}, [&](std::size_t p) {
    return morton(std::uint32_t(p % width), std::uint32_t(p / width));
  });
  const std::size_t n = std::min(shown.size(), count);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t low = s * shown.size() / n, high = (s + 1) * shown.size() / n;
    chosen.push_back({shown[low + engine() % (high - low)], double(shown.size()) / double(n)});
  }
}

// Of the pixels with some cloud; over a planet also of all others but those on the sun's disc,
// which would be most of any mean: at least half of the probes where there is cloud, as most errors
// are.
std::vector<Chosen> choose_pixels(const RenderRequest& request, const HdrImage& picture,
                                  const PlanetModel* planet) {
  std::vector<std::size_t> cloudy, clear;
  for (std::size_t p = 0; p < picture.optical_depth.size(); ++p) {
    if (planet && planet->sees_sun(pixel_ray(request, picture, p).direction)) continue;
    if (double(picture.optical_depth[p]) > kShownOpticalDepth)
      cloudy.push_back(p);
    else if (planet)
      clear.push_back(p);
  }
  const auto width = std::size_t(picture.width);
  const auto count = std::size_t(std::max(request.settings.probe_pixels, 0));
  const std::size_t whole = std::max<std::size_t>(cloudy.size() + clear.size(), 1);
  std::size_t of_clear = std::min(count * clear.size() / whole, (count + 1) / 2);
  if (cloudy.size() < count - of_clear) of_clear = count - cloudy.size();
  of_clear = clear.empty() ? 0 : std::clamp<std::size_t>(of_clear, 1, clear.size());
  std::vector<Chosen> chosen;
  std::mt19937_64 engine(request.settings.seed);
  choose(std::move(cloudy), width, count - std::min(of_clear, count), engine, chosen);
  choose(std::move(clear), width, of_clear, engine, chosen);
  return chosen;
}

bool holds_everything(const Forest& cut) {
  for (const VolumeTree& tree : cut.volumes)
    for (const TreeNode& node : tree.nodes)
      if (node.kind != NodeKind::kInner && node.error_bound_per_m != 0) return false;
  return true;
}

// Whether some volume goes on below what the level-of-detail term looks at.
bool reaches_deeper(const Forest& cut) {
  return std::ranges::any_of(cut.volumes, [](const VolumeTree& tree) {
    return tree.finest_level_used + kFinerLevels < tree.source->info().lattice.max_level();
  });
}

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

struct Probe {
  double weight = 1;
  double picture = 0, cut = 0, finest = 0, noisy = 0, light_model = 0;
};

}  // namespace

ErrorEstimate estimate_error(const RenderRequest& request, const Forest& cut,
                             const HdrImage& picture, std::shared_ptr<const AirTables> tables) {
  const RenderSettings& settings = request.settings;
  ErrorEstimate estimate;
  if (settings.probe_pixels <= 0) return estimate;
  std::shared_ptr<const PlanetModel> planet;
  if (request.planet) planet = std::make_shared<const PlanetModel>(request, std::move(tables));
  const std::vector<Chosen> pixels = choose_pixels(request, picture, planet.get());
  estimate.probe_pixels = int(pixels.size());
  if (pixels.empty()) return estimate;

  const CutLevels cut_levels(cut);
  const NoisyCutLevels noisy_levels(cut, settings.seed);
  const FinestLevels finest_levels(request.volumes, kFinestCache_MiB, &cut, kFinerLevels);
  const RayMarch cut_march(cut_levels, request, {}, planet),
      noisy_march(noisy_levels, request, {}, planet);
  std::optional<RayMarch> finest_march;
  if (!holds_everything(cut)) finest_march.emplace(finest_levels, request, MarchSettings{}, planet);
  const int octaves = settings.light == Light::kOctaves ? settings.octaves : 1;

  std::vector<Probe> probes(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t p) {
    const Ray ray = pixel_ray(request, picture, pixels[p].pixel);
    const MarchResult exact = cut_march.trace(ray);
    Probe& probe = probes[p];
    probe.picture = pixel_luminance(picture, pixels[p].pixel);
    probe.weight = pixels[p].weight;
    probe.cut = luminance(exact.radiance_W_per_m2_sr_nm);
    probe.noisy = luminance(noisy_march.trace(ray).radiance_W_per_m2_sr_nm);
    probe.finest =
        finest_march ? luminance(finest_march->trace(ray).radiance_W_per_m2_sr_nm) : probe.cut;
    const glm::dvec3 apart = glm::normalize(request.sun.to_sun) - ray.direction;
    probe.light_model =
        luminance(exact.scattered_W_per_m2_sr_nm) *
        light_model_error(octaves, exact.optical_depth, 0.5 * glm::dot(apart, apart));
  });

  std::vector<PixelPair> integration, level_of_detail, quantisation, light_model;
  for (const Probe& probe : probes) {
    integration.push_back({probe.picture, probe.cut, probe.weight});
    level_of_detail.push_back({probe.cut, probe.finest, probe.weight});
    quantisation.push_back({probe.noisy, probe.cut, probe.weight});
    light_model.push_back({probe.cut + probe.light_model, probe.cut, probe.weight});
  }
  estimate.integration = relative_rms(integration);
  estimate.level_of_detail = relative_rms(level_of_detail);
  estimate.quantisation = relative_rms(quantisation);
  estimate.light_model = relative_rms(light_model);
  estimate.light_model_basis =
      planet ? "table, slabs; all terms over the whole picture" : "table, slabs";
  if (reaches_deeper(cut))
    estimate.light_model_basis +=
        "; level of detail against " + std::to_string(kFinerLevels) + " finer levels";
  return estimate;
}

}  // namespace nepho
