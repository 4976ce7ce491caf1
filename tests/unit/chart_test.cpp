#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>

#include "accuracy_report.h"
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "frames.h"

namespace nepho {
namespace {

using std::numbers::pi;

const ShellChart kEarth(Ellipsoid::wgs84(), -500, 24000);
const BoxChart kBox(geodetic_to_ecef_m(Ellipsoid::wgs84(), 0.9, 0.2, 500),
                    test::scaled_columns(test::east_north_up(0.9, 0.2), {6400, 6400, 3200}),
                    {.x = true, .y = true});

TEST(ShellChart, EquiangularIsOddAndExact) {
  EXPECT_EQ(equiangular(-1), -1);
  EXPECT_EQ(equiangular(0), 0);
  EXPECT_EQ(equiangular(1), 1);
  for (int i = 1; i < 1024; ++i) {
    EXPECT_EQ(equiangular(i / 1024.0), -equiangular(-i / 1024.0));
    EXPECT_LT(equiangular((i - 1) / 1024.0), equiangular(i / 1024.0));
  }
}

TEST(ShellChart, TwelveEdgesAndEightCornersAreOneSampleBitForBit) {
  const Lattice lattice({kSplitXy, kSplitXyz});
  const Index3 n = lattice.cells(2);
  std::map<Column, int> shared;
  for (int root = 0; root < 6; ++root)
    for (std::uint32_t i = 0; i <= n[0]; ++i)
      for (std::uint32_t j = 0; j <= n[1]; ++j) {
        const ColumnNames names = kEarth.names({root, i, j}, n);
        const Column owner = names.owner();
        if (names.size() > 1) shared[owner] = names.size();
        bool has_self = false;
        for (const Column name : names) {
          has_self |= name == Column{root, i, j};
          EXPECT_EQ(kEarth.names(name, n).owner(), owner);
          // By each name's own root, not through the owner.
          EXPECT_EQ(kEarth.ecef_m({name.root, lattice.q(2, {name.i, name.j, 5})}),
                    kEarth.ecef_m({owner.root, lattice.q(2, {owner.i, owner.j, 5})}));
        }
        EXPECT_TRUE(has_self);
        EXPECT_EQ(kEarth.locate(kEarth.ecef_m({root, lattice.q(2, {i, j, 3})})).root, owner.root);
      }
  int edges = 0, corners = 0;
  for (const auto& [owner, count] : shared) ++(count == 3 ? corners : edges);
  EXPECT_EQ(corners, 8);
  EXPECT_EQ(edges, 12 * int(n[0] - 1));
}

TEST(ShellChart, RefusesLatticeWhoseFacesDoNotMeet) {
  EXPECT_NO_THROW(kEarth.check(Lattice({kSplitXy, kSplitXyz, kSplitZ})));
  EXPECT_THROW(kEarth.check(Lattice({SplitMask{0b001}, SplitMask{0b010}})), std::invalid_argument);
}

TEST(Charts, HatsFillTheWorld) {
  const Ellipsoid wgs84 = Ellipsoid::wgs84();
  const auto cube = [](double x) { return x * x * x; };
  const double shell_m3 = 4 * pi / 3 * (wgs84.polar_m / wgs84.equatorial_m) *
                          (cube(wgs84.equatorial_m + 24000) - cube(wgs84.equatorial_m - 500));
  const auto hats_m3 = [](const Chart& chart, Index3 n) {
    double horizontal = 0, vertical = 0;
    for (int root = 0; root < chart.roots(); ++root)
      for (std::uint32_t i = 0; i <= n[0]; ++i)
        for (std::uint32_t j = 0; j <= n[1]; ++j)
          horizontal += chart.hat_horizontal({root, i, j}, n);
    for (std::uint32_t k = 0; k <= n[2]; ++k) vertical += chart.hat_vertical(k, n);
    return horizontal * vertical;
  };
  for (const std::uint32_t n : {8u, 16u, 64u}) {
    EXPECT_NEAR(hats_m3(kEarth, {n, n, n}) / shell_m3, 1, 1e-12);
    EXPECT_NEAR(hats_m3(kBox, {n, n, n}) / (6400.0 * 6400 * 3200), 1, 1e-12);
  }
}

// A hat is the sum of the finer ones under it: fewer points on finer lattices change no digit.
TEST(ShellChart, HatsAgreeAcrossQuadratures) {
  double worst = 0;
  for (const std::uint32_t n : {128u, 2048u})
    for (std::uint32_t i = 1; i < n; i += n / 16 - 1)
      for (std::uint32_t j = 1; j < n; j += n / 16 - 1) {
        double fine = 0;
        for (std::uint32_t at = 0; at < 9; ++at) {
          const Column column = {2, 2 * i + at % 3 - 1, 2 * j + at / 3 - 1};
          const double weight = (at % 3 == 1 ? 1 : 0.5) * (at / 3 == 1 ? 1 : 0.5);
          fine += weight * kEarth.hat_horizontal(column, {2 * n, 2 * n, 8});
        }
        worst = std::max(worst, std::abs(fine / kEarth.hat_horizontal({2, i, j}, {n, n, 8}) - 1));
      }
  test::report_accuracy("charts", "solid angle of hats across quadrature rules", worst, 1e-13, "1");
  EXPECT_LE(worst, 1e-13);
}

TEST(ShellChart, GeodeticHeightClosedForm) {
  const Ellipsoid wgs84 = Ellipsoid::wgs84();
  for (const auto& [height_m, bound_m] :
       {std::pair{-500.0, 5e-7}, {0.0, 5e-9}, {10e3, 2.1e-4}, {100e3, 0.018}, {400e3, 0.28}}) {
    double worst_m = 0;
    for (int i = -90; i <= 90; ++i) {
      const glm::dvec3 p = geodetic_to_ecef_m(wgs84, i * pi / 180, 0.3, height_m);
      worst_m = std::max(worst_m, std::abs(geodetic_height_m(wgs84, p) - height_m));
    }
    test::report_accuracy("charts", "geodetic_height_m at " + std::to_string(int(height_m)) + " m",
                          worst_m, bound_m, "m");
    EXPECT_LE(worst_m, bound_m);
  }
  EXPECT_NEAR(geodetic_height_m(Ellipsoid::sphere(6.37e6), {0, 0, 6.37e6 + 1234}), 1234, 2e-9);
}

// Worst distance, in units of max(1e-9 node, 5 nm), between a sample and the position found for it.
double worst_round_trip(const Chart& chart, const Lattice& lattice, double root_m, double high_m) {
  std::mt19937 random(2);
  const auto below = [&](std::uint32_t end) { return std::uint32_t(random() % end); };
  double worst = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const int level = int(below(std::uint32_t(lattice.max_level()) + 1));
    const Index3 nodes = lattice.nodes(level);
    const NodeKey key(int(below(std::uint32_t(chart.roots()))), level, below(nodes[0]),
                      below(nodes[1]), below(nodes[2]));
    const Index3 g = Lattice::global_sample(key, {1 + below(7), 1 + below(7), below(9)});
    const glm::dvec3 q = lattice.q(level, g);
    const RootPosition found = chart.locate(chart.ecef_m({key.root(), q}));
    EXPECT_EQ(found.root, key.root());
    const NodeKey again = lattice.node_at(found.root, found.q, level);
    EXPECT_EQ(again.i(), key.i());
    EXPECT_EQ(again.j(), key.j());
    const double width_m = root_m / nodes[0], height_m = high_m / nodes[2];
    const auto miss = [&](double dq, double extent_m, double node_m) {
      return std::abs(dq) * extent_m / std::max(1e-9 * node_m, 5e-9);
    };
    worst =
        std::max({worst, miss(found.q.x - q.x, root_m, width_m),
                  miss(found.q.y - q.y, root_m, width_m), miss(found.q.z - q.z, high_m, height_m)});
  }
  return worst;
}

TEST(Charts, KeyToPositionAndBack) {
  std::vector<SplitMask> masks(12, kSplitXy);
  masks.insert(masks.end(), 8, kSplitXyz);
  const double shell =
      worst_round_trip(kEarth, Lattice(masks), pi / 2 * 6378137.0, kEarth.thickness_m());
  const double box =
      worst_round_trip(kBox, Lattice(std::vector<SplitMask>(10, kSplitXyz)), 6400, 3200);
  test::report_accuracy("charts", "ecef_m/locate round trip / max(1e-9 node, 5 nm): shell", shell,
                        1, "1");
  test::report_accuracy("charts", "ecef_m/locate round trip / max(1e-9 node, 5 nm): box", box, 1,
                        "1");
  EXPECT_LE(shell, 1);
  EXPECT_LE(box, 1);
}

TEST(BoxChart, PeriodicEndsAreOneSample) {
  const Index3 n = {16, 16, 8};
  EXPECT_EQ(kBox.names({0, 16, 16}, n).size(), 4);
  EXPECT_EQ(kBox.names({0, 16, 16}, n).owner(), (Column{0, 0, 0}));
  EXPECT_EQ(kBox.names({0, 3, 16}, n).owner(), (Column{0, 3, 0}));
  EXPECT_EQ(kBox.names({0, 3, 5}, n).size(), 1);
  const Lattice lattice({kSplitXy});
  EXPECT_EQ(sample_ecef_m(kBox, lattice, 0, 1, {16, 4, 2}),
            sample_ecef_m(kBox, lattice, 0, 1, {0, 4, 2}));
  const RootPosition wrapped = kBox.locate(kBox.ecef_m({0, {1.25, -0.25, 0.5}}));
  EXPECT_NEAR(wrapped.q.x, 0.25, 1e-12);
  EXPECT_NEAR(wrapped.q.y, 0.75, 1e-12);
}

// Affine frames: the map is linear, so q is found by Cramer's rule in long double.
struct Frame {
  const char* name;
  glm::dvec3 origin_m;
  glm::dmat3 edges_m;
};
std::vector<Frame> frames() {
  const glm::dvec3 earth = geodetic_to_ecef_m(Ellipsoid::wgs84(), 0.9, 0.2, 500);
  const glm::dmat3 enu = test::east_north_up(0.9, 0.2);
  const glm::dmat3 box = test::scaled_columns(enu, {6400, 3200, 1600});
  return {{"free", {0, 0, 0}, test::scaled_columns(glm::dmat3(1.0), {409.6, 409.6, 409.6})},
          {"rotated", earth, box},
          {"left-handed", earth, {box[1], box[0], box[2]}},
          {"mirrored", earth, {-box[0], box[1], box[2]}},
          {"sheared", earth, {box[0], box[1] + 0.7 * box[0], box[2] - 0.4 * box[0] + box[1]}},
          {"thin", earth, test::scaled_columns(enu, {64000, 64000, 1})}};
}

TEST(BoxChart, AnyAffineFrameGoesThereAndBack) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  for (const Frame& frame : frames()) {
    const BoxChart chart(frame.origin_m, frame.edges_m);
    double forward_m = 0, back_m = 0;
    for (int trial = 0; trial < 20000; ++trial) {
      const glm::dvec3 q = {uniform(random), uniform(random), uniform(random)};
      const glm::dvec3 p = chart.ecef_m({0, q});
      long double off = 0;
      for (int c = 0; c < 3; ++c) {
        long double truth = frame.origin_m[c];
        for (int e = 0; e < 3; ++e)
          truth += static_cast<long double>(q[e]) * static_cast<long double>(frame.edges_m[e][c]);
        off = std::hypot(off, static_cast<long double>(p[c]) - truth);
      }
      forward_m = std::max(forward_m, double(off));
      const RootPosition found = chart.locate(p);
      EXPECT_EQ(found.root, 0);
      back_m = std::max(back_m, glm::length(chart.ecef_m(found) - p));
    }
    const std::string of = std::string(": ") + frame.name;
    test::report_accuracy("charts", "box ecef_m against long double" + of, forward_m, 5e-9, "m");
    test::report_accuracy("charts", "box ecef_m(locate(p)) - p" + of, back_m, 5e-9, "m");
    EXPECT_LE(forward_m, 5e-9);
    EXPECT_LE(back_m, 5e-9);
  }
}

TEST(BoxChart, HatsFillAnyFrame) {
  for (const Frame& frame : frames()) {
    const BoxChart chart(frame.origin_m, frame.edges_m);
    const double volume_m3 = std::abs(glm::determinant(frame.edges_m));
    double horizontal = 0, vertical = 0;
    for (std::uint32_t i = 0; i <= 16; ++i)
      for (std::uint32_t j = 0; j <= 8; ++j)
        horizontal += chart.hat_horizontal({0, i, j}, {16, 8, 32});
    for (std::uint32_t k = 0; k <= 32; ++k) vertical += chart.hat_vertical(k, {16, 8, 32});
    EXPECT_NEAR(horizontal * vertical / volume_m3, 1, 1e-12) << frame.name;
  }
}

TEST(BoxChart, RefusesWhatSpansNoVolume) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const glm::dmat3 unit(1.0);
  EXPECT_NO_THROW(BoxChart({}, unit));
  EXPECT_NO_THROW(BoxChart({}, 1e-3 * unit));
  EXPECT_NO_THROW(BoxChart({}, test::scaled_columns(unit, {1e6, 1e6, 1e-3})));  // thin, not flat
  for (const glm::dmat3& edges :
       {glm::dmat3(0.0), glm::dmat3{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
        glm::dmat3{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},      // rank 2
        glm::dmat3{{1, 0, 0}, {1, 1e-10, 0}, {0, 0, 1}},  // as good as parallel
        glm::dmat3{{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}}, inf * unit,
        1e150 * unit})  // its volume is not a number that can be had
    EXPECT_THROW(BoxChart({}, edges), std::invalid_argument);
  EXPECT_THROW(BoxChart({nan, 0, 0}, unit), std::invalid_argument);
  EXPECT_THROW(BoxChart({0, -inf, 0}, unit), std::invalid_argument);
  EXPECT_THROW(ShellChart(Ellipsoid::wgs84(), 0, 0), std::invalid_argument);
  EXPECT_THROW(ShellChart(Ellipsoid::wgs84(), 0, nan), std::invalid_argument);
}

TEST(BoxChart, WrapsIntoHalfOpenUnit) {
  const BoxChart chart({}, glm::dmat3(1.0), {.x = true, .y = false});
  for (const double x : {-1e-300, -1e-17, -1.0, 0.0, 1.0, 2.0, 1e15, -1e15}) {
    const RootPosition p = chart.locate({x, x, x});
    EXPECT_GE(p.q.x, 0) << x;
    EXPECT_LT(p.q.x, 1) << x;
    EXPECT_EQ(p.q.y, x);
    EXPECT_EQ(p.q.z, x);
  }
  EXPECT_EQ(chart.names({0, 8, 8}, {8, 8, 8}).size(), 2);
  EXPECT_EQ(chart.names({0, 8, 8}, {8, 8, 8}).owner(), (Column{0, 0, 8}));
}

// Three splits of a periodic root: both ends' hats together are one whole hat.
TEST(BoxChart, PeriodicEndsShareOneHat) {
  const Index3 n = {16, 16, 8};
  double ends = 0;
  for (const Column& name : kBox.names({0, 0, 0}, n)) ends += kBox.hat_horizontal(name, n);
  EXPECT_NEAR(ends / kBox.hat_horizontal({0, 5, 5}, n), 1, 1e-15);
}

}  // namespace
}  // namespace nepho
