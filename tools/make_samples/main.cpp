// make_samples OUT_DIR [--size small|default|large] [--force]: the sample clouds of the demo.
// make_samples OUT_DIR --like NAME: a small twin of a trap in real files; --list names them.

#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "cumulus.h"
#include "global_forecast.h"
#include "les_field.h"
#include "plume.h"
#include "twins.h"
#include "wrf_forecast.h"

namespace {

using namespace nepho;
using namespace nepho::samples;
namespace fs = std::filesystem;

constexpr int kVersion = 1;  // of the samples: another number makes them anew

constexpr const char* kUsage =
    "usage: make_samples OUT_DIR [--size small|default|large] [--force]\n"
    "       make_samples OUT_DIR --like NAME | all\n"
    "       make_samples --list\n";

struct Options {
  std::string folder, size = "default", like;
  bool list = false, force = false;
};

bool parse(int count, char** words, Options& options) {
  for (int at = 1; at < count; ++at) {
    const std::string word = words[at];
    const bool has_next = at + 1 < count;
    if (word == "--list")
      options.list = true;
    else if (word == "--force")
      options.force = true;
    else if (word == "--size" && has_next)
      options.size = words[++at];
    else if (word == "--like" && has_next)
      options.like = words[++at];
    else if (word.starts_with("-") || !options.folder.empty())
      return false;
    else
      options.folder = word;
  }
  const bool known =
      options.size == "small" || options.size == "default" || options.size == "large";
  return known && (options.list || !options.folder.empty());
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<fs::path> module_folders() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  return {program.parent_path().parent_path() / "lib" / "nephoscope"};
}

void report(const fs::path& path, double since_s) {
  std::printf("%s  %.0f kB  %.1f s\n", path.c_str(), double(fs::file_size(path)) / 1e3,
              seconds() - since_s);
  std::fflush(stdout);
}

void write_cumulus(const fs::path& folder, double scale, const VdbWriter& writer) {
  CumulusShape shape;
  shape.voxel_m /= scale;
  for (auto& cells : shape.size) cells = 8 * std::int32_t(scale * cells / 8);
  const double start_s = seconds();
  writer.write(folder / "cumulus.vdb", {make_cumulus(shape)});
  report(folder / "cumulus.vdb", start_s);
}

void write_plume(const fs::path& folder, double scale, const VdbWriter& writer) {
  PlumeSettings settings;
  settings.nx = int(settings.nx * scale), settings.ny = int(settings.ny * scale);
  settings.nz = int(settings.nz * scale), settings.source_radius *= float(scale);
  std::vector<int> steps;
  for (int frame = 0; frame < 6; ++frame) steps.push_back(int(28 * frame * scale));
  const double start_s = seconds();
  const auto frames = make_plume(settings, 5 / scale, steps);
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const fs::path path = folder / ("plume.000" + std::to_string(frame) + ".vdb");
    writer.write(path, {frames[frame]});
    report(path, start_s);
  }
}

// Nothing is made again where this note of a finished run is found.
void write_samples(const Options& options) {
  const fs::path folder = options.folder, note = folder / "samples.done";
  const std::string text = "version " + std::to_string(kVersion) + ", size " + options.size;
  std::string found;
  std::getline(std::ifstream(note), found);
  if (found == text && !options.force) {
    std::printf("%s: the samples are there already (--force makes them anew)\n", folder.c_str());
    return;
  }
  fs::create_directories(folder);
  fs::remove(note);
  if (options.size == "small") {
    write_wrf(NcWriter(module_folders()), folder / "forecast.nc", {});
    report(folder / "forecast.nc", seconds());
    write_les(NcWriter(module_folders()), folder / "les.nc", {});
    report(folder / "les.nc", seconds());
    write_global(NcWriter(module_folders()), folder / "globe.nc", {});
    report(folder / "globe.nc", seconds());
    return;
  }
  const VdbWriter writer(module_folders());
  const double scale = options.size == "small" ? 0.5 : options.size == "large" ? 2 : 1;
  write_cumulus(folder, scale, writer);
  write_plume(folder, scale, writer);
  std::ofstream(note) << text << '\n';
}

void write_twins(const Options& options) {
  const VdbWriter writer(module_folders());
  fs::create_directories(options.folder);
  bool found = false;
  for (const Twin& twin : twins()) {
    if (options.like != "all" && options.like != twin.name) continue;
    found = true;
    twin.write(options.folder, writer);
    std::printf("%s: %s\n", (fs::path(options.folder) / twin.file).c_str(), twin.what.c_str());
  }
  if (!found) throw Error({"no such twin", "--like", "one that --list names", options.like, ""});
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (!parse(count, words, options)) return std::fputs(kUsage, stderr), 2;
  try {
    if (options.list)
      for (const Twin& twin : twins())
        std::printf("%-18s %s\n", twin.name.c_str(), twin.what.c_str());
    else if (!options.like.empty())
      write_twins(options);
    else
      write_samples(options);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_samples: %s\n", e.what());
    return 1;
  }
}
