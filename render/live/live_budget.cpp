#include "live/live_budget.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"
#include "gl/atlas.h"
#include "gl/frame_data.h"
#include "gl/node_grid.h"
#include "live/live_tree.h"

namespace nepho {
namespace {

constexpr double kBytesPerMib = 1024.0 * 1024.0;
constexpr std::uint32_t kLeastLeaves = 64;
constexpr double kCacheShare = 0.125;
// On the CPU, and on the GPU for the two trees there; all are charged to one.
constexpr std::uint64_t kNodeBytes =
    sizeof(TreeNode) + 2 * (sizeof(NodeRecord) + gl::kGridBytesPerNode);

std::uint64_t leaf_bytes(bool ice) {
  return sizeof(LeafBrick) + sizeof(LiveTree::Leaf) + (ice ? sizeof(IceCodes) : 0) +
         2 * ((ice ? 2 : 1) * sizeof(BrickRecord) + sizeof(LitRecord));
}

// Sides that hold no more than is asked for, nearly a cube; no powers of two as in atlas_size():
// the last step would leave up to half of the budget unused. Empty: too large.
std::array<int, 3> sides_for(std::uint64_t tiles) {
  const auto side = std::uint64_t(std::cbrt(double(tiles)));
  const std::array<std::uint64_t, 3> counts = {side, side, tiles / (side * side)};
  std::array<int, 3> sides{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (counts[axis] * gl::kTileSide > gl::kLargestSide) return {};
    sides[axis] = int(counts[axis]) * gl::kTileSide;
  }
  return sides;
}

}  // namespace

double LiveBudget::tree_mib(std::uint32_t leaves) const {
  return std::min(double(tree_bytes), double(leaves) * double(cost.sun_bytes)) / kBytesPerMib;
}

LiveBudget share_budget(double budget_mib, bool sky, bool ice) {
  LiveBudget best;
  best.budget_bytes = std::uint64_t(budget_mib * kBytesPerMib);
  best.cache_bytes = std::uint64_t(kCacheShare * double(best.budget_bytes));
  const auto fits = [&](std::uint64_t tiles) {
    const std::array<int, 3> size = sides_for(tiles);
    if (size[0] == 0) return false;
    const std::uint64_t slots = std::uint64_t(size[0] / gl::kTileSide) *
                                std::uint64_t(size[1] / gl::kTileSide) *
                                std::uint64_t(size[2] / gl::kTileSide);
    const std::uint64_t gpu = gl::texels(size) * (2 * (ice ? 2 : 1) + (sky ? 8 : 2));
    const std::uint64_t others = gpu + best.cache_bytes;
    // A tree of half of the slots, with three nodes for a leaf.
    const std::uint64_t least = slots / 2 * (leaf_bytes(ice) + 3 * kNodeBytes);
    if (others + 3 * least > best.budget_bytes) return false;
    best.atlas_size = size;
    best.slots = std::uint32_t(slots);
    best.gpu_bytes = gpu;
    best.tree_bytes = (best.budget_bytes - others) / 3;
    return true;
  };
  std::uint64_t most = 1, never = std::uint64_t(1) << 31;
  while (fits(most) && never - most > 1) {
    const std::uint64_t middle = std::midpoint(most, never);
    (fits(middle) ? most : never) = middle;
  }
  if (best.most_leaves() < kLeastLeaves)
    throw Error({.what = "the memory budget has no room for a view that moves",
                 .where = "budget",
                 .expected = "room for two trees of " + std::to_string(kLeastLeaves) + " leaves",
                 .found = std::to_string(budget_mib) + " MiB",
                 .hint = "raise --budget-mib"});
  // Each leaf, constant or not, has a slot: charged so that the slots end before the memory does.
  best.cost.node_bytes = kNodeBytes;
  best.cost.brick_bytes = 0;
  best.cost.sun_bytes = best.tree_bytes / best.most_leaves() + 1;
  return best;
}

}  // namespace nepho
