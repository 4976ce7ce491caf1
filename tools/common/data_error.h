#pragma once

#include <cstdint>

#include "bricks/brick_source.h"

namespace nepho {

// The data error of lattice.md 4: how far the finest bricks, decoded and interpolated, are from the
// source's own field, at random points of finest nodes that hold cloud.
struct DataError {
  double rms_per_m = 0, field_rms_per_m = 0;  // of the difference, and of the source's own field
  double largest_per_m = 0;
  int points = 0, nodes = 0;
};
// Means over the volume of those nodes, estimated from a few that are drawn by their extinction and
// weighted by the inverse of their probability. Throws Error where the source has no field of its
// own, or no cloud at this time.
DataError data_error(const BrickSource& source, double time_s, std::uint64_t seed = 1);

}  // namespace nepho
