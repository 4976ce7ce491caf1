#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/fit.h"
#include "bench/progress.h"
#include "bench/sweep.h"
#include "bench/terms.h"
#include "common/data_error.h"
#include "common/open_scene.h"

namespace nepho::bench {

inline constexpr int kLeastRepeats = 5;

struct RunGoals {
  std::vector<Setting> settings;
  int repeats = kLeastRepeats;  // after a warm-up
  ReferenceGoals references;
};

// Process CPU time of all threads; `frame` is what each picture of an animation would take.
struct Times {
  Spread prepare_s;        // refinement, reading, upload
  Spread light_s, view_s;  // the two parts of a frame
  Spread frame_s;
  std::optional<Spread> gpu_frame_s;  // by the GPU's own clock
};

struct SettingResult {
  Setting setting;
  RenderSettings settings = {};
  Times times = {};
  std::uint64_t bricks = 0;
  HdrImage picture = {};
  std::vector<Term> terms = {};
};

// How the error of steps falls with what a sweep names, at one choice of the other settings.
struct Convergence {
  std::string axis, at;  // "step", "budget-mib 64"
  std::optional<OrderFit> fit;
  std::string why_not;
};

struct VolumeDataError {
  std::string volume;
  std::optional<DataError> error;  // of extinction, at points; absent: the source has no own field
};

struct SceneResult {
  std::vector<std::string> varied() const;  // axes with more than one value

  std::string name = {};
  std::string device = {};
  std::string no_gpu_clock = {};  // why gpu times are absent; empty: they are there
  std::string finest = {};        // what the finest bricks are
  std::uint32_t paths = 0;        // a pixel, of the truth; 0: none was traced
  double noise = 0;
  Display display = {};
  HdrImage reference = {};  // what pictures are held against: the truth, or the finest march
  bool reference_is_truth = false;
  std::vector<SettingResult> settings = {};
  std::vector<Convergence> convergence = {};
  std::vector<VolumeDataError> data = {};
};

// Times and errors of every setting on one opened scene, whose size is that of the pictures. The
// renderer's context is current. Throws Error, also where no reference is good enough for any
// setting's error: with what would be.
SceneResult run_scene(const OpenedScene& opened, const std::string& name, const RunGoals& goals,
                      Progress& progress);

// The term that a setting is judged by: total where the sweep changes the light model, or else
// march. (A constant light model error would hide all others.)
const char* judged_by(const std::vector<SettingResult>& settings);

}  // namespace nepho::bench
