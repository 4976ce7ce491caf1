#pragma once

#include <memory>
#include <vector>

#include "bricks/box_chart.h"
#include "forecast/bricks/hat_remap.h"

namespace nepho::forecast {

// The same field in cubes: one box around the whole planet, split in all three axes, as octrees of
// planets have it. For comparison only: what a shell's hats interpolate is sampled at the corners
// of cubic voxels (SampleKind::kPoint).
class BoxAround {
 public:
  // A box of `max_level` splits; 0: the finest that takes no more than about 60 000 bricks for
  // `remap`'s clouds.
  BoxAround(std::shared_ptr<const ShellChart> shell, const HatRemap& remap, int max_level);

  const std::shared_ptr<const BoxChart>& chart() const { return chart_; }
  const Lattice& lattice() const { return lattice_; }
  double voxel_m() const;

  // Finest nodes whose samples are not all zero, ascending. Throws Error above 400 000.
  std::vector<NodeKey> nodes(const HatRemap& remap, HatRemap::Part part) const;
  void samples(const HatRemap& remap, HatRemap::Part part, NodeKey key, double* samples) const;

 private:
  // Nodes of a level that a voxel of the shell with something in it touches, ascending.
  std::vector<NodeKey> touched(const HatRemap& remap, HatRemap::Part part, int level,
                               std::size_t most) const;

  std::shared_ptr<const ShellChart> shell_;
  std::shared_ptr<const BoxChart> chart_;
  Lattice lattice_{{}};
};

}  // namespace nepho::forecast
