#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "reference/chart_rays.h"
#include "tree/forest.h"

namespace nepho {

// One volume's leaves as a path tracer asks for them: which leaf holds a cell, how much extinction
// there is at most, and how much there is at a place. Exact: the same samples and the same
// trilinear cells as the picture's, and a bound that is that of the brick's own samples.
class Leaves {
 public:
  using Sizes = std::array<int, 3>;
  struct Level {
    SplitMask mask = 0;
    Sizes cell_bits{};  // log2 of finest cells in one of this level's, by axis
    glm::dvec3 cells_per_finest{1.0};
  };

  struct Leaf {
    NodeKind kind = NodeKind::kEmpty;  // never kInner
    double most_per_m = 0;             // no extinction in it is greater
    const LeafBrick* brick = nullptr;
    const Level* level = nullptr;

    // Walls in finest cells of the leaf that holds `cell`, which may be of another period.
    ChartRay::Block block(const ChartRay::Cell& cell) const {
      ChartRay::Block block;
      for (std::size_t a = 0; a < 3; ++a) {
        const int bits = level->cell_bits[a] + 3;
        block.low[a] = cell[a] >> bits << bits;
        block.high[a] = block.low[a] + (std::int64_t(1) << bits);
      }
      return block;
    }
    // Inside of it, at a place in finest cells.
    double extinction_per_m(const ChartRay::Block& block, const glm::dvec3& at) const;
    // Part of that which is ice, 0 .. 1.
    double ice_part(const ChartRay::Block& block, const glm::dvec3& at) const;
  };

  // `tree` outlives this. Costs kNodeBytes a node besides it.
  static constexpr std::size_t kNodeBytes = 20;
  explicit Leaves(const VolumeTree& tree);
  Leaves(const Leaves&) = delete;
  Leaf leaf(int root, const Index3& finest_cell) const;
  const VolumeInfo& info() const { return tree_.source->info(); }

 private:
  struct Node {
    std::uint32_t first_child = 0;  // of an inner node
    std::uint32_t brick = 0;
    float most_per_m = 0;
    std::uint8_t level = 0;
    NodeKind kind = NodeKind::kEmpty;
  };
  const Node& child(const Node& parent, int level, const Index3& finest_cell) const;
  void make_entries(const Lattice& lattice, int roots);

  const VolumeTree& tree_;
  std::vector<Node> nodes_;
  std::vector<Level> levels_;
  // Short cuts for the way down: the nodes of one level (or the leaves above it) as a grid.
  Sizes entry_bits_{};  // log2 of finest cells
  Index3 entry_count_{};
  std::vector<std::uint32_t> entries_;
};

// Follows a ray from leaf to leaf. visit(t0_m, t1_m, root, block, leaf) returns whether to go on.
template <class Kind, class Visit>
void follow(const Leaves& leaves, const Kind& ray, double t_max_m, Visit&& visit) {
  const ChartRay::Start start = ray.start(t_max_m);
  if (!(start.end_m > start.t_m)) return;
  const Lattice& lattice = leaves.info().lattice;
  const Index3& cells = lattice.cells(lattice.max_level());
  int root = start.root;
  ChartRay::Cell cell = start.cell;
  double t_m = start.t_m;
  while (true) {
    const Leaves::Leaf leaf = leaves.leaf(root, ray.wrapped(cell));
    const ChartRay::Block block = leaf.block(cell);
    const ChartRay::Exit exit = ray.exit(root, block, t_m);
    const double end_m = std::min(exit.t_m, start.end_m);
    if (!visit(t_m, end_m, root, block, leaf)) return;
    if (!(exit.t_m < start.end_m)) return;
    t_m = exit.t_m;
    const glm::dvec3 at = ray.cells_at(root, t_m);
    for (int a = 0; a < 3; ++a) {
      const auto i = std::size_t(a);
      cell[i] = a == exit.axis ? (exit.side > 0 ? block.high[i] : block.low[i] - 1)
                               : std::int64_t(std::clamp(std::floor(at[a]), double(block.low[i]),
                                                         double(block.high[i] - 1)));
    }
    const auto axis = std::size_t(exit.axis);
    if (cell[axis] < 0 || cell[axis] >= std::int64_t(cells[axis]))
      if (!ray.cross_end(exit, t_m, root, cell) || t_m >= start.end_m) return;
  }
}

}  // namespace nepho
