#include "gl/node_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace nepho::gl {
namespace {

using Triple = std::array<std::int64_t, 3>;

// log2 of a node's sides in finest cells.
std::array<int, 3> sides(const Lattice& lattice, int level) {
  std::array<int, 3> result{};
  for (std::size_t a = 0; a < 3; ++a)
    result[a] = std::countr_zero(lattice.cells(lattice.max_level())[a] / lattice.cells(level)[a] *
                                 kBrickCells);
  return result;
}

Triple low_of(const Lattice& lattice, NodeKey key) {
  const std::array<int, 3> side = sides(lattice, key.level());
  return {std::int64_t(key.i()) << side[0], std::int64_t(key.j()) << side[1],
          std::int64_t(key.k()) << side[2]};
}

struct Grid {
  std::array<int, 3> side{};
  Triple low{}, size{};
  std::size_t cells() const { return std::size_t(size[0] * size[1] * size[2]); }
};

// The finest grid around all leaves with extinction that is not too large; size 0 where there are
// none.
Grid choose(const VolumeTree& tree, int root) {
  const Lattice& lattice = tree.source->info().lattice;
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  Triple low = {kFar, kFar, kFar}, high = {0, 0, 0};
  for (const TreeNode& node : tree.nodes) {
    if (node.key.root() != root) continue;
    if (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant) continue;
    const Triple at = low_of(lattice, node.key);
    const std::array<int, 3> side = sides(lattice, node.key.level());
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], at[a]);
      high[a] = std::max(high[a], at[a] + (std::int64_t(1) << side[a]));
    }
  }
  Grid grid;
  if (high[0] == 0) return grid;
  const std::size_t most = std::max(kLeastGridCells, kGridCellsPerNode * tree.nodes.size());
  for (int level = tree.finest_level_used; level >= 0; --level) {
    grid.side = sides(lattice, level);
    for (std::size_t a = 0; a < 3; ++a) {
      grid.low[a] = low[a] >> grid.side[a];
      grid.size[a] = ((high[a] - 1) >> grid.side[a]) - grid.low[a] + 1;
    }
    if (grid.cells() <= most) return grid;
  }
  return grid;  // of the root alone
}

// Enters a node in all cells that it fills.
void fill(const Grid& grid, const Triple& low, const std::array<int, 3>& side, std::uint32_t node,
          std::vector<std::uint32_t>& cells) {
  Triple begin, end;
  for (std::size_t a = 0; a < 3; ++a) {
    begin[a] = std::max<std::int64_t>((low[a] >> grid.side[a]) - grid.low[a], 0);
    end[a] =
        std::min(((low[a] + (std::int64_t(1) << side[a]) - 1) >> grid.side[a]) - grid.low[a] + 1,
                 grid.size[a]);
  }
  for (std::int64_t z = begin[2]; z < end[2]; ++z)
    for (std::int64_t y = begin[1]; y < end[1]; ++y)
      for (std::int64_t x = begin[0]; x < end[0]; ++x)
        cells[std::size_t((z * grid.size[1] + y) * grid.size[0] + x)] = node;
}

}  // namespace

int append_grids(std::vector<NodeRecord>& nodes, const VolumeTree& tree, int first_node) {
  const VolumeInfo& info = tree.source->info();
  const int roots = info.chart->roots();
  const int first = int(nodes.size());
  nodes.resize(nodes.size() + 2 * std::size_t(roots), NodeRecord{});
  for (int root = 0; root < roots; ++root) {
    const Grid grid = choose(tree, root);
    std::vector<std::uint32_t> cells((grid.cells() + 3) / 4 * 4, 0);
    // Parents come before their children, so that what is finer is entered last; what is finer than
    // the grid is left out.
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
      const TreeNode& node = tree.nodes[n];
      const std::array<int, 3> side = sides(info.lattice, node.key.level());
      if (node.key.root() == root && side[0] >= grid.side[0] && side[1] >= grid.side[1] &&
          side[2] >= grid.side[2])
        fill(grid, low_of(info.lattice, node.key), side,
             std::uint32_t(first_node) + std::uint32_t(n), cells);
    }
    const std::size_t at = std::size_t(first) + 2 * std::size_t(root);
    nodes[at] = {std::uint32_t(grid.low[0]), std::uint32_t(grid.low[1]), std::uint32_t(grid.low[2]),
                 std::bit_cast<float>(std::uint32_t(nodes.size()))};
    nodes[at + 1] = {
        std::uint32_t(grid.size[0]), std::uint32_t(grid.size[1]), std::uint32_t(grid.size[2]),
        std::bit_cast<float>(std::uint32_t(grid.side[0] | grid.side[1] << 5 | grid.side[2] << 10))};
    for (std::size_t c = 0; c < cells.size(); c += 4)
      nodes.push_back({cells[c], cells[c + 1], cells[c + 2], std::bit_cast<float>(cells[c + 3])});
  }
  return first;
}

}  // namespace nepho::gl
