#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "bricks/chart.h"
#include "bricks/shell_chart.h"
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
    // Level in a periodic box, and so without end: where eight periods are over.
    double level_end_m = kNoDistance_m;
  };

  virtual ~ChartRay() = default;
  virtual Start start(double t_max_m) const = 0;
  // Position in finest cells at t, on one root.
  virtual glm::dvec3 cells_at(int root, double t_m) const = 0;
  // Where a block that holds the ray at t is left.
  virtual Exit exit(int root, const Block& block, double t_m) const = 0;
  // Where the ray goes on beyond the end of a root: on the next, or after a gap (below a shell's
  // bottom). False where the chart ends.
  virtual bool cross_end(const Exit& exit, double& t_m, int& root, Cell& cell) const = 0;
  // Index inside the root.
  virtual Index3 wrapped(const Cell& cell) const = 0;
  // Simpson sub-steps for `length_m` of ray in a cell that is `cells_high` finest cells high.
  virtual int sub_steps(double length_m, double cells_high) const = 0;
};

std::unique_ptr<ChartRay> chart_ray(const VolumeInfo& info, const Ray& ray);

// The planet's body: it hides the sun, and is `below` to the eye. Of the scene's planet; without
// one, of the scene's shells the lowest of their bottoms, but no higher than sea level.
class Ground {
 public:
  void set(const Ellipsoid& body);
  void add(const Chart& chart);
  // Where the ray meets it from above, or kNoDistance_m.
  double distance_m(const Ray& ray) const;
  // Part of the sun's disc above its horizon; 1 without a ground.
  double sun_part(const glm::dvec3& point_m, const glm::dvec3& to_sun) const;

 private:
  double radius_m_ = 0, z_scale_ = 1;  // in the space where it is a sphere; 0: none
};

}  // namespace nepho
