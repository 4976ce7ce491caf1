#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "forecast/forecast.h"

namespace nepho::forecast {

// A part of the planet, and the cells of a model's grid that lie in it.

struct Region {
  double south_deg = -90, west_deg = -180, north_deg = 90;
  double east_deg = 180;  // in (west, west + 360]: continuous across the antimeridian
};

// "SOUTH,WEST,NORTH,EAST" in degrees, longitudes -180 to 360; WEST > EAST goes across the
// antimeridian. Throws Error, naming `where`.
Region parse_region(const std::string& text, const std::string& where);
std::string to_text(const Region& region);

// Rows and columns of a grid. Columns run on at 0 where the grid goes around.
struct CellWindow {
  int x0 = 0, y0 = 0, nx = 0, ny = 0;
  // Of cells in a row, which lie in no order: the columns that count. The others are read with
  // them, and have no place. Empty where all count.
  std::vector<char> inside = {};
};

// The smallest range of rows and columns with all cells that overlap the region on any of the grids
// (places of one nest), and one cell more on each side: hats at the region's edge reach into it.
// Cells count by the latitudes and longitudes of their corners. Throws Error where none does, with
// the grid's own bounds and `file`.
CellWindow window_of(std::span<const std::shared_ptr<const HorizontalGrid>> grids,
                     const Region& region, const std::string& file);

// The window's cells as a grid of their own, in the same places to the last bit. It goes around
// where the window is the whole turn.
std::shared_ptr<const HorizontalGrid> windowed(std::shared_ptr<const HorizontalGrid> grid,
                                               const CellWindow& window);

// "Region ...: 14 x 12 of 144 x 73 cells, ..."
std::string window_fact(const Region& region, const CellWindow& window, const HorizontalGrid& grid);

}  // namespace nepho::forecast
