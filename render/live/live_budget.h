#pragma once

#include <array>
#include <cstdint>

#include "tree/forest.h"

namespace nepho {

// How a budget is shared out where trees follow each other. The atlases have room for two trees:
// the one that is shown and the next, or what the last ones left behind. Three trees are in memory:
// those two, and the one that is being made. The rest remembers bricks that were read.
struct LiveBudget {
  std::array<int, 3> atlas_size{};  // of bricks (and ice), and of light
  std::uint32_t slots = 0;          // its tiles
  std::uint64_t gpu_bytes = 0;      // of the atlases
  std::uint64_t cache_bytes = 0;
  std::uint64_t tree_bytes = 0;  // of one tree: `cost` is kept below it
  TileCost cost;                 // what a node and a leaf of a tree are charged
  std::uint64_t budget_bytes = 0;

  // The part that a tree of no more than `leaves` leaves takes of tree_bytes, MiB.
  double tree_mib(std::uint32_t leaves) const;
  std::uint32_t most_leaves() const { return slots / 2; }
};

// `sky`: light tiles hold the sky's visibility too; `ice`: there is a second atlas. Throws Error
// where the budget has no room for 64 leaves.
LiveBudget share_budget(double budget_mib, bool sky, bool ice);

}  // namespace nepho
