#pragma once

#include <string>

#include "sources/grib/grid.h"

namespace nepho::grib {

// Grids that CF tells by a grid_mapping: axes in the order of the scan, and the mapping's numbers.
// Throw Error on numbers that make no map.
void lambert(const Message& message, Grid& grid);
void mercator(const Message& message, Grid& grid);
void polar_stereographic(const Message& message, Grid& grid);
// From a geostationary satellite: angles of view times its height.
void space_view(const Message& message, Grid& grid);
// Longitudes and latitudes found so far are those of a rotated pole.
void rotate(const Message& message, Grid& grid);

[[noreturn]] void refuse_grid(const Message& message, const std::string& found);
std::string short_number(double value);  // "33.75", for messages

}  // namespace nepho::grib
