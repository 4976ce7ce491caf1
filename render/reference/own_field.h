#pragma once

#include <span>

#include "reference/level_set.h"

namespace nepho {

// Bricks, whose cells are taken in steps as those of an OwnField are.
class BricksInSteps final : public CutLevels {
 public:
  BricksInSteps(const Forest& forest, int steps) : CutLevels(forest), steps_(steps) {}
  int steps_in_cell() const override { return steps_; }

 private:
  int steps_;
};

// The sources' own fields rather than what their bricks interpolate: the truth that the data term
// of an error goes by. `bricks` holds the same volumes and outlives this; rays go through the cells
// of its nodes that are not empty, and look at the field at the ends and in the middle of `steps`
// parts of each (Simpson). What is ice of it is what the bricks say. Thread-safe.
class OwnField final : public LevelSet {
 public:
  // Throws Error where a source has no field of its own.
  OwnField(const LevelSet& bricks, std::span<const RenderVolume> volumes, int steps);

  std::size_t size() const override { return bricks_.size(); }
  const VolumeInfo& info(std::size_t volume) const override { return bricks_.info(volume); }
  LevelLeaf leaf(std::size_t volume, int root, const Index3& finest_cell) const override {
    return bricks_.leaf(volume, root, finest_cell);
  }
  int steps_in_cell() const override { return steps_; }
  bool is_own_field() const override { return true; }
  // Throws Error with the source's own text where it fails.
  double own_extinction_per_m(std::size_t volume, const RootPosition& at) const override;

 private:
  const LevelSet& bricks_;
  std::span<const RenderVolume> volumes_;
  int steps_;
};

}  // namespace nepho
