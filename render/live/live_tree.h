#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gl/frame_data.h"
#include "gl/planet_passes.h"
#include "live/slots.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho {

// A tree that is ready for the GPU, made without OpenGL: for one place of the eye, to be seen from
// others near it.
struct LiveTree {
  std::shared_ptr<const RenderRequest> request;  // its sources are those of the forest
  Forest forest;
  gl::GpuScene scene;
  std::unique_ptr<gl::PlanetPasses> planet;  // null: no planet
  std::uint64_t number = 0;                  // of the request
  bool complete = false;  // as fine as asked for; else a coarse one to begin with

  // By light tile, of all volumes in their order.
  struct Leaf {
    const TreeNode* node;
    const LeafBrick* brick;  // null: a constant
    std::uint32_t volume;
    SlotKey key;
    bool seen;  // from that place
  };
  std::vector<Leaf> leaves;

  std::uint64_t host_bytes() const;
};

// `request`: its sources are those to be read; `refinement`: for its camera. Throws Error.
std::unique_ptr<LiveTree> make_live_tree(std::shared_ptr<const RenderRequest> request,
                                         const Refinement& refinement,
                                         std::shared_ptr<const AirTables> tables);

}  // namespace nepho
