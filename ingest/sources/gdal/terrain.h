#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bricks/surface_map.h"
#include "forecast/conventions/cell_window.h"

namespace nepho::gdal {

// Heights of ground as a planet's surface. Only the pixels of the region are read, and no more than
// `most_nodes` along an axis: from overviews, or as means, where there are more.
struct TerrainRequest {
  std::string file;
  std::optional<forecast::Region> region;
  int most_nodes = 4096;
  bool keep_gaps = false;  // NaN where there are no data, and around the raster; else sea
};
struct Terrain {
  std::shared_ptr<const SurfaceMap> map;
  std::vector<std::string> assumptions, facts;
};
// The first band. Without a unit its values are metres, which is said; pixels without data are sea
// unless they are kept.
// Throws Error: colours, units that are no length, heights that no planet has.
Terrain open_terrain(const TerrainRequest& request);

}  // namespace nepho::gdal
