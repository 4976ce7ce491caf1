#include <gtest/gtest.h>

#include <numbers>

#include "accuracy_report.h"
#include "bricks/shell_chart.h"
#include "physics/physics_cpp.h"
#include "random.h"

namespace nepho::test {
namespace {

using std::numbers::pi;
constexpr double kRadius_m = 6378137;

// One cell of a shell, its eight corner values, and a ray inside it.
struct CurvedCell {
  const ShellChart& chart;
  Index3 cells;
  RootPosition corner;
  std::array<double, 8> value;

  glm::dvec3 local(glm::dvec3 ecef) const {
    const glm::dvec3 q = chart.coordinates(corner.root, ecef) - corner.q;
    return {q.x * cells[0], q.y * cells[1], q.z * cells[2]};
  }
  bool inside(glm::dvec3 ecef) const {
    const glm::dvec3 c = local(ecef);
    return std::min({c.x, c.y, c.z}) >= 0 && std::max({c.x, c.y, c.z}) <= 1;
  }
  double at(glm::dvec3 ecef) const {
    const glm::dvec3 c = local(ecef);
    double sum = 0;
    for (std::size_t v = 0; v < 8; ++v)
      sum += value[v] * (v & 1 ? c.x : 1 - c.x) * (v & 2 ? c.y : 1 - c.y) * (v & 4 ? c.z : 1 - c.z);
    return sum;
  }
  double leave(glm::dvec3 from, glm::dvec3 direction, double step_m) const {
    double in = 0, out = step_m;
    while (inside(from + out * direction)) in = out, out += step_m;
    for (int halving = 0; halving < 45; ++halving) {
      const double middle = 0.5 * (in + out);
      (inside(from + middle * direction) ? in : out) = middle;
    }
    return in;
  }
};

struct Segment {
  glm::dvec3 from, direction;
  double length_m;
};
double simpson(const CurvedCell& cell, const Segment& ray, int count) {
  const auto at = [&](double s) { return cell.at(ray.from + s * ray.length_m * ray.direction); };
  double sum = 0;
  for (int step = 0; step < count; ++step)
    sum += at(double(step) / count) + 4 * at((step + 0.5) / count) + at((step + 1.0) / count);
  return sum * ray.length_m / (6 * count);
}

enum Kind { kAny, kGrazing, kDiagonal, kKinds };

Segment random_segment(Random& random, const CurvedCell& cell, Kind kind) {
  const auto point = [&](double x, double y, double z) {
    const glm::dvec3 q = {x / cell.cells[0], y / cell.cells[1], z / cell.cells[2]};
    return cell.chart.ecef_m({cell.corner.root, cell.corner.q + q});
  };
  const auto any = [&] { return random.uniform(0, 1); };
  glm::dvec3 from = point(any(), any(), any()), d = random.direction();
  double step_m = 0.02 * std::min(pi / 2 * kRadius_m / cell.cells[0], cell.chart.thickness_m() / 8);
  if (kind == kGrazing) {
    const glm::dvec3 up = 1 / length(from) * from;
    d = d - (dot(d, up) + random.uniform(-1e-3, 1e-3)) * up;
  } else if (kind == kDiagonal) {
    from = point(0.01 * any(), 0.01 * any(), any());
    d = point(1 - 0.01 * any(), 1 - 0.01 * any(), any()) - from;
  }
  d = 1 / length(d) * d;
  if (kind != kAny) step_m = std::max(step_m, pi / 2 * kRadius_m / cell.cells[0] / 500);
  const double back_m = cell.leave(from, -d, step_m);
  return {from - back_m * d, d, back_m + cell.leave(from, d, step_m)};
}

TEST(Simpson, SubStepsBoundTheErrorInCurvedCells) {
  Random random;
  double worst = 0, once = 0, per_sagitta = 0, by_milli = 0, steps = 0;
  int most_steps = 0, rays = 0;
  for (const double height_m : {25.0, 100.0, 400.0, 1700.0, 12000.0})
    for (int split = 0; split <= 12; ++split)
      for (int trial = 0; trial < 900; ++trial) {
        const std::uint32_t n = 8u << split;
        const ShellChart chart(Ellipsoid::wgs84(), 0, 8 * height_m);
        CurvedCell cell{chart, {n, n, 8}, {random.integer(0, 5), {}}, {}};
        cell.corner.q = {random.integer(0, int(n) - 1) / double(n),
                         random.integer(0, int(n) - 1) / double(n), random.integer(0, 7) / 8.0};
        // One full corner is the hardest: the product of all three coordinates, mean 1/8.
        if (trial % 2)
          cell.value[std::size_t(random.integer(0, 7))] = 1;
        else
          for (double& value : cell.value) value = random.uniform(0, 1);
        double mean = 0;
        for (const double value : cell.value) mean += value / 8;
        const Segment ray = random_segment(random, cell, Kind(trial / 2 % kKinds));
        if (ray.length_m < 1e-3 * height_m) continue;
        const double truth = simpson(cell, ray, 100);
        const auto error = [&](int count) {
          return std::abs(simpson(cell, ray, count) - truth) / (mean * ray.length_m);
        };
        const int count =
            f32::simpson_steps(float(ray.length_m), float(kRadius_m), float(height_m));
        const double s = ray.length_m * ray.length_m / (8 * kRadius_m * height_m);
        worst = std::max(worst, error(count));
        once = std::max(once, error(1));
        if (s > 1e-3) per_sagitta = std::max(per_sagitta, error(1) / s);
        by_milli = std::max(by_milli, error(std::max(1, int(std::ceil(std::pow(s / 1e-3, 0.25))))));
        most_steps = std::max(most_steps, count);
        steps += count;
        ++rays;
      }
  std::printf(
      "measured: Simpson, %d rays: worst %.2e of mean x length (s / 1e-3: %.2e; one step: %.1e"
      " = %.3f s), steps: mean %.2f, most %d\n",
      rays, worst, by_milli, once, per_sagitta, steps / rays, most_steps);
  report_accuracy("shell", "Simpson by the sub-step rule, of mean x length", worst, 2e-4, "1");
  report_accuracy("shell", "Simpson sub-steps, most", most_steps, 7, "1");
  EXPECT_LE(worst, 2e-4);
  EXPECT_GT(once, 1e-2);
  EXPECT_GT(by_milli, 2e-4);
  EXPECT_LE(most_steps, 7);
}

}  // namespace
}  // namespace nepho::test
