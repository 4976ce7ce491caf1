#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bricks/brick_source.h"
#include "renderer.h"

namespace nepho {

// The part of each volume's tree that a picture needs: refined for a view, under one budget, in
// total order (priority, then volume, then key), so that it repeats for any number of threads.

enum class NodeKind : std::uint8_t { kInner, kEmpty, kConstant, kBrick };

struct TreeNode {
  NodeKey key;
  NodeKind kind = NodeKind::kEmpty;
  std::uint32_t first_child = 0;  // kInner: index of the first of its contiguous children, which
                                  // are all present, in octant order (ascending octant bits)
  std::uint32_t brick = 0;        // kBrick: index into bricks
  std::uint32_t lit = 0;          // kConstant, kBrick that is seen: its light tile, in key order
  bool seen = true;               // a ray through the picture can meet it (ViewMetric::seen)
  float constant_per_m = 0;       // kConstant
  float majorant_per_m = 0;       // bound of this node and below
  float error_bound_per_m = 0;
  float unresolved_variance_per_m2 = 0;
};

// The ice part of a brick's extinction, where a volume has the channel and the brick some ice.
struct IceCodes {
  std::array<std::uint16_t, 729> codes;
  float scale = 0, offset = 0;
};

struct LeafBrick {
  NodeKey key;
  std::array<std::uint16_t, 729> codes;
  float scale = 0, offset = 0;
  double max_abs_error = 0;
  std::shared_ptr<const IceCodes> ice = {};  // null: no ice here
};

struct VolumeTree {
  const BrickSource* source = nullptr;
  double time_s = 0;
  std::vector<TreeNode> nodes;    // the chart's roots first
  std::vector<LeafBrick> bricks;  // in key order
  std::uint32_t lit_nodes = 0;
  int finest_level_used = 0;
};

struct Forest {
  std::vector<VolumeTree> volumes;
  bool budget_bound = false;     // refinement stopped for memory, not because it was done
  bool held = false;             // another one but for Refinement::was_split, or it may be
  std::uint64_t cost_bytes = 0;  // by Refinement::cost, never above the budget
};

// What nodes, bricks and light tiles of all volumes cost on the GPU; kept under the budget.
struct TileCost {
  std::uint64_t node_bytes = 16, brick_bytes = 0, sun_bytes = 0, fixed_bytes = 0;
  // Whole textures count: sides are powers of two, grown one at a time. Null: the linear sum of the
  // four numbers above.
  std::uint64_t (*total)(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) = nullptr;

  std::uint64_t bytes(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) const {
    if (total) return total(nodes, bricks, lit);
    return fixed_bytes + nodes * node_bytes + bricks * brick_bytes + lit * sun_bytes;
  }
};

struct Refinement {
  Camera camera;
  RenderSettings settings;  // size, fov, pixels_per_voxel, max_level, budget_mib, tolerance
  TileCost cost;
  std::optional<glm::dvec3> to_sun = {};  // unit, ECEF; absent: any node off-screen may shadow
  // For views that move. A node that was split stays so until its priority is a third below what
  // splits a new one, so that trees do not change back and forth. And what the picture does not
  // show has light as well: the next may.
  std::function<bool(std::uint32_t volume, NodeKey key)> was_split = {};
  bool light_unseen = false;
};

// A node is split while its voxels (on the axes that the split halves) are larger on the screen
// than settings.pixels_per_voxel, and its error in optical depth is above settings.tolerance: error
// bound x longest edge, a supremum, so that the error of a picture is far below it. (Smoke of 222^3
// voxels, tolerance 1e-2: 5e-7 with 3214 bricks; at 16 times this threshold 1e-3 with 2708, at 256
// times 2e-2 with 1304.) Priority = voxel pixels x (1 - exp(-error)).
// Where a volume says refine_by_variance, the error is at most four unresolved standard deviations
// x the way through the node; priority = voxel pixels x (1 - exp(-error / (10 tolerance))), and it
// is this that has to be above pixels_per_voxel: faint cloud gets larger voxels. Off-screen nodes
// shadow what is seen: they stay, at a quarter of the resolution; at a sixteenth where their shadow
// from the sun misses the picture too and they only dim the sky's light. The sequence of splits
// does not depend on the budget, which only ends it: a larger budget never gives a coarser node.
// Reads summaries and bricks in parallel (TBB), each brick once. Throws Error where the budget does
// not hold the roots, or a source fails (its own text).
Forest build_forest(std::span<const RenderVolume> volumes, const Refinement& refinement);

// The leaf that holds a cell of the finest lattice.
const TreeNode& leaf_at(const VolumeTree& tree, int root, const Index3& finest_cell);

}  // namespace nepho
