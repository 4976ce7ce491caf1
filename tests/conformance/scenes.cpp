#include "scenes.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "bricks/coarsen.h"
#include "bricks/quantise.h"

namespace nepho::test {
namespace {

struct Value {
  std::string name;
  double number = 0;
  std::string text = {};
};

ConformanceScene analytic(const std::string& name, const std::vector<Value>& values,
                          std::optional<GeodeticPlace> place = {}) {
  VolumeSpec volume;
  volume.name = name;
  volume.source = "analytic";
  volume.place = place;
  for (const Value& value : values) {
    SourceParameter parameter;
    parameter.name = value.name;
    parameter.number = value.number;
    parameter.text = value.text;
    parameter.is_text = !value.text.empty();
    volume.parameters.push_back(parameter);
  }
  return {name, volume, "analytic", 0, true};
}

Value kind(const std::string& word) {
  return {"kind", 0, word};
}
const Value kShell = {"chart", 0, "shell"};

std::uint64_t fnv(std::uint64_t hash, const void* data, std::size_t size) {
  const auto* byte = static_cast<const unsigned char*>(data);
  for (std::size_t at = 0; at < size; ++at) hash = (hash ^ byte[at]) * 0x100000001b3u;
  return hash;
}

}  // namespace

std::vector<ConformanceScene> analytic_scenes() {
  // A corner of three cube faces, and a town.
  const GeodeticPlace cube_corner = {35.2644, 45, 6000, 0}, town = {47.4, 8.5, 1200, 30};
  return {
      analytic("constant", {kind("constant"), {"max_level", 2}}),
      analytic("slab", {kind("slab"), {"max_level", 2}, {"size_z_m", 250}}),
      analytic("cube", {kind("cube"), {"max_level", 1}, {"optical_depth", 50}}),
      analytic("half_space", {kind("half_space"), {"max_level", 1}}),
      analytic("sphere", {kind("sphere"), {"max_level", 3}, {"radius_m", 400}}),
      analytic("gaussian", {kind("gaussian"), {"max_level", 3}}),
      analytic("gaussian_fine", {kind("gaussian"), {"max_level", 4}}),
      analytic("gaussian_leaning",
               {kind("gaussian"), {"max_level", 3}, {"shear_xz", 0.7}, {"shear_yz", -0.3}}, town),
      analytic("exponential", {kind("exponential"), {"max_level", 4}}),
      analytic("exponential_xyz", {kind("exponential"), {"max_level", 2}, {"split_axes", 0, "xyz"}},
               town),
      analytic("step_cloud", {kind("step_cloud"), {"max_level", 5}}),
      analytic("step_cloud_xyz", {kind("step_cloud"), {"max_level", 2}, {"split_axes", 0, "xyz"}}),
      analytic("shell_slab", {kind("slab"), kShell, {"max_level", 1}}),
      analytic("shell_exponential",
               {kind("exponential"), kShell, {"max_level", 2}, {"split_axes", 0, "xyz"}}),
      analytic("shell_exponential_z",
               {kind("exponential"), kShell, {"body_radius_m", 6.37e6}, {"max_level", 4}}),
      analytic("shell_gaussian_corner",
               {kind("gaussian"), kShell, {"max_level", 5}, {"sigma_m", 2e5}, {"aspect", 40}},
               cube_corner),
  };
}

// The sky as a whole, so coarse that all of it can be visited, and its upper levels as they are.
std::vector<ConformanceScene> noise_scenes() {
  std::vector<ConformanceScene> scenes = {
      analytic("noise_coarse", {{"seed", 3}, {"finest_resolution_m", 8e4}}),
      analytic("noise_coarse_deep",
               {{"layer1.base_m", 0}, {"layer1.top_m", 3e4}, {"finest_resolution_m", 1.5e5}}),
      analytic("noise_fine", {{"seed", 3}})};
  for (ConformanceScene& scene : scenes)
    scene.volume.source = scene.source = "noise", scene.conserves = false;
  return scenes;
}

std::vector<ConformanceScene> file_scenes() {
  std::vector<ConformanceScene> scenes;
  const SourceHost host(default_module_folders());
  const char* files = std::getenv("NEPHO_CONFORMANCE_FILES");
  std::istringstream parts(files ? files : "");
  for (std::string file; std::getline(parts, file, ':');) {
    if (file.empty()) continue;
    ConformanceScene scene;
    if (const auto at = file.find('@', file.rfind('/') + 1); at != file.npos) {
      scene.time = std::stoul(file.substr(at + 1));
      scene.name = "_time" + file.substr(at + 1);
      file.resize(at);
    }
    const std::filesystem::path path = file;
    const std::string ending = path.extension().string();
    const SourceManifest* module = host.find(ending.empty() ? "" : ending.substr(1));
    scene.source = module ? module->id : "none";
    scene.name = path.stem().string() + scene.name;
    std::erase_if(scene.name, [](char c) { return c == '#' || c == '.'; });
    for (char& c : scene.name)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    scene.volume.name = scene.name;
    scene.volume.files = {file};
    scenes.push_back(scene);
  }
  return scenes;
}

std::unique_ptr<BrickSource> open_scene(const VolumeSpec& volume) {
  return SourceHost(default_module_folders()).open(volume);
}

DecodedBrick read_decoded(const BrickSource& source, NodeKey key, double time_s) {
  std::vector<std::uint16_t> codes(kBrickVolume);
  ChannelView view;
  view.codes = codes.data();
  const Status status = source.read(key, time_s, {&view, 1});
  if (status != Status::kOk) throw std::runtime_error(to_string(status));
  DecodedBrick brick;
  for (const std::uint16_t code : codes)
    brick.value.push_back(double(decode(code, view.scale, view.offset)));
  brick.max_abs_error = view.max_abs_error;
  brick.hash = fnv(0xcbf29ce484222325u, codes.data(), codes.size() * sizeof codes[0]);
  brick.hash = fnv(brick.hash, &view.scale, sizeof view.scale);
  brick.hash = fnv(brick.hash, &view.offset, sizeof view.offset);
  brick.hash = fnv(brick.hash, &view.max_abs_error, sizeof view.max_abs_error);
  return brick;
}

NodeSummary summary_of(const BrickSource& source, NodeKey key, double time_s) {
  NodeSummary summary;
  const Status status = source.summary(key, time_s, summary);
  if (status != Status::kOk) throw std::runtime_error(to_string(status));
  return summary;
}

std::vector<std::vector<NodeKey>> nodes_by_level(const BrickSource& source, std::size_t most,
                                                 double time_s) {
  const VolumeInfo& info = source.info();
  std::vector<std::vector<NodeKey>> levels(1);
  for (int root = 0; root < info.chart->roots(); ++root) levels[0].emplace_back(root, 0, 0, 0, 0);
  for (int level = 0; level < info.lattice.max_level(); ++level) {
    std::vector<NodeKey> finer;
    for (const NodeKey key : levels.back())
      if (summary_of(source, key, time_s).children)
        for (const NodeKey child : info.lattice.children(key)) finer.push_back(child);
    if (finer.empty() || finer.size() > most) break;
    std::ranges::sort(finer);
    levels.push_back(std::move(finer));
  }
  return levels;
}

}  // namespace nepho::test
