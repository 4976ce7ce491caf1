#pragma once

#include <vector>

#include "shaders/frame.layout.h"
#include "tree/forest.h"

namespace nepho::gl {

// A grid over the nodes of one level, around all that has extinction in a root, so that a ray need
// not go down from the root for each leaf. Its cells hold the node of that level, the leaf above,
// or a box of cells without extinction: a ray passes it at once, whatever leaves are in it, and all
// that is beyond the grid.

// At most so many cells per node of a tree, and always this many for a root: 4 bytes each. Boxes
// are left out that would take more than the bytes.
inline constexpr std::size_t kGridCellsPerNode = 2, kLeastGridCells = 64, kGridBytesPerNode = 12;

// Appends, for each root of the tree, two records (low x, y, z, first record of its cells; size x,
// y, z, log2 of a cell's sides in finest cells, 5 bits each) and then boxes (frame.layout.h) and
// all cells, four to a record. The tree's nodes begin at `first_node` of `nodes`. Returns the index
// of the first of these records.
int append_grids(std::vector<NodeRecord>& nodes, const VolumeTree& tree, int first_node);

}  // namespace nepho::gl
