#include "cli/reference_picture.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "common/stop_request.h"
#include "core/log.h"
#include "gl/frame_data.h"
#include "reference/path/path_picture.h"
#include "tree/forest.h"

namespace nepho {
namespace {

constexpr double kUsualNoise = 0.05;

// On a terminal: one line that is written over.
class Progress {
 public:
  explicit Progress(const PathGoal& goal) : goal_(goal), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

  void tell(const PathPicture& picture) const {
    if (!shown_) return;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    double whole = goal_.samples ? double(goal_.samples) : INFINITY;
    // Noise falls with the square root of the paths.
    if (goal_.noise > 0 && picture.noise > 0)
      whole = std::min(whole, picture.samples * std::pow(picture.noise / goal_.noise, 2));
    const double left_s = spent.count() * std::max(whole / picture.samples - 1, 0.0);
    std::fprintf(stderr, "\r\033[Kreference: %u paths a pixel, noise %.2g %%, %.0f s left",
                 picture.samples, 100 * picture.noise, left_s);
  }

 private:
  PathGoal goal_;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string line_of(const PathPicture& picture, const PathGoals& goals) {
  char text[320], smoothed[64] = "";
  if (goals.exact_orders >= 0)
    std::snprintf(smoothed, sizeof smoothed, "; Mie smoothed after %d scatterings",
                  goals.exact_orders);
  std::snprintf(text, sizeof text,
                "error (measured): noise %.2g %% (rms of the pixels' standard errors over mean "
                "luminance, %u paths a pixel%s; %s bricks%s)",
                100 * picture.noise, picture.samples, picture.stopped ? ", stopped early" : "",
                goals.levels == PathLevels::kFinest ? "finest" : "resident", smoothed);
  return text;
}

VolumeReport report_of(const VolumeTree& tree) {
  const VolumeInfo& info = tree.source->info();
  VolumeReport report{.name = info.name,
                      .nodes = tree.nodes.size(),
                      .bricks = tree.bricks.size(),
                      .finest_level_used = tree.finest_level_used,
                      .finest_level = info.lattice.max_level()};
  for (const TreeNode& node : tree.nodes) {
    report.constant_nodes += node.kind == NodeKind::kConstant;
    report.empty_nodes += node.kind == NodeKind::kEmpty;
  }
  return report;
}

}  // namespace

ReferencePicture draw_reference(const OpenedScene& opened) {
  const RenderRequest& request = opened.request;
  const PathGoals& goals = request.settings.paths;
  PathGoal goal{std::uint32_t(goals.samples), goals.noise};
  if (!goal.samples && !(goal.noise > 0)) goal.noise = kUsualNoise;
  const Forest forest = goals.levels == PathLevels::kFinest
                            ? finest_forest(request, goals.host_mib)
                            : build_forest(request.volumes, gl::refinement_of(request));
  const PathTracer tracer(forest, request, {.exact_orders = goals.exact_orders});
  const StopRequest interrupt;
  const Progress progress(goal);
  const PathPicture picture = path_trace(tracer, request, goal, [&](const PathPicture& so_far) {
    progress.tell(so_far);
    return interrupt.made();
  });
  ReferencePicture drawn{{.image = picture.image, .error = {}, .report = {}},
                         line_of(picture, goals)};
  drawn.result.report.device = "paths on the CPU, in double";
  for (const VolumeTree& tree : forest.volumes)
    drawn.result.report.volumes.push_back(report_of(tree));
  return drawn;
}

}  // namespace nepho
