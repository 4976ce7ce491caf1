#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "bricks/box_chart.h"
#include "reference/chart_ray.h"
#include "reference/near_angle.h"

namespace nepho {

// The two kinds of ChartRay by name, for walks that are compiled for each of them.

// A level ray in a periodic box would never leave.
inline constexpr double kMaxPeriods = 4096, kLevelPeriods = 8, kLevel = 1e-6;

inline std::int64_t floor_clamped(double x, std::int64_t count) {
  return std::int64_t(std::clamp(std::floor(x), 0.0, double(count - 1)));
}

class BoxRay final : public ChartRay {
 public:
  BoxRay(const BoxChart& chart, const Index3& cells, const Ray& ray)
      : chart_(chart),
        cells_(cells),
        count_(double(cells[0]), double(cells[1]), double(cells[2])),
        origin_(count_ * (chart.inverse_edges() * (ray.origin_m - chart.origin_m()))),
        slope_(count_ * (chart.inverse_edges() * ray.direction)) {}

  Start start(double t_max_m) const override {
    Start s{0, t_max_m, 0, {}};
    for (int a = 0; a < 3; ++a) {
      if (periodic(a)) {
        if (slope_[a] == 0) continue;
        const double period_m = count_[a] / std::abs(slope_[a]);
        s.end_m = std::min(s.end_m, kMaxPeriods * period_m);
        if (std::abs(slope_[2]) < kLevel * std::abs(slope_[a]))
          s.level_end_m = std::min(s.level_end_m, kLevelPeriods * period_m);
      } else if (slope_[a] == 0) {
        if (origin_[a] < 0 || origin_[a] > count_[a]) s.end_m = -1;
      } else {
        const double t0 = -origin_[a] / slope_[a], t1 = (count_[a] - origin_[a]) / slope_[a];
        s.t_m = std::max(s.t_m, std::min(t0, t1));
        s.end_m = std::min(s.end_m, std::max(t0, t1));
      }
    }
    const glm::dvec3 at = cells_at(0, s.t_m);
    for (int a = 0; a < 3; ++a)
      s.cell[std::size_t(a)] = periodic(a) ? std::int64_t(std::floor(at[a]))
                                           : floor_clamped(at[a], cells_[std::size_t(a)]);
    return s;
  }
  glm::dvec3 cells_at(int, double t_m) const override { return origin_ + t_m * slope_; }
  Exit exit(int, const Block& block, double t_m) const override {
    Exit exit{kNoDistance_m, 0, 0};
    for (int a = 0; a < 3; ++a) {
      if (slope_[a] == 0) continue;
      const int side = slope_[a] > 0 ? 1 : -1;
      const std::int64_t wall = (side > 0 ? block.high : block.low)[std::size_t(a)];
      const double t = std::max(t_m, (double(wall) - origin_[a]) / slope_[a]);
      if (t < exit.t_m) exit = {t, a, side};
    }
    return exit;
  }
  bool cross_end(const Exit& exit, double&, int&, Cell&) const override {
    return periodic(exit.axis);
  }
  Index3 wrapped(const Cell& cell) const override;
  int sub_steps(double, double) const override { return 1; }

 private:
  bool periodic(int axis) const {
    return axis == 0 ? chart_.periodic().x : axis == 1 && chart_.periodic().y;
  }
  const BoxChart& chart_;
  Index3 cells_;
  glm::dvec3 count_, origin_, slope_;
};

// A line and spheres about the origin. What does not depend on the sphere is worked out once.
class SphereChords {
 public:
  struct Chord {
    double first, second;  // distances along the line, ascending
  };
  SphereChords(const glm::dvec3& origin, const glm::dvec3& direction);
  std::optional<Chord> with(double radius) const;  // none where it is missed

 private:
  double a_, b_, r0_, miss_, slope_;
};

// The six faces of the cube: on it, a face's middle is its normal, and the middles of its sides are
// normal + u or v, each an axis of space or its negative. The same for all shells.
struct FaceAxes {
  struct Axis {
    int axis;
    double sign;
    double of(const glm::dvec3& p) const { return sign * p[axis]; }
  };
  Axis normal, u, v;
};

// Not for two threads at once: remembers tangents and angles of the last place.
class ShellRay final : public ChartRay {
 public:
  ShellRay(const ShellChart& chart, const Index3& cells, const Ray& ray);

  Start start(double t_max_m) const override;
  glm::dvec3 cells_at(int root, double t_m) const override;
  // Each wall is left in one sense only, so that no root has to be chosen: a coordinate of a face
  // rises or falls all along the ray, whose distance from a plane is linear in t; a sphere below
  // can be met before the closest approach to the centre, and one above after it.
  Exit exit(int root, const Block& block, double t_m) const override;
  bool cross_end(const Exit& exit, double& t_m, int& root, Cell& cell) const override;
  Index3 wrapped(const Cell& cell) const override {
    return {std::uint32_t(cell[0]), std::uint32_t(cell[1]), std::uint32_t(cell[2])};
  }
  int sub_steps(double length_m, double cells_high) const override;

 private:
  // Finds root and cell from the position alone.
  void enter(double t_m, int& root, Cell& cell) const;
  double radius_m(double wall) const {
    return chart_.body().equatorial_m +
           (chart_.bottom_m() + wall / count_.z * chart_.thickness_m());
  }
  // Tangent of a wall across an axis: most often that of the last call.
  double wall_tangent(std::size_t axis, std::int64_t wall) const;

  const ShellChart& chart_;
  Index3 cells_;
  glm::dvec3 count_, direction_, origin_;  // scaled space
  double closest_m_;
  SphereChords chords_;
  const std::array<FaceAxes, 6>& axes_;
  mutable std::array<NearAngle, 2> angle_{};
  struct Wall {
    std::int64_t wall = std::numeric_limits<std::int64_t>::min();
    double tangent = 0;
  };
  mutable std::array<Wall, 2> wall_{};
};

}  // namespace nepho
