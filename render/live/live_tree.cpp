#include "live/live_tree.h"

#include "gl/switches.h"
#include "tree/view_metric.h"

namespace nepho {
namespace {

void list_leaves(LiveTree& tree) {
  const ViewMetric metric(tree.request->camera, tree.request->settings, std::nullopt);
  std::size_t count = 0;
  for (const VolumeTree& volume : tree.forest.volumes) count += volume.lit_nodes;
  tree.leaves.resize(count);
  std::size_t first = 0;
  for (std::uint32_t v = 0; v < tree.forest.volumes.size(); ++v) {
    const VolumeTree& volume = tree.forest.volumes[v];
    for (const TreeNode& node : volume.nodes) {
      const bool brick = node.kind == NodeKind::kBrick;
      if (!brick && node.kind != NodeKind::kConstant) continue;
      tree.leaves[first + node.lit] = {&node,
                                       brick ? &volume.bricks[node.brick] : nullptr,
                                       v,
                                       {volume.source, volume.time_s, node.key},
                                       metric.seen(volume.source->info(), node.key)};
    }
    first += volume.lit_nodes;
  }
}

}  // namespace

std::uint64_t LiveTree::host_bytes() const {
  std::uint64_t bytes = leaves.size() * sizeof(Leaf) + scene.nodes.size() * sizeof(NodeRecord) +
                        (scene.bricks.size() + scene.ice.size()) * sizeof(BrickRecord) +
                        scene.lit.size() * sizeof(LitRecord) + 4 * scene.phases.size();
  for (const VolumeTree& volume : forest.volumes) {
    bytes += volume.nodes.size() * sizeof(TreeNode) + volume.bricks.size() * sizeof(LeafBrick);
    for (const LeafBrick& brick : volume.bricks) bytes += brick.ice ? sizeof(IceCodes) : 0;
  }
  return bytes;
}

std::unique_ptr<LiveTree> make_live_tree(std::shared_ptr<const RenderRequest> request,
                                         const Refinement& refinement,
                                         std::shared_ptr<const AirTables> tables) {
  auto tree = std::make_unique<LiveTree>();
  tree->request = std::move(request);
  const RenderRequest& asked = *tree->request;
  tree->forest = build_forest(asked.volumes, refinement);
  tree->scene = gl::make_gpu_scene(asked, tree->forest);
  tree->scene.frame.least_transmittance = gl::least_transmittance(asked.settings);
  if (asked.planet)
    tree->planet = std::make_unique<gl::PlanetPasses>(asked, tree->forest, std::move(tables));
  list_leaves(*tree);
  return tree;
}

}  // namespace nepho
