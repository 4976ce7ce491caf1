#pragma once

#include "view/window_module.h"

namespace nepho {

// The panel in the current frame of Dear ImGui.
void draw_panel(Panel& panel);

}  // namespace nepho
