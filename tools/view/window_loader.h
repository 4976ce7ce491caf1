#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "view/window_module.h"

namespace nepho {

// Opens the module, and a window with a current OpenGL 4.5 core context. Throws Error: no module in
// this build, no display, an older OpenGL.
std::unique_ptr<Window> open_window(const std::vector<std::filesystem::path>& folders, int width,
                                    int height, const char* title);

}  // namespace nepho
