#include "view/window_loader.h"

#include <dlfcn.h>

#include <array>

#include "core/error.h"

namespace nepho {
namespace {

constexpr const char* kModuleFile = "nepho_window.so";

// Never closed: X11 and OpenGL drivers keep threads and global state.
const WindowModule& load_module(const std::vector<std::filesystem::path>& folders) {
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path file = folder / kModuleFile;
    if (!std::filesystem::exists(file)) continue;
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library)
      throw Error({"the window module does not load", file.string(), "", dlerror(), ""});
    const auto entry =
        reinterpret_cast<nepho_window_module_fn*>(dlsym(library, "nepho_window_module"));
    const WindowModule* module = entry ? entry() : nullptr;
    if (!module || module->version != kWindowModuleVersion)
      throw Error({"the window module is of another version", file.string(),
                   std::to_string(kWindowModuleVersion),
                   module ? std::to_string(module->version) : "none", ""});
    return *module;
  }
  throw Error({"no window in this build", "view", "", std::string("no module ") + kModuleFile,
               "install GLFW and Dear ImGui (Debian: libglfw3-dev, libimgui-dev) and build again, "
               "or draw pictures with nephoscope render"});
}

}  // namespace

std::unique_ptr<Window> open_window(const std::vector<std::filesystem::path>& folders, int width,
                                    int height, const char* title) {
  const WindowModule& module = load_module(folders);
  std::array<char, 256> what{}, found{};
  std::unique_ptr<Window> window(
      module.open(width, height, title, what.data(), what.size(), found.data(), found.size()));
  if (!window)
    throw Error({what.data(), "view", "a display with OpenGL 4.5", found.data(),
                 "nephoscope render draws the same scenes without a display"});
  return window;
}

}  // namespace nepho
