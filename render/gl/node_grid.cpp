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

// Boxes of grid cells without extinction, each as large as it gets by growing from a cell on one
// side after the other. They share no cell: a ray that runs along an edge of both would go from one
// to the other and back.
class EmptyBoxes {
 public:
  EmptyBoxes(const Grid& grid, const std::vector<NodeRecord>& nodes,
             const std::vector<std::uint32_t>& cells)
      : grid_(grid) {
    for (std::size_t c = 0; c < grid.cells(); ++c)
      open_.push_back((nodes[cells[c]].flags & 7u) == NODE_EMPTY);
  }

  // Enters them in the cells that they fill, by their indices after `first`. None where more than
  // `most` are needed: leaves without extinction may reach beyond the grid, and so into other
  // boxes.
  std::vector<NodeRecord> enter(std::vector<std::uint32_t>& cells, std::uint32_t first,
                                std::size_t most) {
    std::vector<NodeRecord> records;
    std::vector<std::uint32_t> entered = cells;
    for (std::size_t c = 0; c < open_.size(); ++c) {
      if (!open_[c]) continue;
      if (records.size() == most) return {};
      const Box box = grown(c);
      each(box, [&](std::size_t cell) {
        entered[cell] = first + std::uint32_t(records.size());
        open_[cell] = false;
        return true;
      });
      records.push_back(record(box));
    }
    cells = entered;
    whole_ = true;
    return records;
  }
  bool whole() const { return whole_; }

 private:
  struct Box {
    Triple low, high;  // grid cells, high excluded
  };
  // Whether `visit` is true for all cells.
  template <class Visit>
  bool each(const Box& box, Visit&& visit) const {
    for (std::int64_t z = box.low[2]; z < box.high[2]; ++z)
      for (std::int64_t y = box.low[1]; y < box.high[1]; ++y)
        for (std::int64_t x = box.low[0]; x < box.high[0]; ++x)
          if (!visit(std::size_t((z * grid_.size[1] + y) * grid_.size[0] + x))) return false;
    return true;
  }
  Box grown(std::size_t cell) const {
    const auto at = std::int64_t(cell);
    Box box;
    box.low = {at % grid_.size[0], at / grid_.size[0] % grid_.size[1],
               at / (grid_.size[0] * grid_.size[1])};
    box.high = {box.low[0] + 1, box.low[1] + 1, box.low[2] + 1};
    for (bool grows = true; grows;) {
      grows = false;
      for (std::size_t side = 0; side < 6; ++side) {
        const std::size_t a = side / 2;
        Box slab = box;
        slab.low[a] = side % 2 ? box.high[a] : box.low[a] - 1;
        slab.high[a] = slab.low[a] + 1;
        if (slab.low[a] < 0 || slab.high[a] > grid_.size[a]) continue;
#if !defined(NEPHO_MUTANT_EMPTY_BOXES)
        if (!each(slab, [&](std::size_t c) { return bool(open_[c]); })) continue;
#endif
        (side % 2 ? box.high[a] : box.low[a]) += side % 2 ? 1 : -1;
        grows = true;
      }
    }
    return box;
  }
  NodeRecord record(const Box& box) const {
    std::array<std::uint32_t, 3> ends{};
    for (std::size_t a = 0; a < 3; ++a)
      ends[a] = std::uint32_t(box.low[a] + 1) | std::uint32_t(box.high[a] + 1) << 16;
    return {ends[0], NODE_EMPTY | EMPTY_BOX, ends[1], ends[2]};
  }

  const Grid& grid_;
  std::vector<bool> open_;
  bool whole_ = false;
};

}  // namespace

int append_grids(std::vector<NodeRecord>& nodes, const VolumeTree& tree, int first_node) {
  const VolumeInfo& info = tree.source->info();
  const int roots = info.chart->roots();
  const int first = int(nodes.size());
  nodes.resize(nodes.size() + 2 * std::size_t(roots), NodeRecord{});
  std::size_t spent = 0;  // bytes
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
    std::uint32_t whole = 0;
    spent += 4 * cells.size();
    if (std::ranges::all_of(grid.size, [](std::int64_t n) { return n < EMPTY_BOX_BEYOND - 1; })) {
      const std::size_t allowed = kGridBytesPerNode * tree.nodes.size();
      const std::size_t most = allowed > spent ? (allowed - spent) / sizeof(NodeRecord) : 0;
      EmptyBoxes empty(grid, nodes, cells);
      const auto boxes = empty.enter(cells, std::uint32_t(nodes.size()), most);
      nodes.insert(nodes.end(), boxes.begin(), boxes.end());
      spent += sizeof(NodeRecord) * boxes.size();
      whole = empty.whole() ? GRID_IS_WHOLE : 0;
    }
    const std::size_t at = std::size_t(first) + 2 * std::size_t(root);
    nodes[at] = {std::uint32_t(grid.low[0]), std::uint32_t(grid.low[1]), std::uint32_t(grid.low[2]),
                 std::uint32_t(nodes.size())};
    nodes[at + 1] = {std::uint32_t(grid.size[0]), std::uint32_t(grid.size[1]),
                     std::uint32_t(grid.size[2]),
                     std::uint32_t(grid.side[0] | grid.side[1] << 5 | grid.side[2] << 10) | whole};
    for (std::size_t c = 0; c < cells.size(); c += 4)
      nodes.push_back({cells[c], cells[c + 1], cells[c + 2], cells[c + 3]});
  }
  return first;
}

}  // namespace nepho::gl
