#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

#include "tree/forest.h"

namespace nepho::gl {

// Which samples of the light tiles are worth a march. Light is looked up where there is extinction,
// between the corners of a cell: all others take the light of the nearest that has some (the far
// end of a step that begins in clear air).
class LightSamples {
 public:
  explicit LightSamples(const Forest& forest);

  std::size_t tiles() const { return needed_.size(); }
  // Entries are 729 tile + sample, x fastest, for `count` tiles from `first`.
  std::vector<std::uint32_t> needed(std::size_t first, std::size_t count) const;
  // Every second sample, with a needed one beside it.
  std::vector<std::uint32_t> coarse(std::size_t first, std::size_t count) const;
  // Pairs: a sample that is not needed, and the nearest one that is.
  std::vector<std::uint32_t> pairs(std::size_t first, std::size_t count) const;

 private:
  std::vector<std::bitset<729>> needed_;  // by light tile
};

}  // namespace nepho::gl
