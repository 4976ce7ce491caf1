#include <algorithm>
#include <stdexcept>
#include <string>

#include "pyramid/sparse_pyramid.h"

namespace nepho {

std::vector<std::vector<NodeKey>> collect_nodes(
    const Chart& chart, const Lattice& lattice,
    const std::function<SparsePyramid::Region(NodeKey)>& region, std::size_t most) {
  std::vector<std::vector<NodeKey>> levels(std::size_t(lattice.max_level()) + 1);
  for (int root = 0; root < chart.roots(); ++root) levels[0].emplace_back(root, 0, 0, 0, 0);
  for (int level = 0;; ++level) {
    std::vector<NodeKey>& nodes = levels[std::size_t(level)];
    std::erase_if(nodes, [&](NodeKey key) { return region(key).closed_form(); });
    if (nodes.size() > most)
      throw std::length_error("more than " + std::to_string(most) + " nodes at level " +
                              std::to_string(level) + ": choose a smaller max_level");
    std::ranges::sort(nodes);
    if (level == lattice.max_level()) return levels;
    for (const NodeKey key : nodes)
      for (const NodeKey child : lattice.children(key))
        levels[std::size_t(level) + 1].push_back(child);
  }
}

}  // namespace nepho
