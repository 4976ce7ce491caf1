#include "live/light_batch.h"

namespace nepho {

Forest forest_of(const LiveTree& tree, std::span<const std::size_t> leaves) {
  Forest forest;
  for (const VolumeTree& volume : tree.forest.volumes) {
    VolumeTree& part = forest.volumes.emplace_back();
    part.source = volume.source;
    part.time_s = volume.time_s;
  }
  for (const std::size_t n : leaves) {
    const LiveTree::Leaf& leaf = tree.leaves[n];
    VolumeTree& part = forest.volumes[leaf.volume];
    TreeNode& node = part.nodes.emplace_back(*leaf.node);
    node.lit = part.lit_nodes++;
    if (!leaf.brick) continue;
    node.brick = std::uint32_t(part.bricks.size());
    part.bricks.push_back(*leaf.brick);
  }
  return forest;
}

}  // namespace nepho
