// Trees of OpenVDB as VdbGrid. Leaves hold x slowest: offset = (x << 6) | (y << 3) | z.
#include "vdb_grid.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "column_set.h"
#include "vdb_tree.h"

namespace nepho::vdb {
namespace {

using openvdb::Coord;

template <class Tree>
class TreeGrid final : public VdbGrid {
 public:
  explicit TreeGrid(std::shared_ptr<Tree> tree) : tree_(std::move(tree)) {
    clean_leaves();
    clean_tiles();
  }

  void samples(const Coord3& corner, bool with_tiles, double* values) const override {
    for (int dz = 0; dz < 2; ++dz)
      for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
          const Coord from(corner[0] + 8 * dx, corner[1] + 8 * dy, corner[2] + 8 * dz);
          copy_part(from, {dx, dy, dz}, with_tiles, values);
        }
  }

  double value(const Coord3& voxel) const override {
    typename Tree::ValueType found{};
    const Coord at(voxel[0], voxel[1], voxel[2]);
    return tree_->probeValue(at, found) ? double(found) : 0.0;
  }

  ColumnSum columns(std::size_t axis) const override;
  std::uint64_t bytes() const override { return tree_->memUsage(); }

 private:
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Tree::ValueType;

  // The value to keep, and a note of what was wrong with it.
  Value cleaned(Value value) {
    if (!std::isfinite(value)) return ++tally_.non_finite, Value(0);
    if (value < 0) return ++tally_.negative, Value(0);
    tally_.max = std::max(tally_.max, double(value));
    return value;
  }

  void clean_leaves();
  void clean_tiles();
  void copy_part(const Coord& from, std::array<int, 3> upper, bool with_tiles,
                 double* values) const;

  std::shared_ptr<Tree> tree_;
};

template <class Tree>
void TreeGrid<Tree>::clean_leaves() {
  for (auto leaf = tree_->beginLeaf(); leaf; ++leaf) {
    Value* data = leaf->buffer().data();
    std::uint8_t reach = 0;
    for (unsigned at = 0; at < Leaf::SIZE; ++at) {
      if (!leaf->isValueOn(at)) {
        if (data[at] != Value(0)) ++tally_.inactive_not_zero, data[at] = Value(0);
        continue;
      }
      data[at] = cleaned(data[at]);
      if (data[at] == Value(0)) continue;
      const unsigned faces = (at >> 6 ? 0u : 1u) | (at >> 3 & 7 ? 0u : 2u) | (at & 7 ? 0u : 4u);
      // every subset of the faces it lies on
      for (unsigned subset = 0; subset < 8; ++subset)
        if ((subset & ~faces) == 0) reach |= std::uint8_t(1u << subset);
    }
    const Coord o = leaf->origin();
    tally_.active += leaf->onVoxelCount();
    if (reach) blocks_.push_back({{o.x(), o.y(), o.z()}, reach});
  }
}

template <class Tree>
void TreeGrid<Tree>::clean_tiles() {
  auto off = tree_->beginValueOff();
  off.setMaxDepth(Tree::ValueOffIter::LEAF_DEPTH - 1);
  const bool background_counts = tree_->background() != Value(0) || std::isnan(tree_->background());
  for (; off; ++off)
    if (*off != Value(0)) {
      // tiles that merely repeat the background are its business, counted once below
      if (*off != tree_->background()) ++tally_.inactive_not_zero;
      off.setValue(Value(0));
    }
  if (background_counts) ++tally_.inactive_not_zero;

  auto on = tree_->beginValueOn();
  on.setMaxDepth(Tree::ValueOnIter::LEAF_DEPTH - 1);
  for (; on; ++on) {
    const Value value = cleaned(*on);
    const openvdb::CoordBBox box = on.getBoundingBox();
    tally_.active += box.volume();
    on.setValue(value);
    if (value == Value(0)) continue;
    const Coord low = box.min(), high = box.max();
    if (box.dim().x() == std::int32_t(Leaf::DIM))
      blocks_.push_back({{low.x(), low.y(), low.z()}, 0xff});
    else
      tiles_.push_back({{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}, value});
  }
}

// One of the eight leaves under a 9^3 brick: all of it, a face, an edge or a corner.
template <class Tree>
void TreeGrid<Tree>::copy_part(const Coord& from, std::array<int, 3> upper, bool with_tiles,
                               double* values) const {
  const auto size = [](int is_upper) { return is_upper ? 1 : 8; };
  const Leaf* leaf = tree_->probeConstLeaf(from);
  double fill = 0;
  if (!leaf && tree_->isValueOn(from)) {
    const bool is_block = tree_->getValueDepth(from) == int(Tree::DEPTH) - 2;
    if (is_block || with_tiles) fill = double(tree_->getValue(from));
  }
  const Value* data = leaf ? leaf->buffer().data() : nullptr;
  for (int z = 0; z < size(upper[2]); ++z)
    for (int y = 0; y < size(upper[1]); ++y) {
      double* row = values + 8 * upper[0] + 9 * (y + 8 * upper[1] + 9 * (z + 8 * upper[2]));
      for (int x = 0; x < size(upper[0]); ++x)
        row[x] = data ? double(data[x << 6 | y << 3 | z]) : fill;
    }
}

template <class Tree>
ColumnSum TreeGrid<Tree>::columns(std::size_t axis) const {
  const std::size_t a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  constexpr std::array<unsigned, 3> kShift{6, 3, 0};
  ColumnSet set;
  ColumnSum result;
  for (auto leaf = tree_->cbeginLeaf(); leaf; ++leaf) {
    std::uint64_t mask = 0;
    for (auto on = leaf->cbeginValueOn(); on; ++on) {
      result.values += double(*on);
      mask |= std::uint64_t{1} << (8 * (on.pos() >> kShift[a] & 7) + (on.pos() >> kShift[b] & 7));
    }
    const Coord o = leaf->origin();
    if (mask) set.add_mask(o[int(a)], o[int(b)], mask);
  }
  auto tile = tree_->cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    result.values += double(*tile) * double(box.volume());
    set.add_square(box.min()[int(a)], box.min()[int(b)], box.dim().x());
  }
  result.columns = set.count();
  return result;
}

}  // namespace

std::unique_ptr<VdbGrid> make_grid(const openvdb::GridBase::Ptr& grid) {
  if (auto of_float = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
    return std::make_unique<TreeGrid<openvdb::FloatTree>>(of_float->treePtr());
  if (auto of_double = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid))
    return std::make_unique<TreeGrid<openvdb::DoubleTree>>(of_double->treePtr());
  return nullptr;
}

}  // namespace nepho::vdb
