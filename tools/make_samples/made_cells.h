#pragma once

#include <string>

#include "made_grid.h"

namespace nepho::samples {

// Grids of cells in a row, as models write them.
MadeGrid made_icon();                                        // triangles with their corners
MadeGrid made_numbers(const std::string& name, bool ugrid);  // corners by number: MPAS or UGRID
MadeGrid made_hexagons();                                    // centres alone

}  // namespace nepho::samples
