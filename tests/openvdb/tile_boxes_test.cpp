// Large tiles in closed form against the filter of lattice.md, applied sample by sample.

#include "tile_boxes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bricks/box_chart.h"
#include "dense_levels.h"

namespace nepho::vdb {
namespace {

using test::DenseLevel;

const BoxChart kChart(glm::dvec3(0.0), glm::dmat3({64, 3, 0}, {0, 64, 0}, {0, 5, 64}));
const Lattice kLattice({kSplitXyz, kSplitXyz, kSplitXyz});

// Inside, off the 8-lattice, one voxel wide, touching one another and reaching near the ends.
const std::vector<TileBox> kBoxes = {{{8, 8, 8}, {39, 23, 15}, 0.5},
                                     {{40, 8, 8}, {47, 23, 15}, 0.25},
                                     {{1, 30, 40}, {62, 62, 62}, 0.125},
                                     {{13, 27, 3}, {13, 27, 3}, 1}};

double field(const std::vector<TileBox>& boxes, const Index3& g) {
  for (const TileBox& box : boxes) {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a)
      inside = inside && std::int64_t(g[a]) >= box.low[a] && std::int64_t(g[a]) <= box.high[a];
    if (inside) return box.value;
  }
  return 0;
}

// Dense levels of field(g)^power.
std::vector<DenseLevel> dense_levels(const std::vector<TileBox>& boxes, int power) {
  std::vector<DenseLevel> levels;
  for (int level = 0; level <= kLattice.max_level(); ++level)
    levels.emplace_back(kChart, kLattice, level);
  test::for_each_sample(kChart, levels.back().cells(), [&](Column c, std::uint32_t k) {
    levels.back().at(c, k) = std::pow(field(boxes, {c.i, c.j, k}), power);
  });
  for (int level = kLattice.max_level() - 1; level >= 0; --level)
    test::for_each_node(kChart, kLattice, level, [&](NodeKey key) {
      const BrickSamples brick =
          coarsen_node(kChart, kLattice, key, levels[std::size_t(level) + 1]);
      test::for_each_brick_sample(key, [&](std::size_t at, Column c, std::uint32_t k) {
        levels[std::size_t(level)].at(c, k) = brick[at];
      });
    });
  return levels;
}

TEST(TileBoxes, EqualTheFilterOnAllLevels) {
  const TileBoxes tiles(kLattice, kBoxes);
  const auto dense = dense_levels(kBoxes, 1);
  double worst = 0;
  std::size_t not_empty = 0, constant = 0;
  for (int level = 0; level <= kLattice.max_level(); ++level)
    test::for_each_node(kChart, kLattice, level, [&](NodeKey key) {
      const BrickSamples truth = test::brick_of(dense[std::size_t(level)], key);
      BrickSamples found{};
      tiles.add_samples(key, found.data());
      double most = 0;
      for (std::size_t at = 0; at < found.size(); ++at) {
        worst = std::max(worst, std::abs(found[at] - truth[at]));
        most = std::max(most, truth[at]);
      }
      EXPECT_EQ(tiles.touches(key), most > 0);
      not_empty += most > 0;
      if (const TileBox* box = tiles.covering(key)) {
        ++constant;
        for (const double value : truth) EXPECT_NEAR(value, box->value, 1e-15);
      }
    });
  std::printf("measured: closed form against filter %.1e; %zu nodes, %zu of them constant\n", worst,
              not_empty, constant);
  EXPECT_LE(worst, 1e-15);
  EXPECT_GE(constant, 10u);
}

TEST(TileBoxes, SummariesHold) {
  const TileBoxes tiles(kLattice, kBoxes);
  const auto mean = dense_levels(kBoxes, 1), square = dense_levels(kBoxes, 2);
  double worst = 0;
  for (int level = 0; level <= kLattice.max_level(); ++level)
    test::for_each_node(kChart, kLattice, level, [&](NodeKey key) {
      const BrickSamples none{};
      const NodeSummary s = tiles.summary(key, NodeSummary{}, none.data());
      const BrickSamples c = test::brick_of(mean[std::size_t(level)], key);
      const BrickSamples c2 = test::brick_of(square[std::size_t(level)], key);
      double variance = 0, total = 0;
      for (std::uint32_t at = 0; at < kBrickVolume; ++at) {
        const auto half = [](std::uint32_t g) { return g % 8 ? 1.0 : 0.5; };
        const double weight = half(at % 9) * half(at / 9 % 9) * half(at / 81);
        variance += weight * (c2[at] - c[at] * c[at]);
        total += weight;
        EXPECT_LE(c[at], double(s.max_extinction_per_m));
        EXPECT_GE(c[at], double(s.min_extinction_per_m));
      }
      worst = std::max(worst, std::abs(variance / total - s.unresolved_variance_per_m2));
    });
  std::printf("measured: unresolved variance of boxes off by %.1e 1/m2\n", worst);
  EXPECT_LE(worst, 1e-12);
}

TEST(TileBoxes, EqualNeighboursBecomeOne) {
  std::vector<TileBox> cube;
  for (std::int64_t corner = 0; corner < 8; ++corner) {
    const std::int64_t x = 8 + 16 * (corner & 1), y = 8 + 16 * (corner >> 1 & 1),
                       z = 8 + 16 * (corner >> 2);
    cube.push_back({{x, y, z}, {x + 15, y + 15, z + 15}, 0.5});
  }
  EXPECT_EQ(TileBoxes(kLattice, cube).size(), 1u);
  cube[3].value = 0.25;
  EXPECT_GT(TileBoxes(kLattice, cube).size(), 1u);
  EXPECT_EQ(TileBoxes(kLattice, cube).value({30, 30, 20}), 0.25);
  EXPECT_EQ(TileBoxes(kLattice, cube).value({30, 30, 30}), 0.5);
  EXPECT_EQ(TileBoxes(kLattice, cube).value({7, 30, 30}), 0);
}

}  // namespace
}  // namespace nepho::vdb
