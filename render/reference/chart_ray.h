#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "bricks/chart.h"
#include "bricks/volume_info.h"

namespace nepho {

// Distances along a ray are metres of the world from its origin; the direction has length 1.
struct Ray {
  glm::dvec3 origin_m{0.0}, direction{0.0, 0.0, 1.0};
};
inline constexpr double kNoDistance_m = 1e30;

// A straight ray in the coordinates of one chart, in double precision throughout. Cells are those
// of the finest lattice; a periodic axis is unrolled, so that indices run on beyond the root.
class ChartRay {
 public:
  using Cell = std::array<std::int64_t, 3>;
  struct Block {
    Cell low, high;  // walls, high > low
  };
  struct Exit {
    double t_m;
    int axis, side;  // side -1 or +1
  };
  struct Start {
    double t_m, end_m;  // empty if end_m <= t_m
    int root;
    Cell cell;
  };

  virtual ~ChartRay() = default;
  virtual Start start(double t_max_m) const = 0;
  // Position in finest cells at t, on one root.
  virtual glm::dvec3 cells_at(int root, double t_m) const = 0;
  // Where a block that holds the ray at t is left.
  virtual Exit exit(int root, const Block& block, double t_m) const = 0;
  // Goes on beyond the end of a root; false where the chart ends there.
  virtual bool cross_end(int& root, Cell& cell, const Exit& exit) const = 0;
  // Index inside the root.
  virtual Index3 wrapped(const Cell& cell) const = 0;
  // Simpson sub-steps for `length_m` of ray in a cell that is `cells_high` finest cells high.
  virtual int sub_steps(double length_m, double cells_high) const = 0;
};

std::unique_ptr<ChartRay> chart_ray(const VolumeInfo& info, const Ray& ray);

// A shell's bottom is the ground, and black: where the ray meets it from above, or kNoDistance_m.
double ground_distance_m(const Chart& chart, const Ray& ray);

}  // namespace nepho
