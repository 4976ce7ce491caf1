// What 8-bit texture weights cost: trilinear filtering of real GPUs rounds the position between two
// texels to 1/256 (llvmpipe does not), so the bound of `filter` is tested by emulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "accuracy_report.h"
#include "physics/physics_cpp.h"
#include "random.h"

namespace nepho::test {
namespace {

using Corners = std::array<double, 8>;

double trilinear(const Corners& corner, glm::dvec3 at) {
  double sum = 0;
  for (std::size_t v = 0; v < 8; ++v)
    sum += corner[v] * (v & 1 ? at.x : 1 - at.x) * (v & 2 ? at.y : 1 - at.y) *
           (v & 4 ? at.z : 1 - at.z);
  return sum;
}
double filtered(const Corners& corner, glm::dvec3 at) {
  return trilinear(corner, glm::round(256.0 * at) / 256.0);
}

// Half a step of 1/256 on each of three axes.
constexpr double kThreeAxes = 3 / 512.0;

enum Kind { kRandomCorners, kOneCorner, kKinds };
Corners draw_corners(Random& random, int kind) {
  Corners corner{};
  if (kind == kOneCorner)
    corner[std::size_t(random.integer(0, 7))] = 1;
  else
    for (double& value : corner) value = random.uniform(0, 1);
  return corner;
}
glm::dvec3 draw_point(Random& random) {
  return {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
}

struct Spread {
  double sum = 0, worst = 0;
  int count = 0;
  void add(double error) {
    sum += error * error;
    worst = std::max(worst, std::abs(error));
    ++count;
  }
  double rms() const { return std::sqrt(sum / count); }
};

TEST(FilterWeights, OneLookUp) {
  Random random;
  Spread random_corners, one_corner;
  for (int trial = 0; trial < 400000; ++trial) {
    const int kind = trial % kKinds;
    const Corners corner = draw_corners(random, kind);
    const auto [low, high] = std::minmax_element(corner.begin(), corner.end());
    const glm::dvec3 at = draw_point(random);
    (kind == kOneCorner ? one_corner : random_corners)
        .add((filtered(corner, at) - trilinear(corner, at)) / (*high - *low));
  }
  const char* section = "fetch filter (8-bit weights)";
  report_accuracy(section, "one look-up, rms, of the corners' range", random_corners.rms(), 1e-3,
                  "1");
  report_accuracy(section, "one look-up, largest, random corners, of their range",
                  random_corners.worst, kThreeAxes, "1");
  report_accuracy(section, "one look-up, largest, one full corner", one_corner.worst, kThreeAxes,
                  "1");
  EXPECT_LE(random_corners.rms(), 1e-3);
  EXPECT_LE(random_corners.worst, kThreeAxes);
  EXPECT_LE(one_corner.worst, kThreeAxes);
  EXPECT_GT(one_corner.worst, 2e-3);  // the emulation does something
}

// Where a ray from outside enters and leaves the unit cell.
std::pair<glm::dvec3, glm::dvec3> draw_crossing(Random& random) {
  const glm::dvec3 inside = draw_point(random), d = random.direction();
  double in = -1e9, out = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = -inside[axis] / d[axis], b = (1 - inside[axis]) / d[axis];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return {inside + in * d, inside + out * d};
}

TEST(FilterWeights, OpticalDepthOfACell) {
  Random random;
  Spread cells;
  for (int trial = 0; trial < 400000; ++trial) {
    const Corners corner = draw_corners(random, kRandomCorners);
    const auto [a, b] = draw_crossing(random);
    const glm::dvec3 middle = 0.5 * (a + b);
    double mean = 0;
    for (const double value : corner) mean += value / 8;
    const double exact = f64::simpson_optical_depth(trilinear(corner, a), trilinear(corner, middle),
                                                    trilinear(corner, b), 1);
    const double got = f64::simpson_optical_depth(filtered(corner, a), filtered(corner, middle),
                                                  filtered(corner, b), 1);
    cells.add((got - exact) / mean);
  }
  const char* section = "fetch filter (8-bit weights)";
  report_accuracy(section, "optical depth of a cell, rms, of its mean", cells.rms(), 1e-3, "1");
  report_accuracy(section, "optical depth of a cell, largest, of its mean", cells.worst, 1e-2, "1");
  EXPECT_LE(cells.rms(), 1e-3);
  EXPECT_LE(cells.worst, 1e-2);
}

}  // namespace
}  // namespace nepho::test
