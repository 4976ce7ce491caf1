#pragma once

#include <vector>

#include "forecast/forecast.h"

namespace nepho::forecast {

// Voronoi's cells of places on the sphere: all that is nearer to a place than to any other. Exact
// where a cell's walls are those to its 24 nearest neighbours, as they are in models' grids: great
// circles half way, which are straight lines on the plane that touches the place. A cell that is
// open on one side ends 0.6 times as far from its place as its third neighbour (the rim of an
// area).
CellPolygons voronoi_cells(const std::vector<glm::dvec2>& centre_deg);

}  // namespace nepho::forecast
