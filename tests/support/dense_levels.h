#pragma once

#include <limits>
#include <vector>

#include "bricks/coarsen.h"

namespace nepho::test {

// Every sample of one level under every one of its names, so that disagreement can be seen.
class DenseLevel {
 public:
  DenseLevel(const Chart& chart, const Lattice& lattice, int level)
      : cells_(lattice.cells(level)),
        values_(std::size_t(chart.roots()) * (cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1),
                std::numeric_limits<double>::quiet_NaN()) {}

  const Index3& cells() const { return cells_; }
  double operator()(Column c, std::uint32_t k) const { return values_[offset(c, k)]; }
  double& at(Column c, std::uint32_t k) { return values_[offset(c, k)]; }

 private:
  std::size_t offset(Column c, std::uint32_t k) const {
    return ((std::size_t(c.root) * (cells_[2] + 1) + k) * (cells_[1] + 1) + c.j) * (cells_[0] + 1) +
           c.i;
  }
  Index3 cells_;
  std::vector<double> values_;
};

template <class Visit>
void for_each_node(const Chart& chart, const Lattice& lattice, int level, Visit&& visit) {
  const Index3 n = lattice.nodes(level);
  for (int root = 0; root < chart.roots(); ++root)
    for (std::uint32_t i = 0; i < n[0]; ++i)
      for (std::uint32_t j = 0; j < n[1]; ++j)
        for (std::uint32_t k = 0; k < n[2]; ++k) visit(NodeKey(root, level, i, j, k));
}

template <class Visit>
void for_each_sample(const Chart& chart, const Index3& cells, Visit&& visit) {
  for (int root = 0; root < chart.roots(); ++root)
    for (std::uint32_t k = 0; k <= cells[2]; ++k)
      for (std::uint32_t j = 0; j <= cells[1]; ++j)
        for (std::uint32_t i = 0; i <= cells[0]; ++i) visit(Column{root, i, j}, k);
}

template <class Visit>
void for_each_brick_sample(NodeKey key, Visit&& visit) {
  for (std::uint32_t k = 0; k < kBrickSamples; ++k)
    for (std::uint32_t j = 0; j < kBrickSamples; ++j)
      for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
        const Index3 g = Lattice::global_sample(key, {i, j, k});
        visit(brick_offset(i, j, k), Column{key.root(), g[0], g[1]}, g[2]);
      }
}

inline BrickSamples brick_of(const DenseLevel& level, NodeKey key) {
  BrickSamples brick;
  for_each_brick_sample(
      key, [&](std::size_t at, Column c, std::uint32_t k) { brick[at] = level(c, k); });
  return brick;
}

// Levels 0..max of a field given at the finest, and how often two nodes, or two names of a sample,
// disagreed on a shared sample. `Reduce` is weighted_mean, stencil_max or a mutant of them.
struct Pyramid {
  std::vector<DenseLevel> levels;
  std::size_t seams = 0;
};

template <class Field, class Reduce>
Pyramid build_pyramid(const Chart& chart, const Lattice& lattice, Field&& field, Reduce&& reduce) {
  Pyramid pyramid;
  for (int level = 0; level <= lattice.max_level(); ++level)
    pyramid.levels.emplace_back(chart, lattice, level);
  for_each_sample(chart, pyramid.levels.back().cells(), [&](Column c, std::uint32_t k) {
    pyramid.levels.back().at(c, k) =
        field(sample_ecef_m(chart, lattice, c.root, lattice.max_level(), {c.i, c.j, k}));
  });
  for (int level = lattice.max_level() - 1; level >= 0; --level) {
    const DenseLevel& fine = pyramid.levels[std::size_t(level) + 1];
    DenseLevel& coarse = pyramid.levels[std::size_t(level)];
    for_each_node(chart, lattice, level, [&](NodeKey key) {
      BrickSamples brick;
      for_each_stencil(
          chart, lattice, key,
          [&](std::size_t at, const ColumnStencil& columns, const LayerStencil& layers) {
            brick[at] = reduce(columns, layers, fine);
          });
      for_each_brick_sample(key, [&](std::size_t at, Column c, std::uint32_t k) {
        double& known = coarse.at(c, k);
        pyramid.seams += !std::isnan(known) && known != brick[at];
        known = brick[at];
      });
    });
  }
  for (const DenseLevel& level : pyramid.levels)
    for_each_sample(chart, level.cells(), [&](Column c, std::uint32_t k) {
      pyramid.seams += level(c, k) != level(chart.names(c, level.cells()).owner(), k);
    });
  return pyramid;
}

// Sum of c V; a sample with several names brings one piece of its hat under each.
inline double total(const Chart& chart, const DenseLevel& level) {
  const Index3& n = level.cells();
  double sum = 0;
  for (int root = 0; root < chart.roots(); ++root)
    for (std::uint32_t j = 0; j <= n[1]; ++j)
      for (std::uint32_t i = 0; i <= n[0]; ++i) {
        const double area = chart.hat_horizontal({root, i, j}, n);
        for (std::uint32_t k = 0; k <= n[2]; ++k)
          sum += level({root, i, j}, k) * area * chart.hat_vertical(k, n);
      }
  return sum;
}

}  // namespace nepho::test
