#include "live/resident_tree.h"

#include <algorithm>

#include "gl/switches.h"

namespace nepho {

std::unique_ptr<ResidentTree> ResidentTree::make(std::unique_ptr<LiveTree> tree, Slots& slots,
                                                 const ResidentTree* last) {
  std::unique_ptr<ResidentTree> made(new ResidentTree(std::move(tree), slots));
  for (const LiveTree::Leaf& leaf : made->tree_->leaves) {
    const auto slot = slots.take(leaf.key);
    if (!slot) return nullptr;
    made->held_.push_back(*slot);
  }
  made->upload(last);
  return made;
}

ResidentTree::~ResidentTree() {
  for (const std::uint32_t slot : held_) slots_.release(slot);
}

void ResidentTree::upload(const ResidentTree* last) {
  const gl::GpuScene& scene = tree_->scene;
  std::vector<NodeRecord> nodes = scene.nodes;
  std::uint32_t most = 0;
  for (const std::uint32_t slot : held_) most = std::max(most, slot + 1);
  std::vector<BrickRecord> bricks(most), ice(scene.has_ice ? most : 0);
  std::vector<LitRecord> lit(most);
  std::size_t first_leaf = 0, first_brick = 0;
  for (std::size_t v = 0; v < tree_->forest.volumes.size(); ++v) {
    const VolumeTree& volume = tree_->forest.volumes[v];
    const auto first_node = std::size_t(scene.volumes[v].first_node);
    for (std::size_t n = 0; n < volume.nodes.size(); ++n) {
      const TreeNode& node = volume.nodes[n];
      if (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant) continue;
      const std::uint32_t slot = held_[first_leaf + node.lit];
      nodes[first_node + n].first_child_or_lit = slot;
      lit[slot] = scene.lit[first_leaf + node.lit];
      if (node.kind != NodeKind::kBrick) continue;
      nodes[first_node + n].brick_or_constant = slot;
      bricks[slot] = scene.bricks[first_brick + node.brick];
      if (scene.has_ice) ice[slot] = scene.ice[first_brick + node.brick];
    }
    first_leaf += volume.lit_nodes;
    first_brick += volume.bricks.size();
  }
  volumes_ = gl::Buffer(std::span<const VolumeData>(scene.volumes));
  nodes_ = gl::Buffer(std::span<const NodeRecord>(nodes));
  bricks_ = gl::Buffer(std::span<const BrickRecord>(bricks));
  phases_ = gl::Buffer(std::span<const float>(scene.phases));
  lit_ = gl::Buffer(std::span<const LitRecord>(lit));
  ice_ = gl::Buffer(std::span<const BrickRecord>(ice));
  if (tree_->planet) tree_->planet->upload(last ? last->tree_->planet.get() : nullptr);
  const std::string planet = tree_->planet ? tree_->planet->defines() : "";
  switches_ = gl::shader_switches(*tree_->request, scene, planet, false);
  lit_switches_ = gl::shader_switches(*tree_->request, scene, planet, true);
}

void ResidentTree::bind(const FrameData& frame) {
  frame_ = gl::Buffer(&frame, sizeof frame);
  GLuint binding = 0;
  for (const gl::Buffer* buffer : {&frame_, &volumes_, &nodes_, &bricks_, &phases_, &lit_})
    buffer->bind(binding++);
  if (tree_->scene.has_ice) ice_.bind(8);
  if (tree_->planet) tree_->planet->bind();
}

std::uint64_t ResidentTree::gpu_bytes() const {
  return volumes_.bytes() + nodes_.bytes() + bricks_.bytes() + phases_.bytes() + lit_.bytes() +
         ice_.bytes();
}

bool same_light(const LiveTree& a, const LiveTree& b) {
  const auto same_sun = [](const RenderRequest& x, const RenderRequest& y) {
    return x.sun.to_sun == y.sun.to_sun && x.sky.up == y.sky.up &&
           x.settings.step_voxels == y.settings.step_voxels &&
           x.settings.light == y.settings.light && x.settings.fetch == y.settings.fetch &&
           gl::least_transmittance(x.settings) == gl::least_transmittance(y.settings);
  };
  if (!same_sun(*a.request, *b.request)) return false;
  return std::ranges::equal(
      a.forest.volumes, b.forest.volumes, [](const VolumeTree& x, const VolumeTree& y) {
        return x.source == y.source && x.time_s == y.time_s &&
               std::ranges::equal(x.nodes, y.nodes, {}, &TreeNode::key, &TreeNode::key);
      });
}

}  // namespace nepho
