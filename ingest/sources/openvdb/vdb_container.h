#pragma once

#include <string>

namespace nepho::vdb {

// Looks at the outer frame of a .vdb file before OpenVDB does, which reads past the end of a
// truncated file without a word and allocates what a string's length claims:
//
//   magic 8 | version 4 | library 8 | has offsets 1 | (220, 221: compressed 1) | uuid 36
//   metadata: count 4, each: name, type, value (length 4 + bytes)
//   grids: count 4, each: name, type, parent (length 4 + bytes), grid, block, end (8 each)
//
//     at grid: (from 222: compression 4) metadata as above | transform type (length 4 + bytes)
//
// Throws Error: missing, a directory, empty, not a VDB, NanoVDB, older than OpenVDB 1 or newer than
// this library, a stream without offsets, truncated, offsets out of order.
void check_container(const std::string& file);

}  // namespace nepho::vdb
