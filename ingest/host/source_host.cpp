#include "host/source_host.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <numbers>
#include <sstream>

#include "api/module_support.h"
#include "bricks/shell_chart.h"
#include "core/error.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

// netCDF-C and HDF5 exist once per process, so their lock does too. Never destroyed: modules are
// never unloaded either.
std::mutex& io_mutex() {
  static auto* mutex = new std::mutex;
  return *mutex;
}

struct Registry {
  std::mutex mutex;
  std::map<fs::path, const SourceModule*> modules;
  std::vector<std::string> ids;  // in order of loading
};
Registry& registry() {
  static auto* registry = new Registry;
  return *registry;
}

std::vector<std::string> words_after(const std::string& head, const std::string& line,
                                     const std::string& where) {
  std::istringstream words(line);
  std::string word;
  std::vector<std::string> result;
  if (!(words >> word) || word != head)
    throw Error({"bad manifest", where, "'" + head + " ...'", "'" + line + "'", ""});
  while (words >> word) result.push_back(word);
  if (result.empty())
    throw Error({"bad manifest", where, "something after '" + head + "'", "nothing", ""});
  return result;
}

SourceManifest read_manifest(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw Error({"cannot read the manifest", path.string(), "", "", ""});
  auto next = [&, line = 0](const char* head) mutable {
    std::string text;
    std::getline(file, text);
    return words_after(head, text, path.string() + ":" + std::to_string(++line));
  };
  SourceManifest manifest;
  manifest.id = next("id").front();
  manifest.library = path.parent_path() / next("library").front();
  manifest.keys = next("keys");
  return manifest;
}

std::string described(const AbiId& abi) {
  char text[160];
  std::snprintf(text, sizeof text, "contract %u, layout %016llx, %.63s", abi.contract_version,
                static_cast<unsigned long long>(abi.layout_hash), abi.compiler);
  return text;
}

const SourceModule* load(const SourceManifest& manifest) {
  // Now and local: a missing symbol is an error here and not later, and two modules may hold
  // different versions of one static library.
  void* library = dlopen(manifest.library.c_str(), RTLD_NOW | RTLD_LOCAL);
  const std::string where = manifest.library.string();
  if (!library) throw Error({"cannot load the source module", where, "", dlerror(), ""});
  const auto entry =
      reinterpret_cast<nepho_source_module_fn*>(dlsym(library, "nepho_source_module"));
  const SourceModule* module = entry ? entry() : nullptr;
  if (!module)
    throw Error({"not a source module", where, "the symbol nepho_source_module", "none", ""});
  const AbiId own = this_abi();
  // The compiler's name is for the reader: what its ABI changes is in the hash.
  if (module->abi.contract_version != own.contract_version ||
      module->abi.layout_hash != own.layout_hash)
    throw Error({"the source module was built for another nephoscope", where, described(own),
                 described(module->abi), "build both from one tree, with one preset"});
  return module;
}

const SourceModule& loaded_module(const SourceManifest& manifest) {
  Registry& all = registry();
  const std::lock_guard guard(all.mutex);
  const SourceModule*& module = all.modules[manifest.library];
  if (!module) {
    module = load(manifest);
    all.ids.push_back(manifest.id);
  }
  return *module;
}

// x to the right of the heading, y along it (clockwise from north), z up.
Placement placement_of(const GeodeticPlace& place) {
  constexpr double radian = std::numbers::pi / 180;
  const double latitude = place.latitude_deg * radian, longitude = place.longitude_deg * radian;
  const double heading = place.heading_deg * radian;
  const glm::dvec3 origin =
      geodetic_to_ecef_m(Ellipsoid::wgs84(), latitude, longitude, place.height_m);
  const double sp = std::sin(latitude), cp = std::cos(latitude);
  const double sl = std::sin(longitude), cl = std::cos(longitude);
  const glm::dvec3 east = {-sl, cl, 0}, north = {-sp * cl, -sp * sl, cp},
                   up = {cp * cl, cp * sl, sp};
  const glm::dvec3 right = std::cos(heading) * east - std::sin(heading) * north;
  const glm::dvec3 ahead = std::sin(heading) * east + std::cos(heading) * north;
  Placement result;
  int at = 0;
  for (const glm::dvec3& axis : {right, ahead, up})
    for (int c = 0; c < 3; ++c) result.axes[at++] = axis[c];
  for (int c = 0; c < 3; ++c) result.origin_ecef_m[c] = origin[c];
  return result;
}

std::string ending_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

void forward_log(void*, LogLevel level, const char* text) {
  log(level, text);
}

}  // namespace

SourceHost::SourceHost(std::vector<fs::path> folders) : folders_(std::move(folders)) {
  for (const fs::path& folder : folders_) {
    std::error_code missing;
    std::vector<fs::path> manifests;
    for (const auto& entry : fs::directory_iterator(folder, missing))
      if (entry.path().extension() == ".source") manifests.push_back(entry.path());
    std::ranges::sort(manifests);
    for (const fs::path& path : manifests) {
      SourceManifest manifest = read_manifest(path);
      // The first folder wins, so that NEPHO_MODULE_PATH can replace a module.
      const auto same = [&](const SourceManifest& m) { return m.id == manifest.id; };
      if (std::ranges::none_of(catalogue_, same)) catalogue_.push_back(std::move(manifest));
    }
  }
}

const SourceManifest* SourceHost::find(const std::string& key) const {
  for (const SourceManifest& manifest : catalogue_)
    if (manifest.id == key || std::ranges::find(manifest.keys, key) != manifest.keys.end())
      return &manifest;
  return nullptr;
}

std::unique_ptr<BrickSource> SourceHost::open(const VolumeSpec& volume) const {
  const std::string key =
      volume.source.empty() && !volume.files.empty() ? ending_of(volume.files[0]) : volume.source;
  const SourceManifest* manifest = find(key);
  if (!manifest) {
    std::string known, searched;
    std::vector<std::string> keys;
    for (const SourceManifest& m : catalogue_) {
      known += (known.empty() ? "" : ", ") + m.id;
      keys.insert(keys.end(), m.keys.begin(), m.keys.end());
    }
    for (const fs::path& folder : folders_)
      searched += (searched.empty() ? "" : ", ") + folder.string();
    const auto near = did_you_mean(key, keys);
    throw Error({"no source module answers to '" + key + "'", "volume '" + volume.name + "'",
                 known.empty() ? "a module in " + searched : "one of " + known, "",
                 near ? "did you mean " + *near + "?" : "searched " + searched});
  }
  const SourceModule& module = loaded_module(*manifest);

  std::vector<const char*> files;
  for (const std::string& file : volume.files) files.push_back(file.c_str());
  std::vector<RequestParameter> parameters;
  for (const SourceParameter& p : volume.parameters)
    parameters.push_back(
        {p.name.c_str(), p.is_text ? p.text.c_str() : nullptr, p.number, p.unit.c_str()});
  const SourceRequest request = {
      volume.name.c_str(),
      files.data(),
      files.size(),
      parameters.data(),
      parameters.size(),
      volume.place ? placement_of(*volume.place) : Placement{},
      {[](void* mutex) { static_cast<std::mutex*>(mutex)->lock(); },
       [](void* mutex) { static_cast<std::mutex*>(mutex)->unlock(); }, &io_mutex()},
      forward_log,
      nullptr};
  ModuleError error{};
  std::unique_ptr<BrickSource> source(module.open(&request, &error));
  if (!source) throw Error({error.what, error.where, error.expected, error.found, error.hint});
  return source;
}

std::vector<std::string> SourceHost::loaded() {
  Registry& all = registry();
  const std::lock_guard guard(all.mutex);
  return all.ids;
}

std::vector<fs::path> default_module_folders() {
  std::vector<fs::path> folders;
  if (const char* path = std::getenv("NEPHO_MODULE_PATH")) {
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, ':');)
      if (!part.empty()) folders.emplace_back(part);
  }
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  if (!unknown) folders.push_back(program.parent_path().parent_path() / "lib" / "nephoscope");
  return folders;
}

}  // namespace nepho
