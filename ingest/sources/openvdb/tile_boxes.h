#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bricks/brick_source.h"
#include "bricks/coarsen.h"

namespace nepho::vdb {

// Large active tiles of a VDB, as boxes of one value on the finest lattice, and the coarse levels
// of that part of the field in closed form: nothing is stored per voxel or per node, so one tile of
// 4096^3 costs as much as one of 128^3.
//
// The filter of lattice.md 2, taken m times, is the hat of 2^m finest cells: its weights are
// integers over a power of two, and their sum over a run of samples is a difference of two
// triangle numbers. A box's share of a coarse sample is the product of three such sums: exact.
struct TileBox {
  std::array<std::int64_t, 3> low, high;  // finest samples, both ends included
  double value;                           // 1/m, > 0
};

class TileBoxes {
 public:
  // Boxes do not overlap. Equal neighbours become one box.
  TileBoxes(const Lattice& lattice, std::vector<TileBox> boxes);

  bool touches(NodeKey key) const;  // this level's samples, or any below, are not all zero
  // All finest samples of the node grown by one of its own voxels lie in one box.
  const TileBox* covering(NodeKey key) const;
  // Adds this part of the field to the node's 9^3 samples.
  void add_samples(NodeKey key, double* samples) const { add(key, samples, false); }
  double value(const std::array<std::int64_t, 3>& finest_sample) const;
  // `rest` describes the field without these boxes; `rest_samples` are its samples of the node.
  // The two parts never share a finest voxel.
  NodeSummary summary(NodeKey key, const NodeSummary& rest, const double* rest_samples) const;
  std::size_t size() const { return boxes_.size(); }

 private:
  std::int64_t step(int level) const { return std::int64_t{1} << (lattice_.max_level() - level); }
  void add(NodeKey key, double* samples, bool squared) const;
  double bound(NodeKey key, double rest) const;

  Lattice lattice_;
  std::vector<TileBox> boxes_;
};

}  // namespace nepho::vdb
