#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bench/csv.h"
#include "bench/run.h"
#include "cli/commands.h"
#include "cli/scene_input.h"
#include "cli/values.h"
#include "common/gl_context.h"
#include "common/output_file.h"
#include "core/error.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

int whole_number(const char* option, const std::string& text, int low, int high) {
  const double value = number_value(option, text);
  if (value >= low && value <= high && value == int(value)) return int(value);
  throw Error({"bad value", option,
               "a whole number from " + std::to_string(low) + " to " + std::to_string(high),
               "'" + text + "'", ""});
}

double number_between(const char* option, const std::string& text, double low, double high) {
  const double value = number_value(option, text);
  if (value >= low && value <= high) return value;
  char range[60];
  std::snprintf(range, sizeof range, "a number from %g to %g", low, high);
  throw Error({"bad value", option, range, "'" + text + "'", ""});
}

// A quarter of the shortest step that is swept: its own error is then below a fifth of that one's.
double finest_step_for(const std::vector<bench::Setting>& settings) {
  double finest = bench::ReferenceGoals{}.finest_step_voxels;
  for (const bench::Setting& setting : settings)
    if (const auto step = setting.number("step"); step && *step > 0)
      finest = std::min(finest, *step / 4);
  return finest;
}

bench::RunGoals goals_of(const BenchOptions& options) {
  std::vector<bench::Axis> axes;
  for (const std::string& sweep : options.sweeps) axes.push_back(bench::parse_axis(sweep));
  bench::RunGoals goals;
  goals.settings = bench::combinations(axes);
  if (options.repeats)
    goals.repeats = whole_number("--repeat", *options.repeats, bench::kLeastRepeats, 1000);
  if (options.spp)
    goals.references.most_paths =
        std::uint32_t(whole_number("--spp", *options.spp, 0, 1'000'000'000));
  if (options.host_mib)
    goals.references.host_mib = number_value("--host-mib", *options.host_mib, "paths", "host_mib");
  goals.references.finest_step_voxels =
      options.finest_step ? number_between("--finest-step", *options.finest_step, 1e-3, 0.5)
                          : finest_step_for(goals.settings);
  return goals;
}

// As `render` would open it, at the bench's size.
Scene scene_of(const std::string& input, const BenchOptions& options,
               const PictureFiles& pictures) {
  RenderOptions render;
  render.inputs = {input};
  render.size = options.size.value_or("96x54");
  Scene scene = scene_from(render, pictures);
  scene.render.engine = Engine::kMarch;
  if (options.exact_orders)
    scene.render.paths.exact_orders =
        integer_value("--exact-orders", *options.exact_orders, "paths", "exact_orders");
  return scene;
}

// A folder of this command's own goes again where nothing came of it.
class ReportFolder {
 public:
  explicit ReportFolder(const fs::path& folder) : folder_(folder) {
    std::error_code failure;
    made_ = fs::create_directory(folder, failure);
    if (!fs::is_directory(folder))
      throw Error({"cannot write", folder.string(), "a folder, or a name for one in a folder",
                   failure ? failure.message() : "a file", ""});
  }
  ~ReportFolder() {
    std::error_code ignored;
    if (made_) fs::remove(folder_, ignored);  // only if it is empty
  }
  ReportFolder(const ReportFolder&) = delete;
  ReportFolder& operator=(const ReportFolder&) = delete;

  void check() const { OutputFile(folder_ / "bench.csv", 1 << 20); }
  void write(const char* name, const std::string& text) const {
    OutputFile file(folder_ / name, text.size());
    std::ofstream out(file.temporary(), std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) throw Error({"cannot write", (folder_ / name).string(), "", "a failed write", ""});
    file.commit();
  }

 private:
  fs::path folder_;
  bool made_ = false;
};

}  // namespace

void bench_command(const BenchOptions& options) {
  const bench::RunGoals goals = goals_of(options);
  const PictureFiles pictures(default_module_folders());
  std::vector<Scene> scenes;
  for (const std::string& input : options.scenes)
    scenes.push_back(scene_of(input, options, pictures));
  const ReportFolder folder(options.output);
  folder.check();
  const SourceHost host(default_module_folders());
  const auto context = make_egl_context();
  std::vector<bench::SceneResult> results;
  {
    bench::Progress progress;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const OpenedScene opened = open_scene(host, scenes[s]);
      const std::string name = fs::path(options.scenes[s]).stem().string();
      results.push_back(bench::run_scene(opened, name, goals, progress));
    }
  }
  folder.write("bench.csv", bench::settings_csv(results));
  folder.write("terms.csv", bench::terms_csv(results));
}

}  // namespace nepho
