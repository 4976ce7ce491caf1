// Stiff cases of transport through cells: each computes its naive form beside the project's.
#include <array>
#include <cmath>
#include <limits>

#include "expect_stable.h"
#include "march_support.h"
#include "physics/physics_cpp.h"
#include "random.h"

namespace nepho::test {
namespace {

constexpr double kSide_m = 1000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A brick of one value at every place, with as many cells as its lattice has: a constant that no
// walk may skip.
class EvenCells final : public LevelSet {
 public:
  EvenCells(Lattice lattice, double extinction_per_m) {
    info_.chart = box(kSide_m, {true, true});
    info_.lattice = std::move(lattice);
    auto brick = std::make_shared<LeafBrick>();
    const std::vector<double> values(kBrickVolume, extinction_per_m);
    const Quantised q = quantise(values, brick->codes);
    brick->scale = q.scale;
    brick->offset = q.offset;
    brick_ = std::move(brick);
  }
  std::size_t size() const override { return 1; }
  const VolumeInfo& info(std::size_t) const override { return info_; }
  LevelLeaf leaf(std::size_t, int root, const Index3& cell) const override {
    LevelLeaf leaf;
    leaf.key = {root, info_.lattice.max_level(), cell[0] / 8, cell[1] / 8, cell[2] / 8};
    leaf.kind = NodeKind::kBrick;
    leaf.brick = brick_;
    return leaf;
  }

 private:
  VolumeInfo info_;
  std::shared_ptr<const LeafBrick> brick_;
};

// The slab as a volume of a request: extinction tau / kSide_m in a single brick.
FieldSource slab_of(double tau) {
  return {box(kSide_m, {true, true}), isotropic(0), [tau](glm::dvec3) { return tau / kSide_m; }};
}

// Part of a white background that is seen through a black slab of `levels` times halved cells.
double seen_through(double tau, int levels) {
  const FieldSource source = slab_of(tau);
  RenderRequest request = request_of({volume_of(source)});
  request.volumes[0].co_albedo = glm::dvec3(1);
  request.sky.zenith_W_per_m2_sr_nm = request.sky.horizon_W_per_m2_sr_nm =
      request.sky.below_W_per_m2_sr_nm = glm::dvec3(1);
  const EvenCells cells(isotropic(levels), tau / kSide_m);
  const RayMarch march(cells, request, {.source_tolerance = 1e9, .least_transmittance = 0});
  return march.trace({{500, 500, 1500}, {0, 0, -1}}).radiance_W_per_m2_sr_nm.g;
}

TEST(Transport, TransmittanceDoesNotDependOnSteps) {
  double worst = 0, naive = 0, last = 1;
  for (const double tau : {1e-3, 0.1, 1.0, 4.0, 8.0, 15.2, 20.0}) {
    const double exact = std::exp(-tau);
    for (const int levels : {0, 1, 2, 3}) {
      const double seen = seen_through(tau, levels);
      const double steps = 8 << levels;
      EXPECT_GE(seen, 0);
      EXPECT_LT(seen, last);
      worst = std::max(worst, std::abs(seen / exact - 1));
      naive = std::max(naive, std::abs(std::pow(1 - tau / steps, steps) / exact - 1));
    }
    last = exact;
  }
  expect_stable("03", worst, 1e-6, naive, "relative");
}

TEST(Transport, ThinStepsAddUp) {
  double worst = 0, naive = 0;
  for (const double tau : {0.004, 2.0}) {
    const EvenCells cells(Lattice(std::vector<SplitMask>(16, kSplitZ)), tau / kSide_m);
    const int steps = 8 << 16;
    const RayMarch march(cells, request_of({}));
    const double found = march.optical_depth({{500, 500, 1500}, {0, 0, -1}});
    worst = std::max(worst, std::abs(found / tau - 1));
    float transmittance = 1;
    for (int step = 0; step < steps; ++step) transmittance *= std::exp(float(-tau / steps));
    naive = std::max(naive, std::abs(-std::log(double(transmittance)) / tau - 1));
  }
  expect_stable("04", worst, 1e-5, naive, "of the optical depth, in 524288 steps");
}

TEST(Transport, LaterOctavesSeeBehindDeepClouds) {
  constexpr int n = 5;
  double worst = 0, naive = 0;
  for (double tau = 1; tau < 8000; tau *= 1.37) {
    const double exact = f64::octave_transmittance(n, tau);
    worst = std::max(worst, std::abs(double(f32::octave_transmittance(n, float(tau))) / exact - 1));
    // Stored as transmittance: gone in float from 104 on, however little of it an octave takes.
    const float stored = std::exp(float(-tau));
    const float of_octave = std::pow(stored, float(f64::octave_extinction(n)));
    naive = std::max(naive, std::abs(double(of_octave) / exact - 1));
  }
  expect_stable("05", worst, 3e-5, naive, "relative");
}

TEST(Transport, CoAlbedoKeepsItsDigits) {
  constexpr double tau = 3;
  const FieldSource source = slab_of(tau);
  const EvenCells cells(isotropic(0), tau / kSide_m);
  const auto radiance = [&](double co_albedo) {
    RenderRequest request = request_of({volume_of(source)});
    request.volumes[0].co_albedo = glm::dvec3(co_albedo);
    request.sun.to_sun = glm::normalize(glm::dvec3(0.3, 0.1, 0.8));
    return RayMarch(cells, request).trace({{500, 500, 1500}, {0, 0, -1}}).radiance_W_per_m2_sr_nm.g;
  };
  const double whole = radiance(0);
  double worst = 0, naive = 0;
  for (double co = 2e-7; co < 1e-6; co *= 1.07) {
    worst = std::max(worst, std::abs((whole - radiance(co)) / whole / co - 1));
    naive = std::max(naive, std::abs(double(1 - float(1 - co)) / co - 1));
  }
  expect_stable("10", worst, 1e-3, naive, "of what is absorbed");
}

// Light per optical depth, from what is hardly there to what is thin; and exactly none of nothing.
TEST(Transport, NoExtinctionIsNoLight) {
  const auto radiance = [](double tau) {
    const FieldSource source = slab_of(tau);
    const RenderRequest request = request_of({volume_of(source)});
    return RayMarch(EvenCells(isotropic(1), tau / kSide_m), request)
        .trace({{500, 500, 1500}, {0, 0, -1}})
        .radiance_W_per_m2_sr_nm.g;
  };
  EXPECT_EQ(radiance(0), 0);
  const double limit = radiance(1e-10) / 1e-10;
  double worst = 0, naive = 0;
  for (const double tau : {0.0, 1e-25, 1e-17, 1e-12, 1e-8}) {
    const double found = tau > 0 ? radiance(tau) / tau / limit - 1 : radiance(tau);
    worst = std::isfinite(found) ? std::max(worst, std::abs(found)) : kInfinity;
    // The source as emission over extinction, the weight as written.
    const float k = float(tau / kSide_m), x = float(tau), emission = k;
    const float light = emission / k * (1 - std::exp(-x));
    const double off = std::abs(double(light) / std::max(tau, 1e-30) - 1);
    naive = std::isfinite(off) ? std::max(naive, off) : kInfinity;
  }
  expect_stable("24", worst, 1e-6, naive, "relative to the thin limit");
}

// A slab's box cut by each axis as is usual, without a word on directions of no length.
float naive_length_m(glm::vec3 origin, glm::vec3 direction) {
  float enter = 0, leave = 1e30f;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / direction[axis];
    const float a = (0 - origin[axis]) * inverse, b = (float(kSide_m) - origin[axis]) * inverse;
    const float low = a < b ? a : b, high = a < b ? b : a;
    enter = enter > low ? enter : low;
    leave = leave < high ? leave : high;
  }
  return leave - enter;
}

TEST(Walk, AlongAxesEdgesAndCorners) {
  constexpr double k_per_m = 0.01;
  const FieldSource source(box(kSide_m), isotropic(2), [](glm::dvec3) { return k_per_m; });
  const FixedLevel levels({&source}, 2);
  const RayMarch march(levels, request_of({}));
  double worst = 0, naive = 0;
  const auto check = [&](glm::dvec3 origin, glm::dvec3 direction, double length_m) {
    const double found = march.optical_depth({origin, direction});
    worst = std::max(worst, std::abs(found / (k_per_m * length_m) - 1));
    const double usual = double(naive_length_m(glm::vec3(origin), glm::vec3(direction)));
    naive = std::isfinite(usual) ? std::max(naive, std::abs(usual / length_m - 1)) : kInfinity;
  };
  for (const double y : {0.0, 125.0, 500.0, 1000.0, 333.0})
    for (const double z : {0.0, 250.0, 1000.0, 77.0})
      for (const double sign : {-1.0, 1.0}) {
        check({500 - 3000 * sign, y, z}, {sign, 0, 0}, kSide_m);
        check({y, 500 - 3000 * sign, z}, {0, sign, 0}, kSide_m);
        check({y, z, 500 - 3000 * sign}, {0, 0, sign}, kSide_m);
      }
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1)),
                   edge = glm::normalize(glm::dvec3(1, 1, 0));
  check(-500.0 * corner, corner, kSide_m * std::sqrt(3.0));
  check({-100, -100, 0}, edge, kSide_m * std::sqrt(2.0));
  expect_stable("40", worst, 1e-6, naive, "of the optical depth");
}

// Extinction at the corners of one cell and a chord through it: a cubic, of which Gauss's four
// points are the integral too.
TEST(Walk, SimpsonIsExactInACell) {
  Random random;
  double worst = 0, naive = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<double, 8> corner{};
    for (double& value : corner) value = random.uniform(0, 1);
    const auto any = [&] { return random.uniform(0, 1); };
    const glm::dvec3 from(any(), any(), any()), to(any(), any(), any());
    const auto at = [&](double s) {
      const glm::dvec3 p = from + s * (to - from);
      double sum = 0;
      for (std::size_t v = 0; v < 8; ++v)
        sum +=
            corner[v] * (v & 1 ? p.x : 1 - p.x) * (v & 2 ? p.y : 1 - p.y) * (v & 4 ? p.z : 1 - p.z);
      return sum;
    };
    const double near = 0.5 * std::sqrt(3 / 7.0 - 2 / 7.0 * std::sqrt(1.2)),
                 far = 0.5 * std::sqrt(3 / 7.0 + 2 / 7.0 * std::sqrt(1.2)),
                 weight = 0.25 + std::sqrt(30.0) / 72;
    const double exact = weight * (at(0.5 - near) + at(0.5 + near)) +
                         (0.5 - weight) * (at(0.5 - far) + at(0.5 + far));
    const double simpson = f64::simpson_optical_depth(at(0), at(0.5), at(1), 1);
    worst = std::max(worst, std::abs(simpson / exact - 1));
    naive = std::max(naive, std::abs(at(0.5) / exact - 1));
  }
  expect_stable("L1", worst, 1e-13, naive, "relative");
}

}  // namespace
}  // namespace nepho::test
