#pragma once

#include <cstdint>
#include <vector>

#include "renderer.h"
#include "tree/forest.h"

namespace nepho::gl {

// How far apart pixels may be marched for no cloud to fall between them, for each tile of
// kStrideTile pixels: a cloud of one sample is two voxels wide, so that it covers a point of any
// grid that is no wider than a voxel. 4, 2 or 1, by the smallest voxel that any leaf with cloud
// shows in the tile.
std::vector<std::uint8_t> pixel_strides(const RenderRequest& request, const Forest& forest);

}  // namespace nepho::gl
