#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace nepho {

// Which of the march's settings a target of error or of time gets: a walk from the cheapest to ever
// dearer ones, each step by what the last one's error consists of. Nothing here draws.

struct TargetSetting {
  double tolerance = 0.3, budget_mib = 1, pixels_per_voxel = 1;
  bool operator==(const TargetSetting&) const = default;
};

// A setting as it was measured. Errors are those of the error line (ErrorEstimate), relative.
struct TargetMeasure {
  TargetSetting setting;
  double integration = 0, level_of_detail = 0, quantisation = 0;
  double frame_ms = 0;        // light passes and view of the whole picture
  bool budget_bound = false;  // more memory would refine the tree
  // At most what the three are together, however they correlate.
  double error() const { return integration + level_of_detail + quantisation; }
};
using MeasureSetting = std::function<TargetMeasure(const TargetSetting&)>;

struct TargetChoice {
  std::vector<TargetMeasure> tried;  // in the order of the walk
  std::size_t chosen = 0;
  bool met = false;
  const TargetMeasure& best() const { return tried[chosen]; }
};

// What is expected on few pixels may be more on all (a forecast: 2.1 and 3.7 %): a target of error
// is met below this part.
inline constexpr double kErrorMargin = 0.6;

// The next setting of a walk: more memory, then finer voxels, where level of detail is the larger
// error; otherwise a smaller tolerance, unless two of those in a row changed next to nothing: what
// is left is then light between voxels, which finer bricks cure. None where nothing finer is left
// that would help. A tolerance that is too small costs less than another setting tried.
enum class Haste {
  kNone,       // tolerances by a root of ten, memory by four
  kTolerance,  // tolerances by ten
  kBoth,       // and memory by sixteen
};
std::optional<TargetSetting> next_setting(std::span<const TargetMeasure> walk,
                                          Haste haste = Haste::kNone);

// The first setting of the walk whose error is below kErrorMargin of the target (relative). Not
// met: the one with the least error.
TargetChoice search_error(double target, const TargetSetting& first, const MeasureSetting& measure);

// Of the walk up to the first setting that takes longer than `target_ms`, the one with the least
// error that does not. The walk does not depend on the target, so that a larger one never gives a
// larger error. Not met: the fastest of them.
TargetChoice search_time(double target_ms, const TargetSetting& first,
                         const MeasureSetting& measure);

}  // namespace nepho
