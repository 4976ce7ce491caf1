#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bricks/data_facts.h"
#include "bricks/node_key.h"
#include "bricks/volume_info.h"

namespace nepho {

// THE contract between whoever has clouds and whoever draws them. Everything in it is thread-safe
// and noexcept; a failure is a Status, its text is in last_error(). See docs/architecture.md for
// what a sample, a level and a summary mean.

enum class Status : std::int32_t {
  kOk = 0,
  kNoSuchNode,     // level, root or index outside the lattice
  kNoSuchTime,     // not one of VolumeInfo::times_s
  kNoSuchChannel,  // not one of VolumeInfo::channels
  kUnsupported,    // an optional verb that this source does not have
  kReadFailed,     // the data behind the source could not be read: see last_error()
};

const char* to_string(Status status) noexcept;

// One channel of one brick, owned by the caller, who sets `channel` and `codes` (9*9*9, x fastest);
// read() fills the codes and the rest. decode() in quantise.h turns a code into a value.
struct ChannelView {
  Channel channel = Channel::kExtinction;
  std::uint16_t* codes = nullptr;
  float scale = 0, offset = 0;
  double max_abs_error = 0;
};
using BrickView = std::span<ChannelView>;

// What is known of a node without reading voxels.
struct NodeSummary {
  float min_extinction_per_m = 0;  // bounds of the decoded samples of this node's brick and of all
  float max_extinction_per_m = 0;  // its descendants', closed faces included
  float constant_extinction_per_m = 0;    // the value where `constant`
  double unresolved_variance_per_m2 = 0;  // mean over the node of <filtered beta^2> - <c^2>
  double error_bound_per_m = 0;  // sup over the closed node of |own trilinear - finest trilinear|
  std::uint8_t children = 0;     // bit per octant (NodeKey::child): some descendant is not empty
  bool empty = true;             // this level's brick is zero throughout; says nothing of children
  bool constant = true;          // all channels, this level and all below
};

// The source's own column at a place.
struct OwnColumn {
  double optical_depth = 0;  // as the bricks should hold it
  double mean_height_m = 0;  // of its extinction, over the ellipsoid
};

class BrickSource {
 public:
  virtual ~BrickSource() = default;

  virtual const VolumeInfo& info() const noexcept = 0;
  virtual Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept = 0;
  virtual Status read(NodeKey key, double time_s, BrickView brick) const noexcept = 0;
  // Optional and slow: the source's own field at a point of the world, for tests and error reports.
  virtual Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                        double& extinction_per_m) const noexcept {
    (void)ecef_m, (void)time_s, (void)extinction_per_m;
    return Status::kUnsupported;
  }
  // Optional: what the data hold at a time, and their own column below and above a point of the
  // world, both without bricks. For `info`, which also checks bricks against them.
  virtual Status data_facts(double time_s, DataFacts& facts) const noexcept {
    (void)time_s, (void)facts;
    return Status::kUnsupported;
  }
  virtual Status own_column(const glm::dvec3& ecef_m, double time_s,
                            OwnColumn& column) const noexcept {
    (void)ecef_m, (void)time_s, (void)column;
    return Status::kUnsupported;
  }
  // Text of this thread's last failure, cut to `size` with a final 0; returns its whole length.
  virtual std::size_t last_error(char* buffer, std::size_t size) const noexcept = 0;
};

// kOk, or why a source must refuse the key or the time.
Status check_request(const VolumeInfo& info, NodeKey key, double time_s) noexcept;

// For sources: keeps one text per thread behind last_error().
void set_last_error(const char* text) noexcept;
std::size_t copy_last_error(char* buffer, std::size_t size) noexcept;

}  // namespace nepho
