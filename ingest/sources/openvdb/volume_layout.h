#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bricks/volume_info.h"
#include "options.h"
#include "sequence.h"
#include "vdb_grid.h"

namespace nepho::vdb {

// One volume over all frames of a sequence: its lattice is the files' own index lattice, shifted by
// whole leaves, and its root the smallest power-of-two cube that holds every frame's active box and
// one voxel around it. Metadata boxes are never looked at.
struct VolumeLayout {
  Sequence sequence;
  std::vector<VdbHeader> headers;  // one per file of the sequence
  std::string grid;                // the same in all frames; empty where no file has a grid
  std::size_t first_file = 0;      // the first with voxels (0 where none has)
  IndexBox active;                 // of all frames
  std::array<std::int64_t, 3> origin{0, 0, 0};  // index of the lattice's sample (0, 0, 0)
  std::int64_t cover = 8;                       // cells on each axis at the finest level
  Lattice lattice{{}};
  std::shared_ptr<const Chart> chart;
  DataBounds bounds;
  glm::dmat3 voxel_m{1.0};  // columns: one index step, local x east, z up
  std::vector<std::string> assumptions, facts;

  bool has_voxels() const { return !active.empty(); }
  // The index-space corner of a finest node.
  Coord3 corner(NodeKey key) const;
};

// Throws Error: what find_sequence and read_header refuse; transforms that differ between frames by
// more than 1e-6; a lattice above 8 * 2^16 voxels.
VolumeLayout lay_out(const Options& options, const Placement& placement);

}  // namespace nepho::vdb
