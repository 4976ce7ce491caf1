// The closure of lattice.md 2: a level is the expectation of the filtered next one.

#include <gtest/gtest.h>

#include "accuracy_report.h"
#include "open_noise.h"

namespace nepho::test {
namespace {

constexpr int kLevels = 6;
constexpr int kNodes = 1000;

struct Sums {
  double own = 0, filtered = 0;
};

// Adds the samples inside a node, whose stencils reach over its own children only.
void add_node(const BrickSource& source, NodeKey key, Sums& sums) {
  const VolumeInfo& info = source.info();
  const BrickSamples own = read_noise(source, key);
  const SplitMask mask = info.lattice.split_axes(key.level());
  const Index3 first = Lattice::global_sample(key, {0, 0, 0});
  std::array<BrickSamples, 8> children;
  for (const NodeKey child : info.lattice.children(key))
    children[(child.i() & 1) + 2 * (child.j() & 1) + (splits(mask, 2) ? 4 * (child.k() & 1) : 0)] =
        read_noise(source, child);
  const std::uint32_t up = splits(mask, 2) ? 2 : 1;
  const auto fine = [&](const Column& column, std::uint32_t k) {
    const std::uint32_t i = column.i - 2 * first[0], j = column.j - 2 * first[1],
                        h = k - up * first[2];
    const std::uint32_t top = up == 2 ? h / 8 : 0;
    return children[i / 8 + 2 * (j / 8) + 4 * top][brick_offset(i % 8, j % 8, h - 8 * top)];
  };
  for (std::uint32_t k = 1; k < kBrickCells; ++k) {
    const LayerStencil layers = layer_stencil(*info.chart, info.lattice, key.level(), first[2] + k);
    for (std::uint32_t j = 1; j < kBrickCells; ++j)
      for (std::uint32_t i = 1; i < kBrickCells; ++i) {
        const ColumnStencil columns = column_stencil(*info.chart, info.lattice, key.level(),
                                                     {key.root(), first[0] + i, first[1] + j});
        sums.own += own[brick_offset(i, j, k)];
        sums.filtered += weighted_mean(columns, layers, fine);
      }
  }
}

class Closure : public testing::TestWithParam<std::string> {};

TEST_P(Closure, MeanIsThatOfTheFilteredNextLevel) {
  const auto source = open_noise(one_layer(GetParam()));
  const VolumeInfo& info = source->info();
  double worst = 0;
  for (int level = info.lattice.max_level() - 1; level >= info.lattice.max_level() - kLevels;
       --level) {
    Random random;
    Sums sums;
    int nodes = 0;
    while (nodes < kNodes) {
      const NodeKey key = draw_node(info, level, random);
      if (summary_noise(*source, key).empty) continue;
      add_node(*source, key, sums), ++nodes;
    }
    const double off = sums.own / sums.filtered - 1;
    std::printf("measured: %s, level %d: %+.4f over %d nodes\n", GetParam().c_str(), level, off,
                nodes);
    worst = std::max(worst, std::abs(off));
  }
  report_accuracy("procedural sky", GetParam() + ": mean of a level off the filtered next one",
                  worst, 0.01, "1");
  EXPECT_LE(worst, 0.01);
}
INSTANTIATE_TEST_SUITE_P(Types, Closure, testing::ValuesIn(layer_types()),
                         [](const auto& type) { return type.param; });

}  // namespace
}  // namespace nepho::test
