#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bench/csv.h"
#include "bench/markdown.h"
#include "bench/page.h"
#include "bench/pareto.h"
#include "bench/run.h"
#include "bench/text.h"
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
  if (const std::uint32_t paths = goals.references.most_paths;
      paths > 0 && paths < bench::kLeastPaths)
    throw Error(
        {"fewer than " + std::to_string(bench::kLeastPaths) + " paths do not tell their noise",
         "--spp", "0 (no path tracing) or more", "'" + *options.spp + "'", ""});
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
  render.terrain = options.terrain;
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
  void write(const std::string& name, const std::string& text) const {
    OutputFile file(folder_ / name, text.size());
    std::ofstream out(file.temporary(), std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) throw Error({"cannot write", (folder_ / name).string(), "", "a failed write", ""});
    file.commit();
  }

  // Its bytes, by way of a file that goes again.
  std::string png_of(const ByteImage& image, const PictureFiles& pictures) const {
    const OutputFile file(folder_ / "picture.png", 4 * image.values.size() + (64u << 10));
    pictures.write(file.temporary(), PictureFormat::kPng, image, {}, {});
    std::ifstream in(file.temporary(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  fs::path folder_;
  bool made_ = false;
};

bool writes_png(const PictureFiles& pictures) {
  try {
    pictures.check_format("picture.png");
    return true;
  } catch (const Error&) {
    return false;
  }
}

// As one could type it.
std::string command_line(const BenchOptions& options) {
  std::string text = "nephoscope bench";
  for (const std::string& scene : options.scenes) text += " " + fs::path(scene).filename().string();
  for (const std::string& sweep : options.sweeps) text += " --sweep " + sweep;
  for (const auto& [name, value] :
       {std::pair{"--size", &options.size}, std::pair{"--repeat", &options.repeats},
        std::pair{"--spp", &options.spp}, std::pair{"--exact-orders", &options.exact_orders},
        std::pair{"--host-mib", &options.host_mib},
        std::pair{"--finest-step", &options.finest_step}, std::pair{"--terrain", &options.terrain}})
    if (*value) text += std::string(" ") + name + " " + **value;
  return text;
}

// The file's name; of two files with one name, the second is NAME-2.
std::string name_of(const BenchOptions& options, std::size_t scene) {
  const std::string name = fs::path(options.scenes[scene]).stem().string();
  int same = 1;
  for (std::size_t before = 0; before < scene; ++before)
    same += fs::path(options.scenes[before]).stem().string() == name;
  return same > 1 ? name + "-" + std::to_string(same) : name;
}

void write_report(const std::vector<bench::SceneResult>& results, const BenchOptions& options,
                  const PictureFiles& pictures, const ReportFolder& folder) {
  const bool png = writes_png(pictures);
  const std::string page = bench::page_of(
      results, command_line(options),
      [&](const ByteImage& image) { return png ? folder.png_of(image, pictures) : std::string(); });
  folder.write("bench.csv", bench::settings_csv(results));
  folder.write("terms.csv", bench::terms_csv(results));
  folder.write("orders.csv", bench::orders_csv(results));
  std::string tables;
  for (const bench::SceneResult& result : results)
    tables += "### " + result.name + "\n\n" + bench::markdown_of(result) + "\n";
  folder.write("tables.md", tables);
  for (const bench::SceneResult& result : results)
    if (const auto pareto = bench::pareto_of(result))
      folder.write(results.size() > 1 ? "pareto-" + result.name + ".svg" : "pareto.svg",
                   bench::svg_of(pareto->chart));
  folder.write("index.html", page);
}

// What a setting costs and how far it is off, and why a number is missing.
void print_summary(const bench::SceneResult& result) {
  const char* judged = bench::judged_by(result.settings);
  for (const bench::SettingResult& s : result.settings) {
    const bench::Term* term = bench::find_term(s.terms, judged);
    std::printf("%s: %s: frame %s CPU, error %s\n", result.name.c_str(), s.setting.label().c_str(),
                bench::time_text(s.times.frame_s.median).c_str(),
                term->told() ? bench::percent_text(term->rms).c_str()
                             : ("withheld: " + term->withheld).c_str());
  }
  if (const auto pareto = bench::pareto_of(result))
    std::printf("%s: %s\n", result.name.c_str(), bench::lesson_of(result, *pareto).c_str());
  const bench::Term* light = bench::find_term(result.settings.front().terms, bench::kLightModel);
  if (light && !light->told())
    std::printf("%s: light model: withheld: %s\n", result.name.c_str(), light->withheld.c_str());
}

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
      results.push_back(bench::run_scene(opened, name_of(options, s), goals, progress));
    }
  }
  write_report(results, options, pictures, folder);
  for (const bench::SceneResult& result : results) print_summary(result);
  std::printf("%s\n", (fs::path(options.output) / "index.html").c_str());
}

}  // namespace nepho
