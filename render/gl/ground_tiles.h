#pragma once

#include <cstdint>
#include <vector>

#include "gl/frame_data.h"
#include "gl/pixel_plan.h"
#include "gl/planet_data.h"
#include "tree/forest.h"

namespace nepho::gl {

// By tiles of kStrideTile pixels, for the light of the ground.
struct GroundTiles {
  // How far apart pixels may be marched: clouds' shadows and the cells of the ground's map are
  // wider.
  PixelStrides strides;
  std::vector<std::uint8_t> near_sun;  // where its disc, or the edge of it, may be
};

// `values.met` holds the distances of the ground.
GroundTiles ground_tiles(const RenderRequest& request, const Forest& forest, const FrameData& frame,
                         const PlanetScene& planet, const PixelValues& values);

}  // namespace nepho::gl
