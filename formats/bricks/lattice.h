#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <stdexcept>
#include <vector>

#include "bricks/node_key.h"

namespace nepho {

inline constexpr int kBrickCells = 8;
inline constexpr int kBrickSamples = kBrickCells + 1;
inline constexpr int kBrickVolume = kBrickSamples * kBrickSamples * kBrickSamples;

using Index3 = std::array<std::uint32_t, 3>;

// The index space of one volume: how many cells each level has, and which node holds which.
// Knows nothing of the world; a Chart maps q to it.
class Lattice {
 public:
  // split_axes[l] is what a node of level l halves; levels run from 0 to split_axes.size().
  explicit Lattice(std::vector<SplitMask> split_axes) : split_axes_(std::move(split_axes)) {
    counts_.push_back({kBrickCells, kBrickCells, kBrickCells});
    for (const SplitMask mask : split_axes_) {
      if (mask == 0 || mask > kSplitXyz) throw std::invalid_argument("Lattice: bad split mask");
      Index3 next = counts_.back();
      for (int axis = 0; axis < 3; ++axis) {
        next[axis] <<= splits(mask, axis);
        const int most = axis == 2 ? NodeKey::kMaxSplitsZ : NodeKey::kMaxSplitsXy;
        if (next[axis] > std::uint32_t(kBrickCells) << most)
          throw std::invalid_argument("Lattice: more splits than a NodeKey can name");
      }
      counts_.push_back(next);
    }
    if (max_level() >> NodeKey::kLevelBits)
      throw std::invalid_argument("Lattice: more levels than a NodeKey can name");
  }

  int max_level() const { return int(split_axes_.size()); }
  SplitMask split_axes(int level) const { return split_axes_.at(std::size_t(level)); }
  const Index3& cells(int level) const { return counts_.at(std::size_t(level)); }
  Index3 nodes(int level) const {
    const Index3& n = cells(level);
    return {n[0] / kBrickCells, n[1] / kBrickCells, n[2] / kBrickCells};
  }

  NodeKey parent(NodeKey key) const { return key.parent(split_axes(key.level() - 1)); }
  std::vector<NodeKey> children(NodeKey key) const {
    const SplitMask mask = split_axes(key.level());
    std::vector<NodeKey> result;
    for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
      if ((octant & ~mask) == 0) result.push_back(key.child(mask, octant));
    return result;
  }

  // Global index of sample `s` (0..8 on each axis) of a node's brick.
  static Index3 global_sample(NodeKey key, Index3 s) {
    return {kBrickCells * key.i() + s[0], kBrickCells * key.j() + s[1],
            kBrickCells * key.k() + s[2]};
  }
  // Exact: the index and the power of two both fit a double, and their quotient too.
  glm::dvec3 q(int level, Index3 global) const {
    const Index3& n = cells(level);
    return {double(global[0]) / n[0], double(global[1]) / n[1], double(global[2]) / n[2]};
  }
  // A position on a wall belongs to the upper node, except at the upper end of the root; one
  // outside, to the nearest node; NaN, to the first (fmax drops it: no undefined conversion).
  NodeKey node_at(int root, glm::dvec3 q, int level) const {
    const Index3 count = nodes(level);
    const auto index = [](double position, std::uint32_t n) {
      return std::uint32_t(std::fmin(std::fmax(std::floor(position * n), 0.0), n - 1.0));
    };
    return {root, level, index(q.x, count[0]), index(q.y, count[1]), index(q.z, count[2])};
  }

 private:
  std::vector<SplitMask> split_axes_;
  std::vector<Index3> counts_;
};

}  // namespace nepho
