#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "bricks/coarsen.h"
#include "pyramid/sparse_pyramid.h"
#include "tile_boxes.h"
#include "volume_layout.h"

namespace nepho::vdb {

// One frame's field in memory: leaves in the file's tree, their coarse levels in a pyramid, large
// tiles in closed form. Const calls are thread-safe.
class LoadedFrame {
 public:
  // `layout` outlives the frame.
  LoadedFrame(const VolumeLayout& layout, std::unique_ptr<VdbGrid> grid, double scale_per_m);

  void samples(NodeKey key, double* samples) const;  // 9^3, 1/m
  NodeSummary summary(NodeKey key) const;
  double point(const glm::dvec3& finest_cell) const;  // trilinear, 1/m
  std::uint64_t bytes() const { return grid_->bytes() + pyramid_.bytes(); }
  const VdbGrid& grid() const { return *grid_; }

 private:
  SparsePyramid::Field leaves() const;
  void leaf_samples(NodeKey finest, double* samples) const;
  std::vector<TileBox> boxes() const;

  const VolumeLayout& layout_;
  std::unique_ptr<VdbGrid> grid_;
  double scale_per_m_;
  TileBoxes tiles_;
  SparsePyramid pyramid_;
};

// The last two frames that were asked for.
class FrameCache {
 public:
  // `on_load` hears of every frame that is read, under the cache's lock.
  using OnLoad = std::function<void(std::size_t file, const Tally& tally)>;
  FrameCache(const VolumeLayout& layout, OnLoad on_load)
      : layout_(layout), on_load_(std::move(on_load)) {}
  void set_scale(double scale_per_m) { scale_per_m_ = scale_per_m; }
  double scale_per_m() const { return scale_per_m_; }
  // Loads if need be, while other callers wait. Throws Error.
  std::shared_ptr<const LoadedFrame> get(std::size_t file);
  // Puts a grid that is in memory already in place of a load.
  std::shared_ptr<const LoadedFrame> put(std::size_t file, std::unique_ptr<VdbGrid> grid);

 private:
  static constexpr std::size_t kKept = 2;
  std::shared_ptr<const LoadedFrame> keep(std::size_t file, std::unique_ptr<VdbGrid> grid);

  const VolumeLayout& layout_;
  OnLoad on_load_;
  double scale_per_m_ = 1;
  std::mutex mutex_;
  std::list<std::pair<std::size_t, std::shared_ptr<const LoadedFrame>>> frames_;  // newest first
};

}  // namespace nepho::vdb
