#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "tree/forest.h"

namespace nepho::gl {

// Which samples of the light tiles are worth a march. Light is looked up where there is extinction,
// between the corners of a cell: all others take the light of the nearest that has some (the far
// end of a step that begins in clear air). A sample that several tiles share, on their faces, is
// marched in one of them, its owner.
class LightSamples {
 public:
  // With `all` every sample of every tile is marched where it is: for tests.
  explicit LightSamples(const Forest& forest, bool all = false);

  std::size_t tiles() const { return needed_.size(); }
  double spared_share() const;  // part of all samples that are not marched
  // Entries are 729 tile + sample, x fastest, for `count` tiles from `first`.
  std::vector<std::uint32_t> needed(std::size_t first, std::size_t count) const;
  std::vector<std::uint32_t> owned(std::size_t first, std::size_t count) const;  // of the needed
  // Every second sample with a needed one beside it, owned.
  std::vector<std::uint32_t> coarse(std::size_t first, std::size_t count) const;
  // Pairs: a sample of another tile's, and that of its owner.
  std::vector<std::uint32_t> shared(std::size_t first, std::size_t count) const;
  std::vector<std::uint32_t> shared_coarse(std::size_t first, std::size_t count) const;
  // Pairs: a sample that is not needed, and the nearest one that is.
  std::vector<std::uint32_t> pairs(std::size_t first, std::size_t count) const;

 private:
  using Masks = std::vector<std::bitset<729>>;  // by light tile
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  struct Place;

  void share(const std::vector<Place>& places, Masks& masks, Pairs& pairs) const;

  Masks needed_, owned_, coarse_;
  Pairs shared_, shared_coarse_;  // in order of their first
};

}  // namespace nepho::gl
