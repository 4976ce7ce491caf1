#pragma once

#include <algorithm>

#include "bricks/brick_source.h"

namespace nepho::test {

// A source with another's extinction, and what a test adds to its info. Where that names ice, this
// part of each sample is ice.
class DressedSource final : public BrickSource {
 public:
  template <class Dress>
  DressedSource(const BrickSource& plain, Dress&& dress, double ice_part = 0)
      : plain_(plain), info_(plain.info()), ice_part_(ice_part) {
    dress(info_);
  }

  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return plain_.summary(key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    for (ChannelView& view : brick) {
      ChannelView extinction{.channel = Channel::kExtinction, .codes = view.codes};
      if (const Status s = plain_.read(key, time_s, {&extinction, 1}); s != Status::kOk) return s;
      const float part = view.channel == Channel::kIceExtinction ? float(ice_part_) : 1.0f;
      view.scale = part * extinction.scale;
      view.offset = part * extinction.offset;
      view.max_abs_error = part * extinction.max_abs_error;
    }
    return Status::kOk;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return plain_.last_error(buffer, size);
  }

 private:
  const BrickSource& plain_;  // outlives this
  VolumeInfo info_;
  double ice_part_;
};

}  // namespace nepho::test
