#pragma once

#include <memory>

#include "common/open_scene.h"

namespace nepho {

// The scene's terrain: read where the clouds are, and 200 km around them (all of it under clouds of
// the whole planet, and under none), in place of the data's own ground, which stays where the
// terrain has no data. Sets the request's terrain and the source that holds it; says what was
// assumed. Throws Error: unreadable, or nothing that stands on the Earth.
void open_terrain(const SourceHost& host, OpenedScene& opened);

}  // namespace nepho
