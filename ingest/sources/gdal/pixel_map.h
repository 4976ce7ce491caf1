#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "forecast/conventions/cell_window.h"
#include "forecast/forecast.h"
#include "geo/map_projection.h"

namespace nepho::gdal {

// Where a raster lies: its size, GDAL's affine transform from (column, line), counted from the
// corner of the first pixel, to its system's coordinates, and that system.
struct RasterPlace {
  int nx = 0, ny = 0;
  std::array<double, 6> transform{0, 1, 0, 0, 0, 1};
  bool geographic = false;
  double unit_deg = 1;  // of a geographic system's coordinates
  std::string wkt;      // of any other

  RasterPlace part(const forecast::CellWindow& window) const;
  bool upright() const { return transform[2] == 0 && transform[4] == 0; }
  friend bool operator==(const RasterPlace&, const RasterPlace&) = default;
};

// A raster's pixels as coordinates of a map: x columns, y lines. Longitudes count from the raster's
// middle, so that one across the antimeridian is no special case. `where` is for errors.
std::shared_ptr<const MapFormula> pixel_map(const RasterPlace& place, const std::string& where);

// Blocks of `coarse` x `coarse` pixels as cells, the last ones cut at the raster's edge. Geographic
// ones may go all the way round; of those a column that repeats the first is left out.
std::shared_ptr<const forecast::HorizontalGrid> grid_of(const RasterPlace& place, int coarse,
                                                        const std::string& where);

}  // namespace nepho::gdal
