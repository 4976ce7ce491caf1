#pragma once

#include <cstddef>
#include <vector>

namespace nepho {

// The light that a picture was made with: a tile of 9^3 samples for each leaf with extinction, of
// all volumes in their order (TreeNode::lit within one). Optical depth towards the sun and, where
// the sky lights the clouds, what of it is visible above, aside and below.
struct LightTiles {
  std::vector<std::size_t> first;  // tile of each volume
  int channels = 1;                // 1 or 4
  std::vector<float> values;       // [tile][sample, x fastest][channel]

  const float* tile(std::size_t volume, std::size_t lit) const {
    return values.data() + (first[volume] + lit) * 729 * std::size_t(channels);
  }
};

}  // namespace nepho
