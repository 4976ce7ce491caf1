#pragma once

#include <map>
#include <memory>
#include <utility>

#include "bricks/brick_source.h"
#include "bricks/quantise.h"
#include "dense_levels.h"

namespace nepho::test {

// A field as a BrickSource: every level materialised, bounds exact. For lattices of tests' size.
class FieldSource final : public BrickSource {
 public:
  template <class Field>
  FieldSource(std::shared_ptr<const Chart> chart, Lattice lattice, Field&& field) {
    info_.name = "field";
    info_.chart = std::move(chart);
    info_.lattice = std::move(lattice);
    pyramid_ = build_pyramid(*info_.chart, info_.lattice, field,
                             [](const ColumnStencil& c, const LayerStencil& l, const auto& fine) {
                               return weighted_mean(c, l, fine);
                             });
    for (int level = info_.lattice.max_level(); level >= 0; --level)
      for_each_node(*info_.chart, info_.lattice, level, [&](NodeKey key) { summarise(key); });
  }

  const VolumeInfo& info() const noexcept override { return info_; }
  // Before coding; `global` is an index on the key's level.
  double sample(NodeKey key, const Index3& global) const {
    return level(key)({key.root(), global[0], global[1]}, global[2]);
  }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    if (const Status s = check_request(info_, key, time_s); s != Status::kOk) return s;
    summary = summaries_.at(key);
    return Status::kOk;
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    if (const Status s = check_request(info_, key, time_s); s != Status::kOk) return s;
    const BrickSamples samples = brick_of(level(key), key);
    for (ChannelView& view : brick) {
      const Quantised q = quantise(samples, {view.codes, kBrickVolume});
      view.scale = q.scale;
      view.offset = q.offset;
      view.max_abs_error = q.max_abs_error;
    }
    return Status::kOk;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  const DenseLevel& level(NodeKey key) const { return pyramid_.levels[std::size_t(key.level())]; }

  // Own level's trilinear value at a sample of the finest level. Their difference is trilinear in
  // each finest cell, so its greatest value is at a finest sample.
  double coarse_value(NodeKey key, const Index3& finest) const {
    const Index3& n = info_.lattice.cells(info_.lattice.max_level());
    const Index3& own = level(key).cells();
    Index3 cell;
    glm::dvec3 f;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t ratio = n[a] / own[a];
      cell[a] = std::min(finest[a] / ratio, own[a] - 1);
      f[int(a)] = double(finest[a] - cell[a] * ratio) / ratio;
    }
    double sum = 0;
    for (std::uint32_t c = 0; c < 8; ++c) {
      const std::uint32_t x = c & 1, y = c >> 1 & 1, z = c >> 2;
      sum += (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z) *
             level(key)({key.root(), cell[0] + x, cell[1] + y}, cell[2] + z);
    }
    return sum;
  }

  void summarise(NodeKey key) {
    const BrickSamples samples = brick_of(level(key), key);
    double low = samples[0], high = samples[0], most_error = 0;
    for (const double s : samples) low = std::min(low, s), high = std::max(high, s);
    NodeSummary summary;
    summary.empty = high == 0;
    const DenseLevel& finest = pyramid_.levels.back();
    Index3 first = Lattice::global_sample(key, {0, 0, 0}), last;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t ratio = finest.cells()[a] / level(key).cells()[a];
      first[a] *= ratio;
      last[a] = first[a] + kBrickCells * ratio;
    }
    for (std::uint32_t k = first[2]; k <= last[2]; ++k)
      for (std::uint32_t j = first[1]; j <= last[1]; ++j)
        for (std::uint32_t i = first[0]; i <= last[0]; ++i) {
          const double value = finest({key.root(), i, j}, k);
          most_error = std::max(most_error, std::abs(value - coarse_value(key, {i, j, k})));
        }
    summary.error_bound_per_m = most_error < 1e-14 * high ? 0 : most_error;
    if (key.level() < info_.lattice.max_level()) {
      const SplitMask mask = info_.lattice.split_axes(key.level());
      for (SplitMask octant = 0; octant <= kSplitXyz; ++octant) {
        if (octant & ~mask) continue;
        const NodeSummary& child = summaries_.at(key.child(mask, octant));
        if (!child.empty || child.children) summary.children |= std::uint8_t(1 << octant);
        low = std::min(low, double(child.min_extinction_per_m));
        high = std::max(high, double(child.max_extinction_per_m));
      }
    }
    summary.constant = low >= high * (1 - 1e-6) && summary.error_bound_per_m == 0;
    summary.constant_extinction_per_m = summary.constant ? float(samples[0]) : 0;
    summary.min_extinction_per_m = float(low);
    summary.max_extinction_per_m = decoded_bound(high);
    summaries_[key] = summary;
  }

  VolumeInfo info_;
  Pyramid pyramid_;
  std::map<NodeKey, NodeSummary> summaries_;
};

inline Lattice isotropic(int levels) {
  return Lattice(std::vector<SplitMask>(std::size_t(levels), kSplitXyz));
}

}  // namespace nepho::test
