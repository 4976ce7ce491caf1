#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bricks/brick_source.h"

namespace nepho {

// The coarse levels of a source, built bottom-up from its non-constant finest samples by the filter
// of lattice.md 2, and the bounds that go with them. Serves summary() and samples().
//
//   finest samples --filter--> level L-1 bricks --filter--> ... --> level 0
//   (asked for again           (stored: 9^3 doubles per node that is not a closed form,
//    on demand, not stored)     5.8 kB; faces hold the same bits in all nodes that share them)
//
// Memory follows the nodes in which something varies. Everything else is a closed form that the
// source names: a constant, or one block of a constant in another (a VDB tile in the background).
// Cost of building: two calls of Field::samples per finest node and about 30 ns per sample more.
class SparsePyramid {
 public:
  // What a source knows of a node without samples, over its closed box grown by one voxel of the
  // node's own level. Constant: one value. Block (open BoxChart only; elsewhere not offered):
  // `value` at finest samples low..high (both included, may reach beyond the grown box), `outside`
  // elsewhere in it. Neither: "something varies", always allowed but then the node costs memory.
  struct Region {
    bool constant = false;
    double value = 0;
    bool block = false;
    double outside = 0;
    Index3 low{}, high{};
    bool closed_form() const { return constant || block; }
  };
  struct Field {
    // Without `region`: all finest-level nodes whose closed 9^3 samples are not all zero, ascending
    // keys. With it: left empty, the pyramid finds them from the roots down.
    std::vector<NodeKey> nodes;
    // The finest samples of one such node: 9^3, x fastest, 1/m, >= 0 and finite. Thread-safe; kept
    // and called for every read of a finest node.
    std::function<void(NodeKey, double* samples)> samples;
    // Any node, thread-safe, kept. Null: nodes not listed are zero.
    std::function<Region(NodeKey)> region;
    // Throws std::length_error where `region` leaves more than this on one level.
    std::size_t most_nodes = std::size_t(-1);
  };

  // Builds in parallel, same bits for any number of threads. Keeps a reference to `chart`.
  SparsePyramid(const Chart& chart, const Lattice& lattice, Field field);
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

// Nodes that no closed form covers, by level, ascending, found from the roots down: cost follows
// the nodes in which something varies. Throws std::length_error above `most` nodes on a level.
std::vector<std::vector<NodeKey>> collect_nodes(
    const Chart& chart, const Lattice& lattice,
    const std::function<SparsePyramid::Region(NodeKey)>& region,
    std::size_t most = std::size_t(-1));

}  // namespace nepho
