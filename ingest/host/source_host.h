#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "scene/scene.h"

namespace nepho {

// One line each of a NAME.source manifest.
struct SourceManifest {
  std::string id;
  std::filesystem::path library;
  std::vector<std::string> keys;  // its id and the file endings it reads, lower case, no dot
};

// The modules beside the program. Reading the catalogue opens no library.
class SourceHost {
 public:
  // Folders are searched in order; throws Error on an unreadable manifest, not on a missing folder.
  explicit SourceHost(std::vector<std::filesystem::path> folders);

  const std::vector<SourceManifest>& catalogue() const { return catalogue_; }
  // Null where no module answers to the key.
  const SourceManifest* find(const std::string& key) const;
  // Loads the module (once per process, never unloaded: OpenVDB, TBB and HDF5 keep global state)
  // and opens the volume. Throws Error: no such module (lists the known), ABI differs (both ids),
  // or the module's own reasons.
  std::unique_ptr<BrickSource> open(const VolumeSpec& volume) const;
  // Ids of the modules loaded so far by this process.
  static std::vector<std::string> loaded();

 private:
  std::vector<std::filesystem::path> folders_;
  std::vector<SourceManifest> catalogue_;
};

// ${NEPHO_MODULE_PATH} (if set), then ../lib/nephoscope beside the running program.
std::vector<std::filesystem::path> default_module_folders();

}  // namespace nepho
