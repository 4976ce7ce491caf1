#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gl/object.h"
#include "live/live_tree.h"
#include "live/slots.h"

namespace nepho {

// A tree on the GPU: its nodes point to tiles of the atlases by slots that it holds.
class ResidentTree {
 public:
  // Null where no slot is left. `last`: whose textures of the planet may be used again.
  static std::unique_ptr<ResidentTree> make(std::unique_ptr<LiveTree> tree, Slots& slots,
                                            const ResidentTree* last);
  ~ResidentTree();
  ResidentTree(const ResidentTree&) = delete;
  ResidentTree& operator=(const ResidentTree&) = delete;

  const LiveTree& tree() const { return *tree_; }
  // Its textures end with the last holder, who is to have the context.
  std::shared_ptr<const LiveTree> shared_tree() const { return tree_; }
  std::uint32_t slot(std::size_t leaf) const { return held_[leaf]; }
  gl::PlanetPasses* planet() { return tree_->planet.get(); }
  const gl::Buffer& phases() const { return phases_; }
  const std::string& switches(bool lit) const { return lit ? lit_switches_ : switches_; }
  std::uint64_t gpu_bytes() const;

  // Buffers of all passes, but for the frame's; `frame` stands for it until the next.
  void bind(const FrameData& frame);

 private:
  ResidentTree(std::unique_ptr<LiveTree> tree, Slots& slots)
      : tree_(std::move(tree)), slots_(slots) {}
  void upload(const ResidentTree* last);

  std::shared_ptr<LiveTree> tree_;
  Slots& slots_;
  std::vector<std::uint32_t> held_;  // by leaf
  gl::Buffer frame_, volumes_, nodes_, bricks_, phases_, lit_, ice_;
  std::string switches_, lit_switches_;
};

// Whether both have the same leaves, lit alike: the light of one is that of the other.
bool same_light(const LiveTree& a, const LiveTree& b);

}  // namespace nepho
