#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// Grids of cells in a row, along one dimension: triangles of ICON (clat, clon and their bounds),
// Voronoi cells of MPAS (latCell, verticesOnCell, latVertex), faces of UGRID (mesh_topology), any
// CF bounds of latitude and longitude. Taken from `grid_file` where there is one, else from the
// data's own. Centres without corners get cells that end half way to their neighbours (Voronoi's),
// and at the rim of an area about as far out as the neighbours are: said in `assumptions`; what was
// found in `how`. Throws Error where there are no centres, with the cure.
std::unique_ptr<HorizontalGrid> unstructured_grid(const DataFile& file, const DataFile* grid_file,
                                                  const FileVariable& water, int dimension,
                                                  std::vector<std::string>& assumptions,
                                                  std::string& how);

// The same of cells [first, first + inside.size()): what a region leaves of it. Those that are not
// inside have no corners.
std::unique_ptr<HorizontalGrid> some_polygons(const HorizontalGrid& grid, int first,
                                              const std::vector<char>& inside);

}  // namespace nepho::forecast
