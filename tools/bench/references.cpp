#include "bench/references.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/text.h"
#include "core/error.h"
#include "gl/frame_data.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"
#include "reference/own_field.h"

namespace nepho::bench {
namespace {

constexpr double kSlowestStep_voxels = 0.5;    // no reference is coarser
constexpr std::uint32_t kFirstForecast = 256;  // paths a pixel, before noise is extrapolated
constexpr double kOwnPixels = 512;             // at least, where there are as many
constexpr int kFinerSteps = 3;                 // in a cell, for the change of such a picture
constexpr std::size_t kChangePixels = 256;     // on which a stricter march is compared

int light_key(const RenderSettings& settings) {
  return settings.light == Light::kSingle ? 1 : settings.octaves;
}

std::uint64_t node_count(const Forest& forest) {
  std::uint64_t nodes = 0;
  for (const VolumeTree& tree : forest.volumes) nodes += tree.nodes.size();
  return nodes;
}

// Without an end of finer levels that so much memory could hold: the bricks of a source that makes
// them as they are asked for are no file's.
bool is_endless(const RenderRequest& request, double host_mib) {
  return std::ranges::any_of(request.volumes, [&](const RenderVolume& volume) {
    const VolumeInfo& info = volume.source->info();
    double bytes = double(sizeof(LeafBrick)) * info.chart->roots();
    for (const std::uint32_t cells : info.lattice.cells(info.lattice.max_level()))
      bytes *= std::max(double(cells) / kBrickCells, 1.0);
    return info.refine_by_variance && bytes > host_mib * 0x1p20;
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
  endless_ = is_endless(request, goals_.host_mib);
  if (!endless_) try {
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
  return change_by(RayMarch(levels, request, kStricterMarch, planet_), request, picture);
}

double References::change_by(const RayMarch& other, const RenderRequest& request,
                             const HdrImage& picture) const {
  std::vector<std::size_t> counted, some;
  for (std::size_t p = 0; p < mask_.size(); ++p)
    if (mask_[p] > 0) counted.push_back(p);
  const std::size_t n = std::min(kChangePixels, counted.size());
  for (std::size_t i = 0; i < n; ++i) some.push_back(counted[i * counted.size() / n]);
  HdrImage strict{int(n), 1, {}, {}}, usual = strict;
  for (const MarchResult& seen : march_pixels(other, request, some)) {
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
      const double finer = change_by(RayMarch(coarser, request, kReferenceMarch, planet_), request,
                                     reference.picture);
      // What has no end is held against a depth that is stated: the picture of those bricks is
      // known, and what lies below them is in no number.
      if (endless_)
        beyond_ = finer;
      else
        reference.change = std::hypot(reference.change, finer);
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

const OwnPicture& References::own(const RenderSettings& settings) {
  const LightKey key = light_key(settings);
  const auto known = own_.find(key);
  if (known != own_.end()) return known->second;
  return own_.emplace(key, march_own(request_with(settings))).first->second;
}

OwnPicture References::march_own(const RenderRequest& request) {
  if (endless_)
    return {{}, "there are finer bricks than memory holds, and more in the source's own field"};
  if (!holds_everything_)
    return {{}, "the finest bricks are not all levels: more is needed (--host-mib)"};
  const CutLevels bricks(finest_forest_);
  std::optional<OwnField> field;
  try {
    field.emplace(bricks, request.volumes, 1);
  } catch (const Error& error) {
    return {{}, error.what()};
  }
  const OwnField finer(bricks, request.volumes, kFinerSteps);
  const auto stride = std::size_t(std::max(1.0, std::sqrt(double(mask_.size()) / kOwnPixels)));
  progress_.begin(Work::kMarch, "the march on the sources' own fields");
  OwnPicture::Pair seen{{thinned(*field, request, stride), 0}, thinned(bricks, request, stride)};
  // What finer steps change of the difference: light is looked at from other places too, by both.
  const HdrImage own_finer = thinned(finer, request, 2 * stride),
                 bricks_finer =
                     thinned(BricksInSteps(finest_forest_, kFinerSteps), request, 2 * stride),
                 bricks_usual = thinned(bricks, request, 2 * stride);
  HdrImage own_usual = thinned(*field, request, 2 * stride);
  for (std::size_t i = 0; i < own_usual.rgb.size(); ++i)
    own_usual.rgb[i] += bricks_finer.rgb[i] - bricks_usual.rgb[i];
  seen.own.change = picture_error(own_usual, own_finer);
  progress_.end();
  return {std::move(seen), ""};
}

// Every so many pixels of the picture on both axes, from the middle of the first such square.
HdrImage References::thinned(const LevelSet& levels, const RenderRequest& request,
                             std::size_t stride) const {
  const auto width = std::size_t(request.settings.width),
             height = std::size_t(request.settings.height);
  std::vector<std::size_t> pixels;
  HdrImage image{0, 0, {}, {}};
  for (std::size_t y = stride / 2; y < height; y += stride, ++image.height)
    for (std::size_t x = stride / 2; x < width; x += stride) pixels.push_back(y * width + x);
  image.width = int(pixels.size()) / image.height;
  const RayMarch march(levels, request, kOwnMarch, planet_);
  for (const MarchResult& seen : march_pixels(march, request, pixels))
    for (int c = 0; c < 3; ++c) image.rgb.push_back(float(seen.radiance_W_per_m2_sr_nm[c]));
  for (const std::size_t p : pixels) image.optical_depth.push_back(mask_[p]);
  return image;
}

std::string References::description() const {
  if (holds_everything_) return "all levels";
  std::string text = "four times finer than the finest setting asks for";
  if (finest_forest_.budget_bound) text += ", as far as the memory for it goes";
  if (beyond_ != kNotYet)
    text += " (bricks half as fine look " + percent_text(beyond_) +
            " unlike; what is finer still is in no number)";
  return text;
}

}  // namespace nepho::bench
