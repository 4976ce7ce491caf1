#include "cli/target_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/report.h"
#include "cli/target_probe.h"
#include "cli/target_search.h"
#include "core/error.h"
#include "core/log.h"

namespace nepho {
namespace {

// Rms of rounding a sample to 8 bits of sRGB, in linear light, over the light itself: the least is
// that of white, 2.275 / (255 sqrt 12). A shared exponent leaves 8 bits to the largest: 1 / (256
// sqrt 12). The others are held by the march's own 16-bit floats of light, 11 bits each.
constexpr double kLeast8Bit = 2.6e-3, kLeastSharedExponent = 1.2e-3, kLeastFloat = 1e-4;

std::string format(const char* pattern, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

double sum_of(const ErrorEstimate& error) {
  return std::max(error.integration, 0.0) + std::max(error.level_of_detail, 0.0) +
         std::max(error.quantisation, 0.0);
}

std::string settings_text(const TargetSetting& s) {
  return format("tolerance %.2g, %g MiB, %g pixels a voxel", s.tolerance, s.budget_mib,
                s.pixels_per_voxel);
}

// The part of the error that is largest, in words.
std::string what_is_left(const ErrorEstimate& e) {
  if (e.level_of_detail > e.integration)
    return "level of detail " + percent_text(e.level_of_detail) +
           ": finer bricks than memory or data allow";
  return "integration " + percent_text(e.integration) +
         ": light is interpolated between the finest voxels";
}

RenderResult draw(OpenedScene& opened, const TargetMeasure& choice) {
  opened.request.settings = with_setting(opened.request.settings, choice.setting);
  return render(opened.request);
}

void keep_choice(OpenedScene& opened) {
  opened.scene.render = opened.request.settings;
  opened.scene.target = {};
}

std::string search_text(const TargetChoice& choice, double search_s) {
  return format("%zu settings tried in %.2f s CPU", choice.tried.size(), search_s);
}

TargetPicture draw_for_error(OpenedScene& opened, double target) {
  TargetProbe probe(opened.request, false);
  const double before_s = usage_now().cpu_s;
  const auto measure = [&](const TargetSetting& setting) { return probe.measure(setting); };
  TargetChoice choice = search_error(target, probe.first(), measure);
  const double search_s = usage_now().cpu_s - before_s;
  TargetPicture picture{draw(opened, choice.best()), ""};
  TargetSetting used = choice.best().setting;
  // Few pixels may not have met what all of them hold.
  if (choice.met && sum_of(picture.result.error) > target) {
    const auto next = next_setting(choice.tried);
    if (next) {
      used = *next;
      picture.result = draw(opened, {.setting = *next});
    }
  }
  const ErrorEstimate& error = picture.result.error;
  const double reached = sum_of(error);
  const bool met = reached <= target;
  picture.line =
      "target: error " + percent_text(target) + (met ? ": " : " is not met: ") +
      settings_text(used) + " give " + percent_text(reached) +
      (met ? " (the cheapest that do; " : " (the least here; " + what_is_left(error) + "; ") +
      search_text(choice, search_s) + ")";
  if (met && reached > kErrorMargin * target)
    picture.line += "; all pixels may hold more than the few that were measured";
  if (error.light_model > target)
    picture.line += "; the light model's " + percent_text(error.light_model) +
                    " is beside it, and no setting of the march changes that: --engine reference "
                    "--noise " +
                    percent_text(target) + " draws without it";
  if (!met)
    log(LogLevel::kWarning, "--target-error " + percent_text(target) + " is not met: " +
                                percent_text(reached) + " is reachable; " + what_is_left(error));
  return picture;
}

TargetPicture draw_for_time(OpenedScene& opened, double target_ms) {
  TargetProbe probe(opened.request, true);
  const double before_s = usage_now().cpu_s;
  const auto measure = [&](const TargetSetting& setting) { return probe.measure(setting); };
  const TargetChoice choice = search_time(target_ms, probe.first(), measure);
  const double search_s = usage_now().cpu_s - before_s;
  TargetMeasure used = choice.best();
  TargetPicture picture{draw(opened, used), ""};
  FrameTime time = frame_time(picture.result.report);
  if (choice.met && time.ms > target_ms && choice.chosen > 0) {
    used = choice.tried[choice.chosen - 1];
    picture.result = draw(opened, used);
    time = frame_time(picture.result.report);
  }
  const bool met = time.ms <= target_ms;
  const std::string took = format("%.3g ms of %s time for light passes and view, %.3g predicted",
                                  time.ms, time.clock, used.frame_ms);
  picture.line = format("target: frame %.4g ms", target_ms) + (met ? ": " : " is not met: ") +
                 settings_text(used.setting) + " take " + took +
                 (met ? " (the most accurate that do; " : " (the fastest here; ") +
                 search_text(choice, search_s) + ")";
  if (!met)
    log(LogLevel::kWarning,
        format("--target-ms %.4g is not met: ", target_ms) + "the fastest setting takes " +
            format("%.3g ms of %s time; a smaller --size, or a faster device, takes less", time.ms,
                   time.clock));
  return picture;
}

}  // namespace

void check_target(const PictureTarget& target, const Scene& scene, PictureFormat format_of) {
  if (!target.error) return;
  const bool eight_bit = !is_linear(format_of);
  const double least = eight_bit                          ? kLeast8Bit
                       : format_of == PictureFormat::kHdr ? kLeastSharedExponent
                                                          : kLeastFloat;
  if (*target.error < least)
    throw Error({"finer than this picture can be", "--target-error",
                 "at least " + percent_text(least) +
                     (eight_bit ? ", the rounding of 8 bits" : ", the rounding of its numbers"),
                 percent_text(*target.error),
                 format_of == PictureFormat::kExr || format_of == PictureFormat::kPfm
                     ? ""
                     : "write .exr or .pfm: " + percent_text(kLeastFloat) + " is their least"});
  if (scene.render.probe_pixels < 1)
    throw Error(
        {"nothing to measure the error on", "--target-error", "--probe-pixels above 0", "0", ""});
}

TargetPicture draw_for_target(OpenedScene& opened) {
  const PictureTarget target = opened.scene.target;
  TargetPicture picture = target.error ? draw_for_error(opened, *target.error)
                                       : draw_for_time(opened, *target.frame_ms);
  keep_choice(opened);
  return picture;
}

}  // namespace nepho
