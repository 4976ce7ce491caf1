#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bricks/brick_source.h"
#include "renderer.h"
#include "tree/forest.h"

namespace nepho {

// What a ray finds around a cell of the finest lattice: the node to use there, and what is in it.
struct LevelLeaf {
  NodeKey key;
  NodeKind kind = NodeKind::kEmpty;  // never kInner
  double constant_per_m = 0;
  std::shared_ptr<const LeafBrick> brick;  // kBrick
  std::uint32_t lit = 0;                   // of a cut: its light tile (TreeNode)
};

// A choice of one level at each place of each volume: what the reference march sees. Thread-safe.
class LevelSet {
 public:
  virtual ~LevelSet() = default;
  virtual std::size_t size() const = 0;
  virtual const VolumeInfo& info(std::size_t volume) const = 0;
  virtual LevelLeaf leaf(std::size_t volume, int root, const Index3& finest_cell) const = 0;
  // Whether noise_per_m is ever other than 0.
  virtual bool has_noise() const { return false; }
  // Added to a decoded sample of `leaf`; `global` is its index on the leaf's level.
  virtual double noise_per_m(std::size_t volume, const LevelLeaf& leaf,
                             const Index3& global) const {
    (void)volume, (void)leaf, (void)global;
    return 0;
  }
  // Each cell of a leaf that is neither empty nor constant is taken in so many steps, at least.
  virtual int steps_in_cell() const { return 1; }
  // Extinction is own_extinction_per_m() rather than the bricks' (own_field.h).
  virtual bool is_own_field() const { return false; }
  virtual double own_extinction_per_m(std::size_t volume, const RootPosition& at) const {
    (void)volume, (void)at;
    return 0;
  }
};

// The cut of a forest, which outlives this.
class CutLevels : public LevelSet {
 public:
  explicit CutLevels(const Forest& forest) : forest_(forest) {}
  std::size_t size() const override { return forest_.volumes.size(); }
  const VolumeInfo& info(std::size_t volume) const override {
    return forest_.volumes[volume].source->info();
  }
  LevelLeaf leaf(std::size_t volume, int root, const Index3& finest_cell) const override;

 private:
  const Forest& forest_;
};

// The same with as much noise as coding with 16 bits made: uniform in +-1/2 step, a hash of volume,
// level, owner of the sample and seed, so that bricks that share a sample agree. Zero stays zero.
class NoisyCutLevels final : public CutLevels {
 public:
  NoisyCutLevels(const Forest& forest, std::uint64_t seed) : CutLevels(forest), seed_(seed) {}
  bool has_noise() const override { return true; }
  double noise_per_m(std::size_t volume, const LevelLeaf& leaf,
                     const Index3& global) const override;

 private:
  std::uint64_t seed_;
};

// The finest level of each source, or the coarsest that is the same: empty and constant nodes, and
// those whose error bound is 0. Bricks are read when asked for and kept while they fit into
// `cache_mib`; beyond it they are dropped and read again, which costs time, not truth. Throws Error
// with the source's own text where it fails.
class FinestLevels final : public LevelSet {
 public:
  // With a `cut` (which outlives this): at most `finer` levels below its leaves. A sky of noise
  // seen from space has nine more, which no picture and no error of one needs.
  FinestLevels(std::span<const RenderVolume> volumes, double cache_mib, const Forest* cut = nullptr,
               int finer = 0);
  ~FinestLevels() override;
  std::size_t size() const override { return volumes_.size(); }
  const VolumeInfo& info(std::size_t volume) const override {
    return volumes_[volume].source->info();
  }
  LevelLeaf leaf(std::size_t volume, int root, const Index3& finest_cell) const override;
  std::uint64_t bricks_read() const;

 private:
  struct Cache;
  NodeSummary summary(std::size_t volume, NodeKey key) const;
  std::shared_ptr<const LeafBrick> brick(std::size_t volume, NodeKey key) const;

  std::vector<RenderVolume> volumes_;
  const Forest* cut_;
  int finer_;
  std::vector<char> tells_ice_;
  std::unique_ptr<Cache> cache_;
};

}  // namespace nepho
