#include "loaded_frame.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

// A mistake for the conformance suite to find.
#ifdef NEPHO_MUTANT_HALF
#define NEPHO_MUTATION_FACTOR 0.5
#else
#define NEPHO_MUTATION_FACTOR 1.0
#endif

namespace nepho::vdb {
namespace {

// A file without voxels: nothing anywhere.
class EmptyGrid final : public VdbGrid {
 public:
  void samples(const Coord3&, bool, double* values) const override {
    std::fill_n(values, kBrickVolume, 0.0);
  }
  double value(const Coord3&) const override { return 0; }
  ColumnSum columns(std::size_t) const override { return {}; }
  std::uint64_t bytes() const override { return 0; }
};

}  // namespace

LoadedFrame::LoadedFrame(const VolumeLayout& layout, std::unique_ptr<VdbGrid> grid,
                         double scale_per_m)
    : layout_(layout),
      grid_(grid ? std::move(grid) : std::make_unique<EmptyGrid>()),
      scale_per_m_(scale_per_m),
      tiles_(layout.lattice, boxes()),
      pyramid_(*layout.chart, layout.lattice, leaves()) {}

std::vector<TileBox> LoadedFrame::boxes() const {
  std::vector<TileBox> boxes = grid_->tiles();
  for (TileBox& box : boxes) {
    box.value *= scale_per_m_;
    for (std::size_t a = 0; a < 3; ++a)
      box.low[a] -= layout_.origin[a], box.high[a] -= layout_.origin[a];
  }
  return boxes;
}

// A block's lowest samples are the last ones of the bricks below it.
SparsePyramid::Field LoadedFrame::leaves() const {
  SparsePyramid::Field field;
  const int finest = layout_.lattice.max_level();
  for (const Block& block : grid_->blocks())
    for (unsigned below = 0; below < 8; ++below) {
      if (!(block.reach >> below & 1)) continue;
      std::array<std::int64_t, 3> node{};
      for (std::size_t a = 0; a < 3; ++a)
        node[a] = (block.origin[a] - layout_.origin[a]) / kBrickCells - (below >> a & 1);
      // no voxel lies on the lattice's first samples, so there is always a brick below
      field.nodes.emplace_back(0, finest, std::uint32_t(node[0]), std::uint32_t(node[1]),
                               std::uint32_t(node[2]));
    }
  std::ranges::sort(field.nodes);
  const auto repeated = std::ranges::unique(field.nodes);
  field.nodes.erase(repeated.begin(), repeated.end());
  field.samples = [this](NodeKey key, double* values) { leaf_samples(key, values); };
  return field;
}

void LoadedFrame::leaf_samples(NodeKey finest, double* values) const {
  grid_->samples(layout_.corner(finest), false, values);
  for (double* at = values; at != values + kBrickVolume; ++at)
    *at *= NEPHO_MUTATION_FACTOR * scale_per_m_;
}

void LoadedFrame::samples(NodeKey key, double* values) const {
  if (key.level() < layout_.lattice.max_level()) {
    pyramid_.samples(key, values);
    tiles_.add_samples(key, values);
    return;
  }
  grid_->samples(layout_.corner(key), true, values);
  for (double* at = values; at != values + kBrickVolume; ++at)
    *at *= NEPHO_MUTATION_FACTOR * scale_per_m_;
}

NodeSummary LoadedFrame::summary(NodeKey key) const {
  const NodeSummary rest = pyramid_.summary(key);
  if (tiles_.size() == 0 || !tiles_.touches(key)) return rest;
  BrickSamples values{};
  if (!rest.empty && key.level() < layout_.lattice.max_level())
    pyramid_.samples(key, values.data());
  return tiles_.summary(key, rest, values.data());
}

double LoadedFrame::point(const glm::dvec3& cell) const {
  const glm::dvec3 low = glm::floor(cell);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    Coord3 at{};
    for (int a = 0; a < 3; ++a) {
      const int upper = corner >> a & 1;
      weight *= upper ? cell[a] - low[a] : 1 - (cell[a] - low[a]);
      at[std::size_t(a)] =
          std::int32_t(layout_.origin[std::size_t(a)] + std::int64_t(low[a]) + upper);
    }
    if (weight > 0) sum += weight * grid_->value(at);
  }
  return sum * scale_per_m_;
}

std::shared_ptr<const LoadedFrame> FrameCache::keep(std::size_t file,
                                                    std::unique_ptr<VdbGrid> grid) {
  while (frames_.size() >= kKept) frames_.pop_back();  // first, so that never three are held
  auto frame = std::make_shared<const LoadedFrame>(layout_, std::move(grid), scale_per_m_);
  on_load_(file, frame->grid().tally());
  frames_.emplace_front(file, frame);
  return frame;
}

std::shared_ptr<const LoadedFrame> FrameCache::put(std::size_t file,
                                                   std::unique_ptr<VdbGrid> grid) {
  const std::lock_guard lock(mutex_);
  return tbb::this_task_arena::isolate([&] { return keep(file, std::move(grid)); });
}

std::shared_ptr<const LoadedFrame> FrameCache::get(std::size_t file) {
  const std::lock_guard lock(mutex_);
  const auto at = std::ranges::find(frames_, file, [](const auto& frame) { return frame.first; });
  if (at != frames_.end()) {
    frames_.splice(frames_.begin(), frames_, at);
    return frames_.front().second;
  }
  // Isolated: a stolen task that reads another brick would wait for the lock this thread holds.
  return tbb::this_task_arena::isolate([&] {
    std::unique_ptr<VdbGrid> grid;
    if (!layout_.headers[file].active.empty())
      grid = read_grid(layout_.sequence.files[file], layout_.grid);
    return keep(file, std::move(grid));
  });
}

}  // namespace nepho::vdb
