// SparsePyramid, before quantisation, against the dense levels of tests/support, which apply the
// filter of coarsen.h sample by sample to every name of every sample.

#include "pyramid/sparse_pyramid.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "analytic_field.h"
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "dense_levels.h"
#include "pyramid/level_filter.h"

namespace nepho::test {
namespace {

using Field = std::function<double(glm::dvec3)>;

struct Case {
  std::string name;
  const Chart& chart;
  Lattice lattice;
  Field field;
};

const ShellChart kEarth(Ellipsoid::wgs84(), 0, 16000);
const glm::dvec3 kOrigin = geodetic_to_ecef_m(Ellipsoid::wgs84(), 0.5, 0.2, 500);
const glm::dmat3 kEdges = {{6400, 0, 0}, {0, 6400, 0}, {0, 0, 3200}};
const glm::dmat3 kLeaning = {{6400, 300, 0}, {-800, 6400, 100}, {1500, -700, -3200}};
const BoxChart kOpenBox(kOrigin, kEdges);
const BoxChart kLeaningBox(kOrigin, kLeaning);
const BoxChart kPeriodicBox(kOrigin, kEdges, {true, true});
const BoxChart kHalfPeriodicBox(kOrigin, kEdges, {false, true});
const Lattice kShellLattice({kSplitXy, kSplitXy, kSplitXyz, kSplitZ});
const Lattice kBoxLattice({kSplitXy, kSplitXyz, kSplitXyz});
const Lattice kLongLattice({0b001, 0b101, kSplitXyz});

double shell_cloud(glm::dvec3 ecef) {
  const double height_m = length(ecef) - 6.36e6;
  return cloud(16.0 / length(ecef) * ecef + glm::dvec3{0, 0, height_m / 4000});
}
double box_cloud(glm::dvec3 p) {
  return cloud(1 / 300. * p);
}
// One small cloud: most nodes are empty.
double puff(glm::dvec3 p) {
  const glm::dvec3 d = 1 / 250. * (p - kOrigin - glm::dvec3(800, 1600, 800));
  return std::max(0.0, 0.05 * (1 - dot(d, d)));
}
// The same across the periodic ends.
double corner_puff(glm::dvec3 p) {
  glm::dvec3 d = p - kOrigin;
  d = {std::min(d.x, 6400 - d.x), std::min(d.y, 6400 - d.y), d.z - 1200};
  return std::max(0.0, 0.05 - 1e-7 * dot(d, d));
}
// Around the corner of three cube faces.
double shell_corner(glm::dvec3 p) {
  return std::max(0.0, 0.02 * (dot(1 / length(p) * p, glm::dvec3(std::sqrt(1 / 3.))) - 0.97));
}

std::vector<Case> cases() {
  return {{"shell, noise", kEarth, kShellLattice, shell_cloud},
          {"shell, cube corner", kEarth, kShellLattice, shell_corner},
          {"open box, noise", kOpenBox, kBoxLattice, box_cloud},
          {"open box, puff", kOpenBox, kBoxLattice, puff},
          {"leaning box, noise", kLeaningBox, kLongLattice, box_cloud},
          {"periodic box, noise", kPeriodicBox, kBoxLattice, box_cloud},
          {"periodic box, puff", kPeriodicBox, kBoxLattice, corner_puff},
          {"half periodic, noise", kHalfPeriodicBox, kLongLattice, box_cloud}};
}

constexpr auto kMean = [](const auto& columns, const auto& layers, const DenseLevel& fine) {
  return weighted_mean(columns, layers, fine);
};

// A case, its dense levels and its sparse pyramid.
struct Built {
  Built(const Case& c)
      : dense(build_pyramid(c.chart, c.lattice, c.field, kMean)), sparse(make(c, dense)) {}

  static SparsePyramid make(const Case& c, const Pyramid& dense) {
    SparsePyramid::Field field;
    field.samples = [&finest = dense.levels.back()](NodeKey key, double* samples) {
      for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
        samples[at] = finest(column, k);
      });
    };
    for_each_node(c.chart, c.lattice, c.lattice.max_level(), [&](NodeKey key) {
      BrickSamples samples;
      field.samples(key, samples.data());
      if (std::ranges::any_of(samples, [](double v) { return v != 0; })) field.nodes.push_back(key);
    });
    std::ranges::sort(field.nodes);
    return {c.chart, c.lattice, field};
  }
  BrickSamples samples(NodeKey key) const {
    BrickSamples brick;
    sparse.samples(key, brick.data());
    return brick;
  }

  Pyramid dense;
  SparsePyramid sparse;
};

template <class Visit>
void for_each_level(const Case& c, Visit&& visit) {
  for (int level = 0; level <= c.lattice.max_level(); ++level) visit(level);
}

TEST(Pyramid, EqualsTheFilterAppliedSampleBySample) {
  for (const Case& c : cases()) {
    const Built built(c);
    double worst = 0, top = 0;
    for_each_level(c, [&](int level) {
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        const BrickSamples brick = built.samples(key);
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          const double truth = built.dense.levels[std::size_t(level)](column, k);
          worst = std::max(worst, std::abs(brick[at] - truth));
          top = std::max(top, truth);
        });
      });
    });
    std::printf("measured: %-21s pyramid against dense filter %.1e of the maximum\n",
                c.name.c_str(), worst / top);
    EXPECT_GT(top, 0) << c.name;
    EXPECT_LE(worst, 1e-12 * top) << c.name;
  }
}

TEST(Pyramid, SharedSamplesHaveTheSameBits) {
  for (const Case& c : cases()) {
    const Built built(c);
    std::size_t seams = 0, shared = 0;
    for_each_level(c, [&](int level) {
      const Index3& cells = c.lattice.cells(level);
      std::map<std::pair<Column, std::uint32_t>, double> known;
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        const BrickSamples brick = built.samples(key);
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          const auto [place, first] =
              known.try_emplace({c.chart.names(column, cells).owner(), k}, brick[at]);
          shared += !first;
          seams += place->second != brick[at];
        });
      });
    });
    std::printf("measured: %-21s %zu shared samples, %zu seams\n", c.name.c_str(), shared, seams);
    EXPECT_GT(shared, 0u) << c.name;
    EXPECT_EQ(seams, 0u) << c.name;
  }
}

TEST(Pyramid, ConservesEachLevel) {
  for (const Case& c : cases()) {
    const Built built(c);
    double worst = 0, finer = 0;
    for (int level = c.lattice.max_level(); level >= 0; --level) {
      DenseLevel values(c.chart, c.lattice, level);
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        const BrickSamples brick = built.samples(key);
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          values.at(column, k) = brick[at];
        });
      });
      const double sum = total(c.chart, values);
      if (level < c.lattice.max_level()) worst = std::max(worst, std::abs(sum / finer - 1));
      finer = sum;
    }
    std::printf("measured: %-21s drift of sum c V per level %.1e\n", c.name.c_str(), worst);
    EXPECT_LE(worst, 1e-12) << c.name;
  }
}

TEST(Pyramid, ErrorBoundIsTheSupremumOverFinestSamples) {
  for (const Case& c : cases()) {
    const Built built(c);
    double widest = 0;
    std::size_t broken = 0, nodes = 0;
    std::map<NodeKey, double> truth;
    for_each_node(c.chart, c.lattice, c.lattice.max_level(), [&](NodeKey finest) {
      const BrickSamples samples = built.samples(finest);
      NodeKey key = finest;
      for (int level = c.lattice.max_level() - 1; level >= 0; --level) {
        key = c.lattice.parent(key);
        BrickSamples own;
        refine(c.lattice, key, built.samples(key).data(), finest, own.data());
        double& worst = truth[key];
        for (std::size_t at = 0; at < own.size(); ++at)
          worst = std::max(worst, std::abs(own[at] - samples[at]));
      }
    });
    for (const auto& [key, worst] : truth) {
      const double bound = built.sparse.summary(key).error_bound_per_m;
      ++nodes;
      broken += bound < worst;
      if (worst > 0) widest = std::max(widest, bound / worst);
    }
    std::printf("measured: %-21s error bound: %zu nodes, %zu broken, at most %.3f x wide\n",
                c.name.c_str(), nodes, broken, widest);
    EXPECT_EQ(broken, 0u) << c.name;
    EXPECT_LE(widest, 4) << c.name;
  }
}

// refine() itself, against the multilinear formula written out.
TEST(Pyramid, RefineIsTrilinear) {
  const NodeKey node(0, 1, 1, 0, 0);
  BrickSamples samples, refined;
  for (std::uint32_t k = 0; k < 9; ++k)
    for (std::uint32_t j = 0; j < 9; ++j)
      for (std::uint32_t i = 0; i < 9; ++i) samples[brick_offset(i, j, k)] = lattice_noise(i, j, k);
  double worst = 0;
  const Index3 fine = kBoxLattice.cells(3), own = kBoxLattice.cells(1);
  for (const NodeKey below : {NodeKey(0, 3, 4, 3, 3), NodeKey(0, 3, 7, 0, 2)}) {
    refine(kBoxLattice, node, samples.data(), below, refined.data());
    for_each_brick_sample(below, [&](std::size_t at, Column column, std::uint32_t k) {
      const glm::dvec3 p = {double(column.i) * own[0] / fine[0] - 8,
                            double(column.j) * own[1] / fine[1], double(k) * own[2] / fine[2]};
      double sum = 0;
      for (std::uint32_t n = 0; n < 729; ++n) {
        const glm::dvec3 d = abs(p - glm::dvec3(n % 9, n / 9 % 9, n / 81));
        sum +=
            samples[n] * std::max(0.0, 1 - d.x) * std::max(0.0, 1 - d.y) * std::max(0.0, 1 - d.z);
      }
      worst = std::max(worst, std::abs(refined[at] - sum));
    });
  }
  EXPECT_LE(worst, 1e-15);
}

TEST(Pyramid, VarianceIsWhatTheFilterLeavesOut) {
  for (const Case& c : cases()) {
    const Built built(c);
    const Pyramid squares = build_pyramid(
        c.chart, c.lattice,
        [&](glm::dvec3 p) {
          const double beta = c.field(p);
          return beta * beta;
        },
        kMean);
    double worst = 0, top = 0;
    for (int level = 0; level < c.lattice.max_level(); ++level)
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        double sum = 0, square = 0;
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          double weight = 1. / 512;
          for (const std::size_t s : {at % 9, at / 9 % 9, at / 81})
            weight *= s == 0 || s == 8 ? 0.5 : 1;
          const double c_own = built.dense.levels[std::size_t(level)](column, k);
          sum += weight * (squares.levels[std::size_t(level)](column, k) - c_own * c_own);
          square += weight * squares.levels[std::size_t(level)](column, k);
        });
        worst =
            std::max(worst, std::abs(built.sparse.summary(key).unresolved_variance_per_m2 - sum));
        top = std::max(top, square);
      });
    std::printf("measured: %-21s variance off by %.1e of the mean square\n", c.name.c_str(),
                worst / top);
    EXPECT_LE(worst, 2e-6 * top) << c.name;
  }
}

TEST(Pyramid, EmptyAndChildrenSayWhatIsThere) {
  for (const Case& c : cases()) {
    const Built built(c);
    std::map<NodeKey, bool> below;  // something in this brick or below
    for (int level = c.lattice.max_level(); level >= 0; --level)
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        const BrickSamples brick = built.samples(key);
        const bool own = std::ranges::any_of(brick, [](double v) { return v != 0; });
        const NodeSummary summary = built.sparse.summary(key);
        EXPECT_EQ(summary.empty, !own) << c.name;
        bool any = own;
        unsigned children = 0;
        if (level < c.lattice.max_level())
          for (SplitMask octant = 0; octant < 8; ++octant)
            if (!(octant & ~c.lattice.split_axes(level)) &&
                below.at(key.child(c.lattice.split_axes(level), octant))) {
              any = true;
              children |= 1u << octant;
            }
        EXPECT_EQ(summary.children, children) << c.name << " level " << level;
        below[key] = any;
      });
  }
}

TEST(Pyramid, SameBitsForAnyNumberOfThreads) {
  const Case c = cases()[0];
  const Built many(c);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Built single(c);
  std::size_t different = 0;
  for_each_level(c, [&](int level) {
    for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
      different += many.samples(key) != single.samples(key);
      const NodeSummary a = many.sparse.summary(key), b = single.sparse.summary(key);
      different += a.error_bound_per_m != b.error_bound_per_m ||
                   a.unresolved_variance_per_m2 != b.unresolved_variance_per_m2;
    });
  });
  EXPECT_EQ(different, 0u);
}

// A constant in a constant, described by the source and not sampled: the same levels as sampled.
class BlockTest : public testing::TestWithParam<std::array<Index3, 2>> {};

TEST_P(BlockTest, ClosedFormEqualsSampledBlock) {
  const auto [low, high] = GetParam();
  const Lattice lattice({kSplitXyz, kSplitXyz, kSplitXyz});
  const double inside = 0.3, outside = 0.125;
  const auto sample = [&](Column column, std::uint32_t k) {
    const Index3 g = {column.i, column.j, k};
    bool within = true;
    for (std::size_t a = 0; a < 3; ++a) within = within && g[a] >= low[a] && g[a] <= high[a];
    return within ? inside : outside;
  };
  Pyramid dense;
  for (int level = 0; level <= 3; ++level) dense.levels.emplace_back(kOpenBox, lattice, level);
  for_each_sample(kOpenBox, lattice.cells(3), [&](Column column, std::uint32_t k) {
    dense.levels[3].at(column, k) = sample(column, k);
  });
  for (int level = 2; level >= 0; --level)
    for_each_node(kOpenBox, lattice, level, [&](NodeKey key) {
      const BrickSamples brick =
          coarsen_node(kOpenBox, lattice, key, dense.levels[std::size_t(level) + 1]);
      for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
        dense.levels[std::size_t(level)].at(column, k) = brick[at];
      });
    });

  SparsePyramid::Region block;
  block.block = true;
  block.value = inside, block.outside = outside, block.low = low, block.high = high;
  // Everywhere; and only in one half, so that sampled and described nodes meet.
  for (const bool everywhere : {true, false}) {
    SparsePyramid::Field field;
    field.region = [&, everywhere](NodeKey key) {
      const bool mine = everywhere || (key.level() > 0 && key.i() >= 1u << (key.level() - 1));
      return mine ? block : SparsePyramid::Region{};
    };
    field.samples = [&](NodeKey key, double* samples) {
      for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
        samples[at] = sample(column, k);
      });
    };
    const std::size_t sampled = collect_nodes(kOpenBox, lattice, field.region).back().size();
    const SparsePyramid pyramid(kOpenBox, lattice, field);
    EXPECT_EQ(sampled == 0, everywhere);
    double worst = 0, broken = 0;
    for (int level = 0; level <= 3; ++level)
      for_each_node(kOpenBox, lattice, level, [&](NodeKey key) {
        BrickSamples samples;
        pyramid.samples(key, samples.data());
        const NodeSummary summary = pyramid.summary(key);
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          worst =
              std::max(worst, std::abs(samples[at] - dense.levels[std::size_t(level)](column, k)));
          broken += float(samples[at]) > summary.max_extinction_per_m ||
                    float(samples[at]) < summary.min_extinction_per_m;
        });
      });
    std::printf("measured: block %s: worst %.1e, %zu nodes sampled, %llu bytes\n",
                everywhere ? "described" : "half sampled", worst, sampled,
                static_cast<unsigned long long>(pyramid.bytes()));
    EXPECT_LE(worst, 1e-15);
    EXPECT_EQ(broken, 0);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Places, BlockTest,
    testing::Values(std::array<Index3, 2>{Index3{10, 20, 30}, Index3{40, 41, 33}},
                    std::array<Index3, 2>{Index3{0, 0, 0}, Index3{31, 64, 7}},
                    std::array<Index3, 2>{Index3{63, 5, 5}, Index3{64, 5, 64}}));

// Two blocks in nothing: nodes that see both are stored though all their children may be described.
struct TwoBlocks {
  std::array<std::array<Index3, 2>, 2> boxes;
  Lattice lattice;
  double value = 0.25;

  double sample(Column column, std::uint32_t k) const {
    const Index3 g = {column.i, column.j, k};
    for (const auto& [low, high] : boxes) {
      bool within = true;
      for (std::size_t a = 0; a < 3; ++a) within = within && g[a] >= low[a] && g[a] <= high[a];
      if (within) return value;
    }
    return 0;
  }
  SparsePyramid::Field field() const {
    SparsePyramid::Field field;
    field.region = [this](NodeKey key) {
      const Index3 &own = lattice.cells(key.level()), &finest = lattice.cells(lattice.max_level());
      SparsePyramid::Region region;
      int seen = 0;
      for (const auto& [low, high] : boxes) {
        bool meets = true;
        for (std::size_t a = 0; a < 3; ++a) {
          const std::int64_t ratio = finest[a] / own[a], first = 8 * std::int64_t(key.ijk()[a]);
          meets = meets && std::int64_t(high[a]) >= (first - 1) * ratio &&
                  std::int64_t(low[a]) <= (first + 9) * ratio;
        }
        if (!meets) continue;
        ++seen;
        region.low = low, region.high = high, region.value = value;
      }
      region.constant = seen == 0;
      region.block = seen == 1;
      return region;
    };
    field.samples = [this](NodeKey key, double* samples) {
      for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
        samples[at] = sample(column, k);
      });
    };
    return field;
  }
};

TEST(Pyramid, TwoBlocksAreSampledOnlyWhereTheyMeet) {
  for (const std::uint32_t gap : {1u, 3u, 12u, 20u}) {
    const TwoBlocks blocks = {
        {{{Index3{5, 5, 5}, Index3{31, 30, 29}}, {Index3{31 + gap, 7, 5}, Index3{60, 40, 61}}}},
        Lattice({kSplitXyz, kSplitXyz, kSplitXyz})};
    Pyramid dense;
    for (int level = 0; level <= 3; ++level)
      dense.levels.emplace_back(kOpenBox, blocks.lattice, level);
    test::for_each_sample(kOpenBox, blocks.lattice.cells(3), [&](Column column, std::uint32_t k) {
      dense.levels[3].at(column, k) = blocks.sample(column, k);
    });
    const SparsePyramid pyramid(kOpenBox, blocks.lattice, blocks.field());
    double worst = 0;
    std::size_t broken = 0;
    for (int level = 3; level >= 0; --level)
      for_each_node(kOpenBox, blocks.lattice, level, [&](NodeKey key) {
        const DenseLevel& own = dense.levels[std::size_t(level)];
        if (level < 3) {
          const BrickSamples brick =
              coarsen_node(kOpenBox, blocks.lattice, key, dense.levels[std::size_t(level) + 1]);
          for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
            dense.levels[std::size_t(level)].at(column, k) = brick[at];
          });
        }
        BrickSamples samples;
        pyramid.samples(key, samples.data());
        const NodeSummary summary = pyramid.summary(key);
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          worst = std::max(worst, std::abs(samples[at] - own(column, k)));
          broken += own(column, k) > double(summary.max_extinction_per_m);
        });
      });
    std::printf("measured: two blocks, gap %u: worst %.1e\n", gap, worst);
    EXPECT_LE(worst, 1e-15) << gap;
    EXPECT_EQ(broken, 0u) << gap;
  }
}

// One 4096^3 tile among 16384^3 samples, and another one far away.
TEST(Pyramid, LargeTilesCostNoTimeOrMemory) {
  const TwoBlocks blocks = {{{{Index3{4096, 4096, 4096}, Index3{8191, 8191, 8191}},
                              {Index3{16000, 1, 16000}, Index3{16007, 8, 16007}}}},
                            Lattice(std::vector<SplitMask>(11, kSplitXyz))};
  const auto start = std::chrono::steady_clock::now();
  const SparsePyramid pyramid(kOpenBox, blocks.lattice, blocks.field());
  const NodeSummary root = pyramid.summary(NodeKey(0, 0, 0, 0, 0));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("measured: 4096^3 tile and another: %.3f s, %llu bytes\n", taken.count(),
              static_cast<unsigned long long>(pyramid.bytes()));
  EXPECT_FLOAT_EQ(root.max_extinction_per_m, 0.25f);
  EXPECT_LE(pyramid.bytes(), 200'000u);
  EXPECT_LE(taken.count(), 1);
}

}  // namespace
}  // namespace nepho::test
