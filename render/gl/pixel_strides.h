#pragma once

#include "gl/pixel_plan.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho::gl {

// How far apart pixels may be marched for no cloud to fall between them. A cloud of one sample is
// two voxels wide: a grid of kPerVoxel voxels has a point where the sample still counts for a
// quarter. By the smallest voxel that any leaf with cloud shows in the tile, along rows and
// columns.
PixelStrides pixel_strides(const RenderRequest& request, const Forest& forest);

}  // namespace nepho::gl
