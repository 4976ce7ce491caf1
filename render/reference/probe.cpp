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

// Those that count: with some cloud, or, over a planet, all but those on the sun's disc, which
// would be most of any mean.
std::vector<std::size_t> counted_pixels(const RenderRequest& request, const HdrImage& picture,
                                        const PlanetModel* planet) {
  std::vector<std::size_t> pixels;
  for (std::size_t p = 0; p < picture.optical_depth.size(); ++p) {
    const bool counts = planet ? !planet->sees_sun(pixel_ray(request, picture, p).direction)
                               : double(picture.optical_depth[p]) > kShownOpticalDepth;
    if (counts) pixels.push_back(p);
  }
  return pixels;
}

// One pixel of each of `count` patches of equal size.
std::vector<std::size_t> choose_pixels(std::vector<std::size_t> shown, const HdrImage& picture,
                                       int count, std::uint64_t seed) {
  const auto width = std::size_t(picture.width);
  std::ranges::sort(shown, {}, [&](std::size_t p) {
    return morton(std::uint32_t(p % width), std::uint32_t(p / width));
  });
  const std::size_t n = std::min(shown.size(), std::size_t(std::max(count, 0)));
  std::vector<std::size_t> chosen;
  std::mt19937_64 engine(seed);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t low = s * shown.size() / n, high = (s + 1) * shown.size() / n;
    chosen.push_back(shown[low + engine() % (high - low)]);
  }
  return chosen;
}

bool holds_everything(const Forest& cut) {
  for (const VolumeTree& tree : cut.volumes)
    for (const TreeNode& node : tree.nodes)
      if (node.kind != NodeKind::kInner && node.error_bound_per_m != 0) return false;
  return true;
}

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

struct Probe {
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
  const std::vector<std::size_t> pixels =
      choose_pixels(counted_pixels(request, picture, planet.get()), picture, settings.probe_pixels,
                    settings.seed);
  estimate.probe_pixels = int(pixels.size());
  if (pixels.empty()) return estimate;

  const CutLevels cut_levels(cut);
  const NoisyCutLevels noisy_levels(cut, settings.seed);
  const FinestLevels finest_levels(request.volumes, kFinestCache_MiB);
  const RayMarch cut_march(cut_levels, request, {}, planet),
      noisy_march(noisy_levels, request, {}, planet);
  std::optional<RayMarch> finest_march;
  if (!holds_everything(cut)) finest_march.emplace(finest_levels, request, MarchSettings{}, planet);
  const int octaves = settings.light == Light::kOctaves ? settings.octaves : 1;

  std::vector<Probe> probes(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t p) {
    const Ray ray = pixel_ray(request, picture, pixels[p]);
    const MarchResult exact = cut_march.trace(ray);
    Probe& probe = probes[p];
    probe.picture = pixel_luminance(picture, pixels[p]);
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
    integration.push_back({probe.picture, probe.cut});
    level_of_detail.push_back({probe.cut, probe.finest});
    quantisation.push_back({probe.noisy, probe.cut});
    light_model.push_back({probe.cut + probe.light_model, probe.cut});
  }
  estimate.integration = relative_rms(integration);
  estimate.level_of_detail = relative_rms(level_of_detail);
  estimate.quantisation = relative_rms(quantisation);
  estimate.light_model = relative_rms(light_model);
  estimate.light_model_basis = "table, slabs";
  return estimate;
}

}  // namespace nepho
