#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bricks/chart.h"
#include "bricks/lattice.h"

namespace nepho {

// Two-scale relation of the hats: a coarse hat is the sum of the finer hats around it, 1 at the
// middle and 1/2 at each side of a split axis. Weights here carry the finer hats' volumes, so
//   c_coarse = sum weight * c_fine / sum weight
// conserves sum c V, on curved charts and at ends as well. A sample with several names (cube edge,
// periodic end) gathers from each name's root in turn: its hat is the union of those pieces, and
// the order of names makes every root that asks get the same bits.
struct WeightedColumn {
  Column column;  // owner name, at the finer level
  double weight;
};
struct WeightedLayer {
  std::uint32_t k;
  double weight;
};
using ColumnStencil = std::vector<WeightedColumn>;
using LayerStencil = std::vector<WeightedLayer>;

ColumnStencil column_stencil(const Chart& chart, const Lattice& lattice, int coarse_level,
                             Column coarse);
LayerStencil layer_stencil(const Chart& chart, const Lattice& lattice, int coarse_level,
                           std::uint32_t coarse_k);

// `fine` is called as fine(Column, k) -> double.
template <class Fine>
double weighted_mean(const ColumnStencil& columns, const LayerStencil& layers, Fine&& fine) {
  double sum = 0, total = 0;
  for (const auto& [column, column_weight] : columns)
    for (const auto& [k, layer_weight] : layers) {
      sum += column_weight * layer_weight * fine(column, k);
      total += column_weight * layer_weight;
    }
#ifdef NEPHO_MUTANT_LEVEL_DRIFT
  return 1.02 * (sum / total);
#else
  return sum / total;
#endif
}

// Same stencil, greatest value. Repeated from the finest level to a node's, it bounds the node's
// samples and all its descendants': the source's maximum grown by one voxel of the node's level.
template <class Fine>
double stencil_max(const ColumnStencil& columns, const LayerStencil& layers, Fine&& fine) {
  double most = 0;
  for (const auto& [column, column_weight] : columns)
    for (const auto& [k, layer_weight] : layers) most = std::max(most, double(fine(column, k)));
  return most;
}

using BrickSamples = std::array<double, kBrickVolume>;

constexpr std::size_t brick_offset(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  return i + kBrickSamples * (j + std::size_t(kBrickSamples) * k);
}

// Calls visit(offset in brick, columns, layers) for the samples of a node that has a finer level.
template <class Visit>
void for_each_stencil(const Chart& chart, const Lattice& lattice, NodeKey key, Visit&& visit) {
  const Index3 first = Lattice::global_sample(key, {0, 0, 0});
  std::array<LayerStencil, kBrickSamples> layers;
  for (std::uint32_t k = 0; k < kBrickSamples; ++k)
    layers[k] = layer_stencil(chart, lattice, key.level(), first[2] + k);
  for (std::uint32_t j = 0; j < kBrickSamples; ++j)
    for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
      const ColumnStencil columns =
          column_stencil(chart, lattice, key.level(), {key.root(), first[0] + i, first[1] + j});
      for (std::uint32_t k = 0; k < kBrickSamples; ++k)
        visit(brick_offset(i, j, k), columns, layers[k]);
    }
}

template <class Fine>
BrickSamples coarsen_node(const Chart& chart, const Lattice& lattice, NodeKey key, Fine&& fine) {
  BrickSamples brick;
  for_each_stencil(chart, lattice, key,
                   [&](std::size_t at, const ColumnStencil& columns, const LayerStencil& layers) {
                     brick[at] = weighted_mean(columns, layers, fine);
                   });
  return brick;
}

}  // namespace nepho
