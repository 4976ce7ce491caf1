#include <algorithm>
#include <stdexcept>
#include <string>

#include "pyramid/sparse_pyramid.h"

namespace nepho {

std::vector<NodeKey> collect_nodes(const Chart& chart, const Lattice& lattice,
                                   const std::function<SparsePyramid::Region(NodeKey)>& region,
                                   std::size_t most) {
  std::vector<NodeKey> nodes;
  for (int root = 0; root < chart.roots(); ++root) nodes.emplace_back(root, 0, 0, 0, 0);
  for (int level = 0;; ++level) {
    std::erase_if(nodes, [&](NodeKey key) { return region(key).closed_form(); });
    if (nodes.size() > most)
      throw std::length_error("more than " + std::to_string(most) + " nodes at level " +
                              std::to_string(level) + ": choose a smaller max_level");
    if (level == lattice.max_level()) break;
    std::vector<NodeKey> finer;
    for (const NodeKey key : nodes)
      for (const NodeKey child : lattice.children(key)) finer.push_back(child);
    nodes = std::move(finer);
  }
  std::ranges::sort(nodes);
  return nodes;
}

}  // namespace nepho
