#include "gl/light_samples.h"

#include <algorithm>
#include <array>

namespace nepho::gl {
namespace {

constexpr int kSide = 9, kSamples = 729;
using Mask = std::bitset<kSamples>;

int index_of(int x, int y, int z) {
  return (z * kSide + y) * kSide + x;
}

// Each sample and its neighbours, edges and corners included.
Mask grown(const Mask& mask) {
  Mask result = mask;
  for (int stride : {1, kSide, kSide * kSide}) {
    const Mask before = result;
    for (int s = 0; s < kSamples; ++s) {
      if (!before[std::size_t(s)]) continue;
      const int at = s / stride % kSide;
      if (at > 0) result.set(std::size_t(s - stride));
      if (at < kSide - 1) result.set(std::size_t(s + stride));
    }
  }
  return result;
}

Mask needed_of(const LeafBrick& brick) {
  Mask mask;
  for (std::size_t s = 0; s < kSamples; ++s) mask[s] = brick.codes[s] > 0 || brick.offset > 0;
  mask = grown(mask);
  // Nothing to take light from: it must be finite all the same.
  return mask.none() ? mask.set() : mask;
}

// Of each sample the nearest of the mask, by faces.
std::array<int, kSamples> nearest(const Mask& mask) {
  std::array<int, kSamples> from;
  from.fill(-1);
  std::vector<int> queue;
  queue.reserve(kSamples);
  for (int s = 0; s < kSamples; ++s)
    if (mask[std::size_t(s)]) {
      from[std::size_t(s)] = s;
      queue.push_back(s);
    }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const int s = queue[next];
    for (int stride : {1, kSide, kSide * kSide})
      for (int sign : {-1, 1}) {
        const int at = s / stride % kSide + sign;
        if (at < 0 || at >= kSide || from[std::size_t(s + sign * stride)] >= 0) continue;
        from[std::size_t(s + sign * stride)] = from[std::size_t(s)];
        queue.push_back(s + sign * stride);
      }
  }
  return from;
}

}  // namespace

LightSamples::LightSamples(const Forest& forest) {
  std::size_t first = 0;
  for (const VolumeTree& tree : forest.volumes) {
    needed_.resize(first + tree.lit_nodes, Mask().set());
    for (const TreeNode& node : tree.nodes)
      if (node.seen && node.kind == NodeKind::kBrick)
        needed_[first + node.lit] = needed_of(tree.bricks[node.brick]);
    first += tree.lit_nodes;
  }
}

std::vector<std::uint32_t> LightSamples::needed(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> list;
  for (std::size_t tile = first; tile < first + count; ++tile)
    for (std::size_t s = 0; s < kSamples; ++s)
      if (needed_[tile][s]) list.push_back(std::uint32_t(kSamples * tile + s));
  return list;
}

std::vector<std::uint32_t> LightSamples::coarse(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> list;
  for (std::size_t tile = first; tile < first + count; ++tile) {
    const Mask beside = grown(needed_[tile]);
    for (int z = 0; z < kSide; z += 2)
      for (int y = 0; y < kSide; y += 2)
        for (int x = 0; x < kSide; x += 2)
          if (beside[std::size_t(index_of(x, y, z))])
            list.push_back(std::uint32_t(kSamples * tile) + std::uint32_t(index_of(x, y, z)));
  }
  return list;
}

std::vector<std::uint32_t> LightSamples::pairs(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> list;
  for (std::size_t tile = first; tile < first + count; ++tile) {
    if (needed_[tile].all()) continue;
    const std::array<int, kSamples> from = nearest(needed_[tile]);
    for (std::size_t s = 0; s < kSamples; ++s) {
      if (needed_[tile][s]) continue;
      list.push_back(std::uint32_t(kSamples * tile + s));
      list.push_back(std::uint32_t(kSamples * tile) + std::uint32_t(from[s]));
    }
  }
  return list;
}

}  // namespace nepho::gl
