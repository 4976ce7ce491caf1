#pragma once

#include <functional>
#include <utility>

#include "bricks/brick_source.h"

namespace nepho::test {

// A source with another's bricks, each sample of them times `part`, and a field of its own.
class OwnSource final : public BrickSource {
 public:
  using Field = std::function<double(glm::dvec3 ecef_m)>;
  OwnSource(const BrickSource& bricks, Field field, float part = 1)
      : bricks_(bricks), field_(std::move(field)), part_(part) {}

  const VolumeInfo& info() const noexcept override { return bricks_.info(); }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    const Status status = bricks_.summary(key, time_s, summary);
    for (float* value : {&summary.min_extinction_per_m, &summary.max_extinction_per_m,
                         &summary.constant_extinction_per_m})
      *value *= part_;
    summary.unresolved_variance_per_m2 *= double(part_) * double(part_);
    summary.error_bound_per_m *= double(part_);
    return status;
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    const Status status = bricks_.read(key, time_s, brick);
    for (ChannelView& view : brick) {
      view.scale *= part_;
      view.offset *= part_;
      view.max_abs_error *= double(part_);
    }
    return status;
  }
  Status point_extinction_per_m(const glm::dvec3& ecef_m, double,
                                double& extinction_per_m) const noexcept override {
    extinction_per_m = field_(ecef_m);
    return Status::kOk;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return bricks_.last_error(buffer, size);
  }

 private:
  const BrickSource& bricks_;  // outlives this
  Field field_;
  float part_;
};

}  // namespace nepho::test
