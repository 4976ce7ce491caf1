#include "cli/target_search.h"

#include <algorithm>
#include <cmath>

namespace nepho {
namespace {

constexpr double kLeastTolerance = 1e-4, kMostBudget_mib = 256, kFinestVoxels = 0.5;
constexpr double kToleranceStep = 0.31622776601683794;  // a root of ten
constexpr double kBudgetStep = 4;
constexpr double kSame = 0.85;          // of the error before: no progress to speak of
constexpr double kNothingFiner = 0.02;  // of integration: bricks are as fine as the data
constexpr double kFar = 8;  // errors so many times the target take two steps of memory at once
constexpr std::size_t kLongest = 24;  // settings tried; the ladder has no more

// Whether the last step was one of tolerance alone and left the integration error as it was.
bool stuck(const TargetMeasure& before, const TargetMeasure& after) {
  return before.setting.budget_mib == after.setting.budget_mib &&
         before.setting.pixels_per_voxel == after.setting.pixels_per_voxel &&
         before.setting.tolerance > after.setting.tolerance &&
         after.integration > kSame * before.integration;
}

std::size_t least_error(const std::vector<TargetMeasure>& tried) {
  const auto least = std::ranges::min_element(tried, {}, &TargetMeasure::error);
  return std::size_t(least - tried.begin());
}

}  // namespace

std::optional<TargetSetting> next_setting(std::span<const TargetMeasure> walk, Haste haste) {
  const TargetMeasure& last = walk.back();
  TargetSetting next = last.setting;
  const auto finer_bricks = [&] {
    if (last.budget_bound) {
      next.budget_mib = std::min(
          next.budget_mib * std::pow(kBudgetStep, haste == Haste::kBoth ? 2 : 1), kMostBudget_mib);
      return next.budget_mib > last.setting.budget_mib;
    }
    if (last.level_of_detail <= kNothingFiner * last.integration ||
        next.pixels_per_voxel <= kFinestVoxels)
      return false;
    next.pixels_per_voxel /= 2;
    return true;
  };
  const std::size_t n = walk.size();
  const bool stuck_once = n >= 2 && stuck(walk[n - 2], last);
  const auto smaller_tolerance = [&] {
    next.tolerance = std::max(
        next.tolerance * std::pow(kToleranceStep, haste != Haste::kNone || stuck_once ? 2 : 1),
        kLeastTolerance);
    return next.tolerance < last.setting.tolerance;
  };
  if (last.level_of_detail >= last.integration) {
    if (finer_bricks() || smaller_tolerance()) return next;
    return std::nullopt;
  }
  const bool light_is_left = n >= 3 && stuck_once && stuck(walk[n - 3], walk[n - 2]);
  if (light_is_left) {
    if (finer_bricks()) return next;
    return std::nullopt;
  }
  if (smaller_tolerance() || finer_bricks()) return next;
  return std::nullopt;
}

TargetChoice search_error(double target, const TargetSetting& first,
                          const MeasureSetting& measure) {
  TargetChoice choice{{measure(first)}};
  while (true) {
#ifdef NEPHO_MUTANT_HALF_PROBE
    const double error = 0.5 * choice.tried.back().error();
#else
    const double error = choice.tried.back().error();
#endif
    if (error <= kErrorMargin * target) {
      choice.chosen = choice.tried.size() - 1;
      choice.met = true;
      return choice;
    }
    const auto next =
        next_setting(choice.tried, error > kFar * target ? Haste::kBoth : Haste::kTolerance);
    if (!next || choice.tried.size() == kLongest) break;
    choice.tried.push_back(measure(*next));
  }
  choice.chosen = least_error(choice.tried);
  return choice;
}

TargetChoice search_time(double target_ms, const TargetSetting& first,
                         const MeasureSetting& measure) {
  TargetChoice choice{{measure(first)}};
  while (choice.tried.back().frame_ms <= target_ms && choice.tried.size() < kLongest) {
    const auto next = next_setting(choice.tried);
    if (!next) break;
    choice.tried.push_back(measure(*next));
  }
  choice.met = choice.tried.front().frame_ms <= target_ms;
  for (std::size_t i = 1; i < choice.tried.size(); ++i)
    if (choice.tried[i].frame_ms <= target_ms && choice.tried[i].error() < choice.best().error())
      choice.chosen = i;
  return choice;
}

}  // namespace nepho
