#pragma once

#include <memory>

#include "common/open_scene.h"

namespace nepho {

// The scene's terrain: read where the clouds are, and 200 km around them (all of it under clouds of
// the whole planet, and under none), in place of the data's own ground, which stays where the
// terrain has no data. Sets the scene's terrain and the request's; says what was assumed. Throws
// Error: unreadable, or nothing that stands on the Earth.
void open_terrain(const SourceHost& host, OpenedScene& opened);

// `fine`, and the data's `own` ground around it and where its heights are NaN, on nodes as fine as
// those of `fine` over both. Null where that takes too many of them, or `own` is a whole planet's.
//
// Without such ground, filled_ground(): where heights are NaN, and on a rim around them all, the
// ground falls to the sea at 60 degrees. Cliffs of one node are steeper than the renderers take.
std::shared_ptr<SurfaceMap> filled_ground(const SurfaceMap& fine);
std::shared_ptr<SurfaceMap> joined_ground(const SurfaceMap& fine, const SurfaceMap& own);

}  // namespace nepho
