#include "bricks/coarsen.h"

namespace nepho {
namespace {

struct Tap {
  std::uint32_t index;
  double weight;
};
struct Taps {
  std::array<Tap, 3> tap;
  int size = 0;
};

// Finer samples under a coarse one on one axis of one root; beyond its ends there are none.
Taps taps(std::uint32_t coarse, bool split, std::uint32_t fine_cells) {
  Taps result;
  const auto push = [&](std::uint32_t index, double weight) {
    result.tap[std::size_t(result.size++)] = {index, weight};
  };
  if (!split) {
    push(coarse, 1.0);
    return result;
  }
  const std::uint32_t middle = 2 * coarse;
  if (middle > 0) push(middle - 1, 0.5);
  push(middle, 1.0);
  if (middle < fine_cells) push(middle + 1, 0.5);
  return result;
}

}  // namespace

ColumnStencil column_stencil(const Chart& chart, const Lattice& lattice, int coarse_level,
                             Column coarse) {
  const SplitMask mask = lattice.split_axes(coarse_level);
  const Index3& fine_cells = lattice.cells(coarse_level + 1);
  ColumnStencil stencil;
  for (const Column& name : chart.names(coarse, lattice.cells(coarse_level))) {
    const Taps x = taps(name.i, splits(mask, 0), fine_cells[0]);
    const Taps y = taps(name.j, splits(mask, 1), fine_cells[1]);
    for (int a = 0; a < x.size; ++a)
      for (int b = 0; b < y.size; ++b) {
        const Tap u = x.tap[std::size_t(a)], v = y.tap[std::size_t(b)];
        const Column fine = {name.root, u.index, v.index};
#ifdef NEPHO_MUTANT_HATS_WITHOUT_VOLUME
        const double area = 1;
#else
        const double area = chart.hat_horizontal(fine, fine_cells);
#endif
        stencil.push_back({chart.names(fine, fine_cells).owner(), u.weight * v.weight * area});
      }
#ifdef NEPHO_MUTANT_HALF_THE_NAMES
    break;
#endif
  }
  return stencil;
}

LayerStencil layer_stencil(const Chart& chart, const Lattice& lattice, int coarse_level,
                           std::uint32_t coarse_k) {
  const Index3& fine_cells = lattice.cells(coarse_level + 1);
  const Taps z = taps(coarse_k, splits(lattice.split_axes(coarse_level), 2), fine_cells[2]);
  LayerStencil stencil;
  for (int c = 0; c < z.size; ++c) {
    const Tap tap = z.tap[std::size_t(c)];
    stencil.push_back({tap.index, tap.weight * chart.hat_vertical(tap.index, fine_cells)});
  }
  return stencil;
}

}  // namespace nepho
