#include "bench/run.h"

#include <algorithm>
#include <set>

#include "common/planet_scene.h"
#include "core/error.h"
#include "gl/gpu_clock.h"
#include "image/tone.h"

namespace nepho::bench {
namespace {

enum class Part { kPrepare, kLight, kView };
Part part_of(const std::string& pass) {
  if (pass == "refine and read" || pass == "upload") return Part::kPrepare;
  if (pass.starts_with("sun ") || pass.starts_with("sky ") || pass.starts_with("light "))
    return Part::kLight;
  return Part::kView;
}

// Of one setting, run by run.
struct Clocked {
  std::vector<double> prepare_s, light_s, view_s, frame_s, gpu_frame_s;

  void add(const RenderReport& report) {
    double prepare = 0, light = 0, view = 0, gpu = 0;
    bool gpu_known = true;
    for (const PassReport& pass : report.passes) {
      const Part part = part_of(pass.name);
      (part == Part::kPrepare ? prepare : part == Part::kLight ? light : view) += pass.cpu_s;
      if (part == Part::kPrepare) continue;
      gpu += pass.gpu_s;
      gpu_known = gpu_known && pass.gpu_s >= 0;
    }
    prepare_s.push_back(prepare);
    light_s.push_back(light);
    view_s.push_back(view);
    frame_s.push_back(light + view);
    if (gpu_known) gpu_frame_s.push_back(gpu);
  }

  Times times() const {
    Times out{spread_of(prepare_s), spread_of(light_s), spread_of(view_s), spread_of(frame_s), {}};
    if (gpu_frame_s.size() == frame_s.size()) out.gpu_frame_s = spread_of(gpu_frame_s);
    return out;
  }
};

// In rounds over all settings, so that a machine that is busy for a while is busy for all.
void clock_settings(const OpenedScene& opened, const RunGoals& goals, const std::string& name,
                    SceneResult& result, Progress& progress) {
  std::vector<Clocked> clocked(result.settings.size());
  for (int round = 0; round <= goals.repeats; ++round)
    for (std::size_t s = 0; s < result.settings.size(); ++s) {
      SettingResult& setting = result.settings[s];
      progress.begin(Work::kRender, name + ": " + setting.setting.label() + ", " +
                                        (round ? "run " + std::to_string(round) + " of " +
                                                     std::to_string(goals.repeats)
                                               : std::string("warm-up")));
      RenderRequest request = opened.request;
      request.settings = setting.settings;
      RenderResult drawn = render(request);
      progress.end();
      if (round == 0) {
        setting.picture = std::move(drawn.image);
        for (const VolumeReport& volume : drawn.report.volumes) setting.bricks += volume.bricks;
        result.device = drawn.report.device;
      } else {
        clocked[s].add(drawn.report);
      }
    }
  for (std::size_t s = 0; s < clocked.size(); ++s) result.settings[s].times = clocked[s].times();
}

// The one that asks for the finest bricks: what the finest reference goes by.
RenderSettings finest_of(const std::vector<SettingResult>& settings) {
  RenderSettings finest = settings.front().settings;
  for (const SettingResult& s : settings) {
    finest.budget_mib = std::max(finest.budget_mib, s.settings.budget_mib);
    finest.pixels_per_voxel = std::min(finest.pixels_per_voxel, s.settings.pixels_per_voxel);
    finest.tolerance = std::min(finest.tolerance, s.settings.tolerance);
    finest.max_level = std::max(finest.max_level, s.settings.max_level);
  }
  return finest;
}

Display display_of(const OpenedScene& opened, const HdrImage& image,
                   const std::vector<float>& depth) {
  const Scene& scene = opened.scene;
  Display display{0, scene.tone_map, display_white(scene)};
  if (scene.exposure_ev) {
    display.exposure_ev = *scene.exposure_ev;
    return display;
  }
  FloatImage radiance(image.width, image.height, 3);
  radiance.values = image.rgb;
  display.exposure_ev = scene.planet ? exposure_on_planet(radiance, depth, white_in_the_sun(opened))
                                     : exposure_from(radiance, depth);
  return display;
}

std::string label_without(const Setting& setting, const std::string& axis) {
  Setting rest = setting;
  std::erase_if(rest.values, [&](const auto& value) { return value.first == axis; });
  return rest.values.empty() ? "" : rest.label();
}

std::vector<Convergence> convergence_of(const std::vector<SettingResult>& settings) {
  std::vector<Convergence> all;
  for (const char* axis : {"step", "tolerance"}) {
    std::vector<std::string> groups;
    for (const SettingResult& s : settings) {
      if (!s.setting.number(axis)) continue;
      const std::string at = label_without(s.setting, axis);
      if (std::ranges::find(groups, at) == groups.end()) groups.push_back(at);
    }
    for (const std::string& at : groups) {
      std::vector<StepError> points;
      for (const SettingResult& s : settings) {
        const auto value = s.setting.number(axis);
        const Term* steps = find_term(s.terms, kSteps);
        if (value && label_without(s.setting, axis) == at && steps->told())
          points.push_back({*value, steps->rms});
      }
      Convergence found{axis, at, {}, ""};
      found.fit = convergence_order(points, found.why_not);
      all.push_back(std::move(found));
    }
  }
  return all;
}

std::vector<VolumeDataError> data_errors(const OpenedScene& opened) {
  std::vector<VolumeDataError> all;
  for (const RenderVolume& volume : opened.request.volumes) {
    VolumeDataError found{volume.source->info().name, {}};
    try {
      found.error = data_error(*volume.source, volume.time_s);
    } catch (const Error&) {
      // No field of its own, or no cloud: nothing to compare.
    }
    all.push_back(std::move(found));
  }
  return all;
}

void plan(const RunGoals& goals, const std::vector<SettingResult>& settings, Progress& progress) {
  std::set<std::tuple<double, int, double, double, int>> trees;
  for (const SettingResult& s : settings)
    trees.emplace(s.settings.budget_mib, s.settings.max_level, s.settings.pixels_per_voxel,
                  s.settings.tolerance, s.settings.octaves);
  progress.plan(Work::kRender,
                double(settings.size()) * (goals.repeats + 1) + 2 * double(trees.size()));
  progress.plan(Work::kMarch, 2 + 2 * double(trees.size()));
  if (goals.references.most_paths) progress.plan(Work::kPaths, 1);
}

void refuse_without_numbers(const SceneResult& result) {
  const char* term = judged_by(result.settings);
  const Term* first = nullptr;
  for (const SettingResult& s : result.settings) {
    const Term* found = find_term(s.terms, term);
    if (!found || found->told()) return;
    if (!first) first = found;
  }
  if (first)
    throw Error({"no reference is good enough", result.name,
                 "one whose own error is below a fifth of a setting's", first->withheld, ""});
}

}  // namespace

std::vector<std::string> SceneResult::varied() const {
  std::vector<Setting> all;
  for (const SettingResult& s : settings) all.push_back(s.setting);
  return varied_axes(all);
}

const char* judged_by(const std::vector<SettingResult>& settings) {
  const RenderSettings& first = settings.front().settings;
  const bool light = std::ranges::any_of(settings, [&](const SettingResult& s) {
    return s.settings.light != first.light || s.settings.octaves != first.octaves;
  });
  return light && find_term(settings.front().terms, kTotal) ? kTotal : kMarch;
}

SceneResult run_scene(const OpenedScene& opened, const std::string& name, const RunGoals& goals,
                      Progress& progress) {
  SceneResult result{.name = name};
  std::vector<RenderSettings> all;
  for (const Setting& setting : goals.settings) {
    SettingResult next{.setting = setting, .settings = opened.request.settings};
    next.settings.probe_pixels = 0;
    lay_over(setting, next.settings);
    all.push_back(next.settings);
    result.settings.push_back(std::move(next));
  }
  plan(goals, result.settings, progress);
  clock_settings(opened, goals, name, result, progress);
  if (const char* why = gl::GpuClock::why_not()) result.no_gpu_clock = why;

  References references(opened, goals.references, progress, finest_of(result.settings));
  const std::optional<Truth>& truth = references.truth(all);
  result.reference = references.finest(all.front()).picture;
  if (truth) {
    result.paths = truth->paths;
    result.noise = truth->noise;
  }
  // Exposed by the first picture's own depths: the references share a mask.
  result.display =
      display_of(opened, result.reference, result.settings.front().picture.optical_depth);
  for (SettingResult& s : result.settings) {
    s.picture = references.masked(std::move(s.picture));
    const Chain chain{&s.picture,
                      &references.fine_steps(s.settings),
                      &references.converged(s.settings),
                      &references.coarser_codes(s.settings),
                      &references.finest(s.settings),
                      truth ? &*truth : nullptr,
                      &references.own(s.settings)};
    s.terms = decompose(chain, result.display);
  }
  result.finest = references.description();
  // A truth that is too noisy to be told from the march is no picture to hold others against.
  const Term* light = find_term(result.settings.front().terms, kLightModel);
  if (light && light->told()) {
    result.reference = truth->picture;
    result.reference_is_truth = true;
  }
  result.convergence = convergence_of(result.settings);
  result.data = data_errors(opened);
  refuse_without_numbers(result);
  return result;
}

}  // namespace nepho::bench
