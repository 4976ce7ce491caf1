#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bricks/brick_source.h"

namespace nepho {

// The coarse levels of a source, built bottom-up from its non-empty finest samples by the filter of
// lattice.md 2, and the bounds that go with them. Serves summary() and read(). Memory follows the
// non-empty nodes: 8^3 owned samples in double per stored node, nothing for constant regions.
//
//   finest blocks --filter--> level L-1 blocks --filter--> ... --> level 0
//      |                        |
//      max/min, error, variance per node, level by level
//
// Samples of a block: the 8^3 samples g = 8 (i,j,k) + s, s in 0..7, of which this root is the owner
// (upper ends of a root: the last block holds 9 on that axis).
class SparsePyramid {
 public:
  // What a source knows of a finest-level or coarser region without samples: everything in the
  // closed box grown by one own-level voxel is one value.
  struct Region {
    bool constant = false;
    double value = 0;
  };
  struct Field {
    // Finest-level nodes that may hold something other than a constant, ascending keys.
    std::vector<NodeKey> nodes;
    // The finest samples of one such node: 9^3, x fastest, 1/m, >= 0 and finite. Thread-safe.
    std::function<void(NodeKey, double* samples)> samples;
    // The constant that a node (any level) is, if it is one. Thread-safe. Null: empty elsewhere.
    std::function<Region(NodeKey)> region;
  };

  // Builds in parallel, same bits for any number of threads.
  SparsePyramid(const Chart& chart, const Lattice& lattice, const Field& field);
  ~SparsePyramid();
  SparsePyramid(SparsePyramid&&) noexcept;
  SparsePyramid& operator=(SparsePyramid&&) noexcept;

  NodeSummary summary(NodeKey key) const;
  // 9^3 samples of a node before quantisation, x fastest.
  void samples(NodeKey key, double* samples) const;
  std::uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nepho
