// make_samples OUT_DIR: the sample clouds of the demo. --help says the rest.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "cumulus.h"
#include "global_forecast.h"
#include "les_field.h"
#include "made_vertical.h"
#include "nc_twins.h"
#include "plume.h"
#include "twins.h"
#include "wrf_forecast.h"

namespace {

using namespace nepho;
using namespace nepho::samples;
namespace fs = std::filesystem;

constexpr int kVersion = 2;  // of the samples: another number makes them anew

constexpr const char* kUsage =
    "usage: make_samples OUT_DIR [--only NAME,...] [--size small|default|large] [--force]\n"
    "       make_samples OUT_DIR [--only NAME] --size NXxNYxNZ [--times N]\n"
    "       make_samples OUT_DIR --like TWIN | all\n"
    "       make_samples OUT_DIR --grid GRID --vertical VERTICAL [--order up|down]\n"
    "       make_samples --list\n";

constexpr const char* kHelp =
    "\nSamples (NAME): cumulus and plume (.vdb), forecast (in the form of WRF), les (a large-eddy\n"
    "simulation in CF NetCDF), globe (a packed global analysis on 16 pressure levels). By --only "
    "alone:\n"
    "pair, two clouds 26 km apart in one .vdb of 2128 x 192 x 1192 voxels, nearly all of them "
    "empty.\n"
    "--size NXxNYxNZ makes one of the NetCDF samples (forecast where --only names none) with so "
    "many\n"
    "cells, one level in memory at a time, into NAME_NXxNYxNZ.nc; --times: of a forecast, hourly.\n"
    "--like makes a small twin of a trap in real files. Example: a forecast of 200 x 200 x 40 "
    "cells\n"
    "and three times,\n"
    "  make_samples /tmp/big --size 200x200x40 --times 3\n\n"
    "--grid and --vertical make GRID_VERTICAL_ORDER.nc: one cloud on a grid and on levels of "
    "those\n"
    "names (--list), levels from the ground up or the top down, by formulas that share nothing "
    "with\n"
    "the reader.\n\nTwins:\n";

struct Cells {
  std::size_t nx = 0, ny = 0, nz = 0;
};

struct Options {
  std::string folder, size = "default", like, grid, vertical, order = "up";
  std::vector<std::string> only;
  std::optional<Cells> cells;
  std::size_t times = 1;
  bool list = false, force = false, help = false;
};

std::optional<Cells> cells_of(const std::string& text) {
  Cells c;
  int used = 0;
  const bool whole =
      std::sscanf(text.c_str(), "%5zux%5zux%4zu%n", &c.nx, &c.ny, &c.nz, &used) == 3 &&
      std::size_t(used) == text.size();
  if (!whole || c.nx < 4 || c.ny < 4 || c.nz < 4) return std::nullopt;
  return c;
}

bool parse(int count, char** words, Options& o) {
  for (int at = 1; at < count; ++at) {
    const std::string word = words[at];
    const bool has_next = at + 1 < count;
    if (word == "--list") {
      o.list = true;
    } else if (word == "--help" || word == "-h") {
      o.help = true;
    } else if (word == "--force") {
      o.force = true;
    } else if (word == "--size" && has_next) {
      o.size = words[++at];
      o.cells = cells_of(o.size);
    } else if (word == "--times" && has_next) {
      o.times = std::size_t(std::max(0, std::atoi(words[++at])));
    } else if (word == "--like" && has_next) {
      o.like = words[++at];
    } else if (word == "--grid" && has_next) {
      o.grid = words[++at];
    } else if (word == "--vertical" && has_next) {
      o.vertical = words[++at];
    } else if (word == "--order" && has_next) {
      o.order = words[++at];
    } else if (word == "--only" && has_next) {
      std::istringstream names(words[++at]);
      for (std::string name; std::getline(names, name, ',');) o.only.push_back(name);
    } else if (word.starts_with("-") || !o.folder.empty()) {
      return false;
    } else {
      o.folder = word;
    }
  }
  const bool known = o.size == "small" || o.size == "default" || o.size == "large" || o.cells;
  if (o.grid.empty() != o.vertical.empty()) return false;
  const bool fits = o.times >= 1 && o.times <= 1000 && (o.times == 1 || o.cells);
  return known && fits && (o.list || o.help || !o.folder.empty());
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

void write_cumulus(const fs::path& folder, double scale) {
  const VdbWriter writer(module_folders());
  CumulusShape shape;
  shape.voxel_m /= scale;
  for (auto& cells : shape.size) cells = 8 * std::int32_t(scale * cells / 8);
  const double start_s = seconds();
  SampleGrid grid = make_cumulus(shape);
  grid.value = VdbValue::kHalf;
  writer.write(folder / "cumulus.vdb", {grid});
  report(folder / "cumulus.vdb", start_s);
}

// One cloud twice: a box of 487 million voxels, 1.9 GB where they are stored densely.
void write_pair(const fs::path& folder) {
  constexpr double kFiner = 1.6;
  constexpr Voxel kApart{1872, 0, 936};  // 26.2 km
  const double start_s = seconds();
  CumulusShape shape;
  shape.voxel_m /= kFiner;
  for (auto& cells : shape.size) cells = 8 * std::int32_t(kFiner * cells / 8);
  SampleGrid grid = make_cumulus(shape);
  grid.value = VdbValue::kHalf;
  std::vector<SampleBlock> twin = grid.blocks;
  for (SampleBlock& block : twin)
    for (std::size_t a = 0; a < 3; ++a) block.origin[a] += kApart[a];
  grid.blocks.insert(grid.blocks.end(), twin.begin(), twin.end());
  const fs::path path = folder / "pair.vdb";
  VdbWriter(module_folders()).write(path, {grid});
  report(path, start_s);
}

void write_plume(const fs::path& folder, double scale) {
  const VdbWriter writer(module_folders());
  PlumeSettings settings;
  settings.nx = int(settings.nx * scale), settings.ny = int(settings.ny * scale);
  settings.nz = int(settings.nz * scale), settings.source_radius *= float(scale);
  std::vector<int> steps;
  for (int frame = 0; frame < 6; ++frame) steps.push_back(int(28 * frame * scale));
  const double start_s = seconds();
  auto frames = make_plume(settings, 5 / scale, steps);
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const fs::path path = folder / ("plume.000" + std::to_string(frame) + ".vdb");
    frames[frame].value = VdbValue::kHalf;
    writer.write(path, {frames[frame]});
    report(path, start_s);
  }
}

// The same sky in cells of another size, or in so many of the same.
void write_forecast(const fs::path& path, double scale, const Options& o) {
  WrfShape shape;
  shape.nx = std::size_t(double(shape.nx) * scale),
  shape.ny = std::size_t(double(shape.ny) * scale);
  shape.nz = std::size_t(double(shape.nz) * scale), shape.cell_m /= scale;
  if (o.cells) shape.nx = o.cells->nx, shape.ny = o.cells->ny, shape.nz = o.cells->nz;
  shape.times = o.times;
  const double start_s = seconds();
  write_wrf(NcWriter(module_folders()), path, shape);
  report(path, start_s);
}

void write_les_sample(const fs::path& path, double scale, const Options& o) {
  LesShape shape;
  shape.nx = std::size_t(double(shape.nx) * scale),
  shape.ny = std::size_t(double(shape.ny) * scale);
  shape.nz = std::size_t(double(shape.nz) * scale);
  shape.cell_m /= scale, shape.level_m /= scale;
  if (o.cells) shape.nx = o.cells->nx, shape.ny = o.cells->ny, shape.nz = o.cells->nz;
  const double start_s = seconds();
  write_les(NcWriter(module_folders()), path, shape);
  report(path, start_s);
}

void write_globe(const fs::path& path, double scale, const Options& o) {
  GlobalShape shape;
  shape.nx = std::size_t(double(shape.nx) * scale);
  shape.ny = std::size_t(double(shape.ny - 1) * scale) + 1;
  if (o.cells) shape.nx = o.cells->nx, shape.ny = o.cells->ny;
  const double start_s = seconds();
  write_global(NcWriter(module_folders()), path, shape);
  report(path, start_s);
}

// A build without OpenVDB or NetCDF makes what it can.
bool can_write(const std::string& name) {
  const bool vdb = name == "cumulus" || name == "plume" || name == "pair";
  return fs::exists(module_folders().front() /
                    (vdb ? "nepho_vdb_writer.so" : "nepho_nc_writer.so"));
}

const std::vector<std::string> kNames = {"cumulus", "plume", "forecast", "les", "globe"};

void write_sample(const std::string& name, const fs::path& folder, double scale, const Options& o) {
  const fs::path path = folder / (name + (o.cells ? "_" + o.size : "") + ".nc");
  if (name == "cumulus") write_cumulus(folder, scale);
  if (name == "plume") write_plume(folder, scale);
  if (name == "pair") write_pair(folder);
  if (name == "forecast") write_forecast(path, scale, o);
  if (name == "les") write_les_sample(path, scale, o);
  if (name == "globe") write_globe(path, scale, o);
}

void write_large(const Options& o) {
  const std::string name = o.only.empty() ? "forecast" : o.only.front();
  if (o.only.size() > 1 || name == "cumulus" || name == "plume" || name == "pair")
    throw Error({"no such size of it", "--size " + o.size, "with --only forecast, les or globe",
                 "--only " + name, ""});
  if (name == "globe" && o.cells->nz != 16)
    throw Error({"no such size of it", "--size " + o.size, "16 levels for globe",
                 std::to_string(o.cells->nz), ""});
  if (o.times > 1 && name != "forecast")
    throw Error({"only a forecast has times", "--times", "--only forecast", "--only " + name, ""});
  fs::create_directories(o.folder);
  write_sample(name, o.folder, 1, o);
}

// Nothing is made again where this note of a finished run is found.
void write_samples(const Options& o) {
  std::vector<std::string> wanted = o.only.empty() ? kNames : o.only;
  for (const std::string& name : wanted)
    if (std::ranges::find(kNames, name) == kNames.end() && name != "pair")
      throw Error(
          {"no such sample", "--only", "cumulus, plume, forecast, les, globe or pair", name, ""});
  const fs::path folder = o.folder, note = folder / "samples.done";
  std::string text = "version " + std::to_string(kVersion) + ", size " + o.size;
  if (o.only.empty())
    std::erase_if(wanted, [&](const std::string& name) {
      if (can_write(name)) return false;
      std::printf("left out %s: this build has no writer for it\n", name.c_str());
      text += ", without " + name;
      return true;
    });
  std::string found;
  std::getline(std::ifstream(note), found);
  if (found == text && !o.force) {
    std::printf("%s: the samples are there already (--force makes them anew)\n", folder.c_str());
    return;
  }
  fs::create_directories(folder);
  fs::remove(note);
  const double scale = o.size == "small" ? 0.5 : o.size == "large" ? 2 : 1;
  for (const std::string& name : wanted) write_sample(name, folder, scale, o);
  if (o.only.empty()) std::ofstream(note) << text << '\n';
}

template <class Writer, class Twins>
bool write_twins(const Options& o, const Twins& twins) {
  std::optional<Writer> writer;
  for (const auto& twin : twins) {
    if (o.like != "all" && o.like != twin.name) continue;
    if (!writer) writer.emplace(module_folders());
    twin.write(o.folder, *writer);
    std::printf("%s: %s\n", (fs::path(o.folder) / twin.file).c_str(), twin.what.c_str());
  }
  return writer.has_value();
}

void write_all_twins(const Options& o) {
  fs::create_directories(o.folder);
  const bool vdb = write_twins<VdbWriter>(o, twins());
  const bool nc = write_twins<NcWriter>(o, nc_twins());
  if (!vdb && !nc) throw Error({"no such twin", "--like", "one that --list names", o.like, ""});
}

void print_twins() {
  for (const Twin& twin : twins()) std::printf("%-20s %s\n", twin.name.c_str(), twin.what.c_str());
  for (const NcTwin& twin : nc_twins())
    std::printf("%-20s %s\n", twin.name.c_str(), twin.what.c_str());
  const auto list = [](const char* what, const std::vector<std::string>& names) {
    std::printf("%s:", what);
    for (const std::string& name : names) std::printf(" %s", name.c_str());
    std::printf("\n");
  };
  list("--grid", made_grid_names());
  list("--vertical", made_vertical_names());
}

void write_made_file(const Options& o) {
  const fs::path path = fs::path(o.folder) / (o.grid + "_" + o.vertical + "_" + o.order + ".nc");
  fs::create_directories(o.folder);
  const double start_s = seconds();
  write_made(path, o.grid, o.vertical, o.order, NcWriter(module_folders()));
  report(path, start_s);
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (!parse(count, words, options)) return std::fputs(kUsage, stderr), 2;
  try {
    if (options.help) std::printf("%s%s", kUsage, kHelp);
    if (options.help || options.list)
      print_twins();
    else if (!options.grid.empty())
      write_made_file(options);
    else if (!options.like.empty())
      write_all_twins(options);
    else if (options.cells)
      write_large(options);
    else
      write_samples(options);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_samples: %s\n", e.what());
    return 1;
  }
}
