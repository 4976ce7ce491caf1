// The truth scenes are what they say: optical depths, integrated over what is read, against closed
// forms; walls where they are named; costs that follow what varies.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "scenes.h"

namespace nepho::test {
namespace {

SourceParameter word(const std::string& name, const std::string& text) {
  SourceParameter p;
  p.name = name, p.text = text, p.is_text = true;
  return p;
}
SourceParameter number(const std::string& name, double value) {
  SourceParameter p;
  p.name = name, p.number = value;
  return p;
}
std::unique_ptr<BrickSource> open(const std::vector<SourceParameter>& parameters) {
  VolumeSpec volume;
  volume.name = "v";
  volume.source = "analytic";
  volume.parameters = parameters;
  return open_scene(volume);
}

// Trapezoid over the finest samples of column (i, j) of root 0, times `height_m`: the optical depth
// of the trilinear field along that vertical.
double column_depth(const BrickSource& source, std::uint32_t i, std::uint32_t j, double height_m) {
  const Lattice& lattice = source.info().lattice;
  const int level = lattice.max_level();
  const Index3& n = lattice.cells(level);
  const auto node = [](std::uint32_t g, std::uint32_t cells) {
    return std::min(g, cells - 1) / kBrickCells;
  };
  const std::uint32_t a = node(i, n[0]), b = node(j, n[1]);
  double sum = 0;
  for (std::uint32_t c = 0; c < n[2] / kBrickCells; ++c) {
    const DecodedBrick brick = read_decoded(source, NodeKey(0, level, a, b, c));
    for (std::uint32_t k = 0; k < kBrickSamples; ++k)
      sum += (k == 0 || k == kBrickCells ? 0.5 : 1.0) *
             brick.value[i - 8 * a + 9 * (j - 8 * b + 9 * k)];
  }
  return sum / n[2] * height_m;
}
double middle_depth(const BrickSource& source) {
  const Index3& n = source.info().lattice.cells(source.info().lattice.max_level());
  const auto* box = dynamic_cast<const BoxChart*>(source.info().chart.get());
  return column_depth(source, n[0] / 2, n[1] / 2, box->edges_m()[2].z);
}

TEST(Analytic, OpticalDepthIsWhatWasAskedFor) {
  const struct {
    const char* kind;
    std::vector<SourceParameter> more;
    double tolerance;
  } cases[] = {
      {"constant", {number("max_level", 0)}, 1e-6},
      {"slab", {number("size_z_m", 300), number("max_level", 1)}, 1e-6},
      {"cube", {number("max_level", 1)}, 1e-6},
      {"half_space", {number("max_level", 1)}, 1e-6},
      {"exponential", {}, 2e-3},  // the trapezoid's h^2 / 12 at 32 voxels per scale height
      {"sphere", {number("max_level", 4)}, 1e-4},
      {"gaussian", {number("max_level", 4)}, 1e-4},
  };
  for (const auto& c : cases) {
    std::vector<SourceParameter> parameters = c.more;
    parameters.push_back(word("kind", c.kind));
    parameters.push_back(number("optical_depth", 7));
    const auto source = open(parameters);
    const double off = middle_depth(*source) / 7 - 1;
    std::printf("measured: %-12s optical depth off by %.1e\n", c.kind, off);
    EXPECT_LE(std::abs(off), c.tolerance) << c.kind;
  }
}

// Defined in I3RC phase 1: 32 columns over 500 m, 250 m thick, optical depth 2 and 18.
TEST(Analytic, StepCloudIsTheOneOfI3rc) {
  const auto source = open({word("kind", "step_cloud"), number("asymmetry", 0.85)});
  const auto* box = dynamic_cast<const BoxChart*>(source->info().chart.get());
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->periodic().x && box->periodic().y);
  EXPECT_EQ(box->edges_m()[0].x, 500);
  EXPECT_EQ(box->edges_m()[2].z, 250);
  EXPECT_EQ(source->info().phase.kind, PhaseKind::kHenyeyGreenstein);
  EXPECT_EQ(source->info().phase.asymmetry, 0.85);
  const std::uint32_t n = source->info().lattice.cells(source->info().lattice.max_level())[0];
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double depth = column_depth(*source, i, 0, 250);
    const double truth = i % (n / 2) == 0 ? 10 : i < n / 2 ? 2 : 18;
    EXPECT_NEAR(depth, truth, 1e-3) << i;
    sum += depth / n;
  }
  EXPECT_NEAR(sum, 10, 1e-3);  // the ramps at both walls keep the mean
}

TEST(Analytic, ExtinctionInsteadOfDepth) {
  const auto source = open({word("kind", "cube"), number("size_m", 250),
                            number("extinction_per_m", 0.04), number("max_level", 0)});
  EXPECT_NEAR(middle_depth(*source), 10, 1e-5);
  const auto shell = open({word("kind", "slab"), word("chart", "shell"), number("bottom_m", 1000),
                           number("top_m", 1500), number("optical_depth", 5)});
  EXPECT_NEAR(read_decoded(*shell, NodeKey(3, 0, 0, 0, 0)).value[100], 0.01, 1e-8);
}

TEST(Analytic, BallsKeepZerosInsideTheWalls) {
  for (const char* kind : {"sphere", "gaussian"})
    for (const double shear : {0.0, 0.8}) {
      const auto source =
          open({word("kind", kind), number("max_level", 2), number("shear_xz", shear)});
      const Index3& n = source->info().lattice.cells(2);
      double worst = 0;
      std::size_t inside = 0;
      const auto levels = nodes_by_level(*source, 1000);
      ASSERT_EQ(levels.size(), 3u);
      for (const NodeKey key : levels.back()) {
        const DecodedBrick brick = read_decoded(*source, key);
        for (std::uint32_t at = 0; at < kBrickVolume; ++at) {
          const Index3 g = Lattice::global_sample(key, {at % 9, at / 9 % 9, at / 81});
          bool rim = false;
          for (std::size_t a = 0; a < 3; ++a) rim = rim || g[a] <= 1 || g[a] + 1 >= n[a];
          if (rim) worst = std::max(worst, brick.value[at]);
          inside += brick.value[at] > 0;
        }
      }
      EXPECT_EQ(worst, 0) << kind;
      EXPECT_GT(inside, 1000u) << kind;
    }
}

// Volume of extinction: the sphere's rim and lattice leave the sphere's own.
TEST(Analytic, SphereHoldsItsExtinction) {
  const auto source = open({word("kind", "sphere"), number("radius_m", 300),
                            number("extinction_per_m", 0.01), number("max_level", 3)});
  const auto* box = dynamic_cast<const BoxChart*>(source->info().chart.get());
  const Index3& n = source->info().lattice.cells(3);
  double sum = 0;
  const auto levels = nodes_by_level(*source, 1000);
  ASSERT_EQ(levels.size(), 4u);
  for (const NodeKey key : levels.back()) {
    const DecodedBrick brick = read_decoded(*source, key);
    for (std::uint32_t at = 0; at < kBrickVolume; ++at)
      if (at % 9 < 8 && at / 9 % 9 < 8 && at / 81 < 8) sum += brick.value[at];
  }
  const double voxel_m3 = std::pow(box->edges_m()[0].x / n[0], 3);
  const double truth = 0.01 * 4 / 3 * std::numbers::pi * 2.7e7;
  std::printf("measured: sphere of 64 voxels: total extinction off by %.1e\n",
              sum * voxel_m3 / truth - 1);
  EXPECT_NEAR(sum * voxel_m3 / truth, 1, 1e-3);
}

TEST(Analytic, ConstantsCostNothing) {
  const auto start = std::chrono::steady_clock::now();
  for (const char* chart : {"box", "shell"}) {
    const auto source =
        open({word("kind", "constant"), word("chart", chart), number("max_level", 16)});
    EXPECT_LE(source->info().source_bytes, 10000u);
    const NodeSummary summary = summary_of(*source, NodeKey(0, 16, 5, 65535, 7));
    EXPECT_TRUE(summary.constant);
    EXPECT_EQ(summary_of(*source, NodeKey(0, 0, 0, 0, 0)).error_bound_per_m, 0);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LE(taken.count(), 1);
}

TEST(Analytic, BuildsInTimeAndSaysItsBytes) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const auto source = open({word("kind", "gaussian")});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const double cpu_s = double(std::clock() - cpu) / CLOCKS_PER_SEC;
  const double samples = 0.52 * std::pow(256, 3);
  std::printf(
      "measured: gaussian of 256^3: %.2f s (CPU %.2f s, %.0f ns per varying sample), %.1f MB\n",
      taken.count(), cpu_s, cpu_s / samples * 1e9, double(source->info().source_bytes) * 1e-6);
  EXPECT_LE(cpu_s / samples, 1e-6);
}

}  // namespace
}  // namespace nepho::test
