#include "bench/references.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "gl/frame_data.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"

namespace nepho::bench {
namespace {

constexpr double kSlowestStep_voxels = 0.5;    // no reference is coarser
constexpr std::uint32_t kFirstForecast = 256;  // paths a pixel, before noise is extrapolated
constexpr double kNotYet = -1;                 // a change that is not measured yet
constexpr std::size_t kChangePixels = 256;     // on which a stricter march is compared

int light_key(const RenderSettings& settings) {
  return settings.light == Light::kSingle ? 1 : settings.octaves;
}

std::uint64_t node_count(const Forest& forest) {
  std::uint64_t nodes = 0;
  for (const VolumeTree& tree : forest.volumes) nodes += tree.nodes.size();
  return nodes;
}

// Without an end of finer levels that a machine could hold.
bool is_endless(const RenderRequest& request) {
  return std::ranges::any_of(request.volumes, [](const RenderVolume& volume) {
    return volume.source->info().refine_by_variance;
  });
}

}  // namespace

References::References(const OpenedScene& opened, const ReferenceGoals& goals, Progress& progress,
                       const RenderSettings& finest_of_sweep)
    : opened_(opened), goals_(goals), progress_(progress) {
  if (goals.most_paths > 0 && goals.most_paths < kLeastPaths)
    throw std::invalid_argument("too few paths to tell their noise");
  if (opened.request.planet) planet_ = std::make_shared<const PlanetModel>(opened.request, nullptr);
  make_finest(finest_of_sweep);
  const RenderRequest request = request_with(finest_of_sweep);
  const CutLevels levels(finest_forest_);
  Reference reference{march(levels, request, "the march on the finest bricks"), kNotYet};
  make_mask(reference.picture);
  reference.picture = masked(std::move(reference.picture));
  finest_.emplace(light_key(finest_of_sweep), std::move(reference));
}

RenderRequest References::request_with(const RenderSettings& settings) const {
  RenderRequest request = opened_.request;
  request.settings = settings;
  request.settings.probe_pixels = 0;
  return request;
}

// All levels where they fit; else, view by view, well below what the sweep asks for.
void References::make_finest(const RenderSettings& finest_of_sweep) {
  RenderRequest request = request_with(finest_of_sweep);
  request.settings.max_level = 31;
  if (!is_endless(request)) try {
      finest_forest_ = finest_forest(request, goals_.host_mib);
      return;
    } catch (const Error&) {
      // What a source could not read it cannot read below either, and says so there.
    }
  holds_everything_ = false;
  // An eighth of the memory is a level less, where memory is what ends it.
  const auto refined = [&](double finer, double host_mib) {
    RenderRequest asked = request;
    asked.settings.budget_mib = host_mib;
    asked.settings.pixels_per_voxel /= finer;
    asked.settings.tolerance /= finer * finer;
    return build_forest(asked.volumes, gl::refinement_of(asked));
  };
  less_fine_ = refined(2, goals_.host_mib / 8);
  finest_forest_ = refined(4, goals_.host_mib);
}

void References::make_mask(const HdrImage& finest) {
  const CameraRays rays(opened_.request.camera, finest.width, finest.height);
  for (std::size_t p = 0; p < finest.optical_depth.size(); ++p) {
    const auto width = std::size_t(finest.width);
    const Ray ray = rays.ray(int(p % width), int(p / width));
    const bool counts = planet_ ? !planet_->sees_sun(ray.direction)
                                : double(finest.optical_depth[p]) > kShownOpticalDepth;
    mask_.push_back(counts ? 1.0f : 0.0f);
  }
}

HdrImage References::masked(HdrImage image) const {
  image.optical_depth = mask_;
  return image;
}

const References::Tree& References::tree(const RenderSettings& s) {
  const auto asked = std::tuple(s.budget_mib, s.max_level, s.pixels_per_voxel, s.tolerance);
  const auto known = trees_.find(asked);
  if (known != trees_.end()) return known->second;
  const RenderRequest request = request_with(s);
  Tree tree{{}, build_forest(request.volumes, gl::refinement_of(request))};
  // A larger budget never gives a coarser node: as many nodes are the same ones.
  tree.key = {node_count(tree.forest), s.max_level, s.pixels_per_voxel, s.tolerance};
  return trees_.emplace(asked, std::move(tree)).first->second;
}

References::Key References::key_of(const RenderSettings& settings) {
  return {tree(settings).key, light_key(settings)};
}

HdrImage References::draw(const RenderSettings& settings, const std::string& what) {
  progress_.begin(Work::kRender, what);
  HdrImage image = masked(render(request_with(settings)).image);
  progress_.end();
  return image;
}

HdrImage References::march(const LevelSet& levels, const RenderRequest& request,
                           const std::string& what) {
  progress_.begin(Work::kMarch, what);
  const double pixels = double(request.settings.width) * request.settings.height;
  const RayMarch march(levels, request, kReferenceMarch, planet_);
  HdrImage image = march_picture(
      march, request, [&](std::size_t done) { progress_.within(double(done) / pixels); });
  progress_.end();
  return image;
}

double References::march_change(const LevelSet& levels, const RenderRequest& request,
                                const HdrImage& picture) const {
  std::vector<std::size_t> counted, some;
  for (std::size_t p = 0; p < mask_.size(); ++p)
    if (mask_[p] > 0) counted.push_back(p);
  const std::size_t n = std::min(kChangePixels, counted.size());
  for (std::size_t i = 0; i < n; ++i) some.push_back(counted[i * counted.size() / n]);
  const RayMarch march(levels, request, kStricterMarch, planet_);
  HdrImage strict{int(n), 1, {}, {}}, usual = strict;
  for (const MarchResult& seen : march_pixels(march, request, some)) {
    for (int c = 0; c < 3; ++c) strict.rgb.push_back(float(seen.radiance_W_per_m2_sr_nm[c]));
    strict.optical_depth.push_back(1);
  }
  for (const std::size_t p : some) {
    for (std::size_t c = 0; c < 3; ++c) usual.rgb.push_back(picture.rgb[3 * p + c]);
    usual.optical_depth.push_back(1);
  }
  return n ? picture_error(usual, strict) : 0;
}

const Reference& References::fine_steps(const RenderSettings& settings) {
  const Key key = key_of(settings);
  const auto known = fine_steps_.find(key);
  if (known != fine_steps_.end()) return known->second;
  RenderSettings fine = settings;
  fine.fetch = Fetch::kTexels8;
  fine.pixels = WhichPixels::kAll;
  for (double step = goals_.finest_step_voxels;; step *= 2) try {
      fine.step_voxels = step;
#ifdef NEPHO_MUTANT_BENCH_SWAPPED
      fine.step_voxels = 2;  // what is swept stands for the reference
#endif
      Reference reference{draw(fine, "fine steps"), 0};
      fine.step_voxels = 2 * step;
      reference.change = picture_error(draw(fine, "steps twice as long"), reference.picture);
      return fine_steps_.emplace(key, std::move(reference)).first->second;
    } catch (const Error&) {
      // The software rasteriser ends rays after 65535 steps.
      if (2 * step > kSlowestStep_voxels) throw;
    }
}

const Reference& References::converged(const RenderSettings& settings) {
  const Key key = key_of(settings);
  const auto known = converged_.find(key);
  if (known != converged_.end()) return known->second;
  const CutLevels levels(tree(settings).forest);
  const RenderRequest request = request_with(settings);
  Reference reference{masked(march(levels, request, "the march on the same bricks")), 0};
  reference.change = march_change(levels, request, reference.picture);
  return converged_.emplace(key, std::move(reference)).first->second;
}

const HdrImage& References::coarser_codes(const RenderSettings& settings) {
  const Key key = key_of(settings);
  const auto known = coarser_codes_.find(key);
  if (known != coarser_codes_.end()) return known->second;
  const NoisyCutLevels levels(tree(settings).forest, settings.seed);
  HdrImage image =
      masked(march(levels, request_with(settings), "the march on bricks with noise of codes"));
  return coarser_codes_.emplace(key, std::move(image)).first->second;
}

const Reference& References::finest(const RenderSettings& settings) {
  const LightKey key = light_key(settings);
  const RenderRequest request = request_with(settings);
  const CutLevels levels(finest_forest_);
  auto known = finest_.find(key);
  if (known == finest_.end())
    known = finest_
                .emplace(key, Reference{masked(march(levels, request,
                                                     "the march on the finest "
                                                     "bricks")),
                                        kNotYet})
                .first;
  Reference& reference = known->second;
  if (reference.change == kNotYet) {
    reference.change = march_change(levels, request, reference.picture);
    if (less_fine_) {
      const CutLevels coarser(*less_fine_);
      const HdrImage image = masked(march(coarser, request, "the march on bricks less fine"));
      reference.change = std::hypot(reference.change, picture_error(image, reference.picture));
    }
  }
  return reference;
}

double References::noise_of(const PathPicture& paths) const {
  double variance = 0, luminance = 0, count = 0;
  for (std::size_t p = 0; p < mask_.size(); ++p) {
    if (!(mask_[p] > 0)) continue;
    variance += double(paths.standard_error[p]) * double(paths.standard_error[p]);
    luminance += pixel_luminance(paths.image, p);
    ++count;
  }
  return luminance > 0 ? std::sqrt(variance * count) / luminance : 0;
}

const std::optional<Truth>& References::truth(std::span<const RenderSettings> settings) {
  if (truth_) return *truth_;
  truth_.emplace();
  if (goals_.most_paths == 0) return *truth_;
  std::vector<const HdrImage*> modelled;
  for (const RenderSettings& s : settings) modelled.push_back(&finest(s).picture);
  std::ranges::sort(modelled);
  const auto repeated = std::ranges::unique(modelled);
  modelled.erase(repeated.begin(), repeated.end());
  progress_.begin(Work::kPaths, "paths");
  const RenderRequest request = request_with(settings.front());
  const PathTracer tracer(finest_forest_, request);
  const PathPicture paths =
      path_trace(tracer, request, {goals_.most_paths, 0}, [&](const PathPicture& so_far) {
        progress_.within(double(so_far.samples) / goals_.most_paths);
        // At the same numbers of paths on every machine: 8, 16, ... 128, 256, 384, ...
        const std::uint32_t n = so_far.samples;
        if (n < kLeastPaths || (n & (n - 1) && n % 128)) return false;
        const double noise = noise_of(so_far);
        const HdrImage image = masked(so_far.image);
        double least = INFINITY;
        for (const HdrImage* picture : modelled)
          least = std::min(least, picture_error(*picture, image));
        const double error = std::sqrt(std::max(least * least - noise * noise, 0.0));
        // Far from it: what most_paths would leave is known well enough to say what is needed.
        const double at_most = noise * std::sqrt(double(n) / goals_.most_paths);
        if (n >= kFirstForecast && at_most * kLeastRatio > 2 * error) return true;
        return noise * kLeastRatio * 1.1 < error;  // a tenth in hand
      });
  progress_.end();
  *truth_ = Truth{masked(paths.image), noise_of(paths), paths.samples};
  return *truth_;
}

std::string References::description() const {
  if (holds_everything_) return "all levels";
  char text[120];
  std::snprintf(text, sizeof text, "four times finer than the finest setting asks for%s",
                finest_forest_.budget_bound ? ", as far as the memory for it goes" : "");
  return text;
}

}  // namespace nepho::bench
