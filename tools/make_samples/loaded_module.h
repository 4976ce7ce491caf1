#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"

namespace nepho::samples {

// A writer that is loaded and never closed: OpenVDB, TBB and HDF5 keep global state.
struct LoadedModule {
  void* handle;
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(dlsym(handle, name));
  }
};

// Throws Error where none of the folders has it, or it does not load.
inline LoadedModule load_writer(const std::vector<std::filesystem::path>& folders,
                                const std::string& file, const std::string& ending,
                                const std::string& hint) {
  std::string searched, reason = "not found";
  for (const auto& folder : folders) {
    searched += (searched.empty() ? "" : ", ") + folder.string();
    if (!std::filesystem::exists(folder / file)) continue;
    if (void* handle = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL)) return {handle};
    reason = dlerror();
  }
  throw Error(
      {"cannot write " + ending + " files", file, "the module in " + searched, reason, hint});
}

}  // namespace nepho::samples
