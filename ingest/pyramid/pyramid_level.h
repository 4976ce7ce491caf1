#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bricks/coarsen.h"
#include "pyramid/record.h"

namespace nepho {

// The stored nodes of one level.
struct PyramidLevel {
  using Variances = std::array<float, kBrickVolume>;

  std::vector<NodeKey> keys;  // ascending; the others run parallel
  std::vector<Record> records;
  // None at the finest level. A block each, so that a level can grow.
  std::vector<std::unique_ptr<BrickSamples>> samples;
  // While building: sums of c^2, then unresolved variances.
  std::vector<std::unique_ptr<Variances>> variances;

  std::optional<std::size_t> find(NodeKey key) const {
    const auto found = std::ranges::lower_bound(keys, key);
    if (found == keys.end() || *found != key) return std::nullopt;
    return std::size_t(found - keys.begin());
  }
  const double* at(std::size_t node) const { return samples[node]->data(); }

  // Adds what is missing of `more`, and zero blocks where there are none.
  void insert(std::vector<NodeKey> more) {
    std::ranges::sort(more);
    more.erase(std::ranges::unique(more).begin(), more.end());
    PyramidLevel before = std::move(*this);
    *this = PyramidLevel();
    std::ranges::set_union(before.keys, more, std::back_inserter(keys));
    samples.resize(keys.size());
    variances.resize(keys.size());
    for (std::size_t old = 0; old < before.samples.size(); ++old) {
      const std::size_t node = *find(before.keys[old]);
      samples[node] = std::move(before.samples[old]);
      variances[node] = std::move(before.variances[old]);
    }
    for (std::size_t node = 0; node < keys.size(); ++node) {
      if (samples[node]) continue;
      samples[node] = std::make_unique<BrickSamples>();
      variances[node] = std::make_unique<Variances>();
    }
  }

  void drop_variances() {
    variances.clear();
    variances.shrink_to_fit();
  }

  std::uint64_t bytes() const {
    return keys.capacity() * sizeof(NodeKey) + records.capacity() * sizeof(Record) +
           (samples.capacity() + variances.capacity()) * sizeof(void*) +
           samples.size() * sizeof(BrickSamples) + variances.size() * sizeof(Variances);
  }
};

}  // namespace nepho
