#pragma once

#include <span>

#include "live/live_tree.h"

namespace nepho {

// Some leaves of a tree as one of their own, for the list of samples that need light. `leaves`
// ascend; their tiles are numbered in that order. Samples that they share with others are theirs.
Forest forest_of(const LiveTree& tree, std::span<const std::size_t> leaves);

}  // namespace nepho
