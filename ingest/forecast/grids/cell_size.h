#pragma once

#include <cstddef>
#include <vector>

#include "forecast/forecast.h"

namespace nepho::forecast {

// How large a grid's cells are, whoever asks: which of two domains is the finer, and the lattice
// that holds it.

struct CellSize {
  double width_m, area_m2;  // the shorter side
};

// Of about a thousand cells spread over the grid; none of cells without a place.
std::vector<CellSize> some_cells(const HorizontalGrid& grid);

// Area-weighted median over the cells of the shorter side (m).
double cell_width_m(const HorizontalGrid& grid);

// Side of a square as large as the cell (rad).
double polygon_width_rad(const CellPolygons& cells, std::size_t cell);

}  // namespace nepho::forecast
