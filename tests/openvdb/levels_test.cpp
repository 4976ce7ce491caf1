// From level to level through the contract alone: what is read of a node against the filter of what
// is read of the nodes below it, and its summary against everything below.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "vdb_files.h"

namespace nepho::test {
namespace {

const char* const kTwins[] = {"plain", "double", "sheared", "tiles", "background"};

// Finest and coarser samples by global index, decoded; bricks are read once.
class Levels {
 public:
  explicit Levels(const BrickSource& source) : source_(source) {}
  const Brick& brick(NodeKey key) {
    const auto [at, is_new] = bricks_.try_emplace(key);
    if (is_new) at->second = read(source_, key, 0);
    return at->second;
  }
  double sample(int level, const Index3& g, double* error = nullptr) {
    const Index3 nodes = source_.info().lattice.nodes(level);
    Index3 node{}, within{};
    for (std::size_t a = 0; a < 3; ++a) {
      node[a] = std::min(g[a] / 8, nodes[a] - 1);
      within[a] = g[a] - 8 * node[a];
    }
    const Brick& found = brick({0, level, node[0], node[1], node[2]});
    if (error) *error = std::max(*error, found.max_abs_error);
    return found.samples[brick_offset(within[0], within[1], within[2])];
  }

 private:
  const BrickSource& source_;
  std::map<NodeKey, Brick> bricks_;
};

std::vector<NodeKey> some_nodes(const BrickSource& source, std::size_t most) {
  std::vector<NodeKey> nodes;
  descend(source, 0, [&](NodeKey key, const NodeSummary&) { nodes.push_back(key); });
  std::ranges::shuffle(nodes, std::mt19937(11));
  std::ranges::stable_sort(nodes, {}, [](NodeKey key) { return key.level() > 3; });
  nodes.resize(std::min(nodes.size(), most));
  return nodes;
}

TEST(Levels, CoarseIsTheFilterOfFine) {
  for (const char* name : kTwins) {
    const auto source = open(twin(name), {number("density_scale", 0.1)});
    const VolumeInfo& info = source->info();
    Levels levels(*source);
    double worst = 0;
    for (const NodeKey key : some_nodes(*source, 60)) {
      if (key.level() == info.lattice.max_level()) continue;
      const Brick& coarse = levels.brick(key);
      for_each_stencil(
          *info.chart, info.lattice, key,
          [&](std::size_t at, const ColumnStencil& columns, const LayerStencil& layers) {
            double error = coarse.max_abs_error, fine_error = 0;
            const double expected = weighted_mean(columns, layers, [&](Column c, std::uint32_t k) {
              return levels.sample(key.level() + 1, {c.i, c.j, k}, &fine_error);
            });
            error += fine_error;
            if (error > 0)
              worst = std::max(worst, std::abs(coarse.samples[at] - expected) / error);
            else
              EXPECT_EQ(coarse.samples[at], expected);
          });
    }
    std::printf("measured: %-10s coarse against filtered fine: %.3f of both code errors\n", name,
                worst);
    EXPECT_LE(worst, 1) << name;
    EXPECT_GT(worst, 0) << name;
  }
}

TEST(Levels, SummariesBoundAllBelow) {
  for (const char* name : kTwins) {
    const auto source = open(twin(name), {number("density_scale", 0.1)});
    const int finest = source->info().lattice.max_level();
    // largest and smallest decoded sample of each node and its descendants
    std::map<NodeKey, std::pair<double, double>> range;
    std::map<NodeKey, NodeSummary> known;
    descend(*source, 0, [&](NodeKey key, const NodeSummary& s) {
      known[key] = s;
      const Brick brick = read(*source, key, 0);
      const auto [low, high] = std::ranges::minmax(brick.samples);
      EXPECT_EQ(s.empty, high == 0) << name << " level " << key.level();
      if (s.constant) {
        EXPECT_NEAR(high, low, 4e-7 * high);
      }
      for (NodeKey at = key;; at = source->info().lattice.parent(at)) {
        const auto found = range.try_emplace(at, low, high).first;
        found->second = {std::min(found->second.first, low), std::max(found->second.second, high)};
        if (at.level() == 0) break;
      }
    });
    double widest = 1;
    for (const auto& [key, s] : known) {
      const auto [low, high] = range[key];
      EXPECT_LE(high, double(s.max_extinction_per_m)) << name << " level " << key.level();
      EXPECT_GE(low, double(s.min_extinction_per_m)) << name << " level " << key.level();
      if (high > 0) widest = std::max(widest, double(s.max_extinction_per_m) / high);
      if (key.level() == finest) {
        EXPECT_EQ(s.error_bound_per_m, 0);
      }
    }
    std::printf("measured: %-10s %zu nodes bounded, widest bound %.2f of the largest sample\n",
                name, known.size(), widest);
  }
}

// sup |own trilinear - finest| at the finest samples, where it is largest.
TEST(Levels, ErrorBoundsHold) {
  for (const char* name : kTwins) {
    const auto source = open(twin(name), {number("density_scale", 0.1)});
    const Lattice& lattice = source->info().lattice;
    Levels levels(*source);
    for (const NodeKey key : some_nodes(*source, 12)) {
      const int below = lattice.max_level() - key.level();
      if (below == 0 || below > 3) continue;
      const std::uint32_t step = 1u << below, last = 8 * step;
      const NodeSummary s = summary(*source, key, 0);
      const Brick& own = levels.brick(key);
      for (std::uint32_t z = 0; z <= last; z += 3)
        for (std::uint32_t y = 0; y <= last; y += 2)
          for (std::uint32_t x = 0; x <= last; ++x) {
            double value = 0;
            for (unsigned corner = 0; corner < 8; ++corner) {
              double weight = 1;
              Index3 at{};
              const Index3 fine = {x, y, z};
              for (std::size_t a = 0; a < 3; ++a) {
                const std::uint32_t low = std::min(fine[a] / step, 7u);
                const double t = double(fine[a]) / step - low;
                at[a] = low + (corner >> a & 1);
                weight *= corner >> a & 1 ? t : 1 - t;
              }
              value += weight * own.samples[brick_offset(at[0], at[1], at[2])];
            }
            double error = own.max_abs_error;
            const double truth =
                levels.sample(lattice.max_level(),
                              {key.i() * last + x, key.j() * last + y, key.k() * last + z}, &error);
            ASSERT_LE(std::abs(value - truth), s.error_bound_per_m + 2 * error)
                << name << " level " << key.level();
          }
    }
  }
}

TEST(Levels, ExtinctionIsConserved) {
  for (const char* name : {"plain", "sheared"}) {
    const auto source = open(twin(name), {number("density_scale", 0.1)});
    const VolumeInfo& info = source->info();
    std::vector<double> totals;
    for (int level = 0; level <= info.lattice.max_level(); ++level) {
      const Index3 n = info.lattice.cells(level);
      Levels levels(*source);
      double total = 0;
      for (std::uint32_t k = 0; k <= n[2]; ++k)
        for (std::uint32_t j = 0; j <= n[1]; ++j)
          for (std::uint32_t i = 0; i <= n[0]; ++i)
            total += levels.sample(level, {i, j, k}) * info.chart->hat_horizontal({0, i, j}, n) *
                     info.chart->hat_vertical(k, n);
      totals.push_back(total);
    }
    const auto [low, high] = std::ranges::minmax(totals);
    std::printf("measured: %-10s sum c V over %zu levels agrees to %.1e\n", name, totals.size(),
                high / low - 1);
    EXPECT_GT(low, 0);
    EXPECT_LE(high / low - 1, 1e-5) << name;
  }
}

std::uint64_t digest(const std::string& file, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const auto source = open(file, {number("density_scale", 0.1)});
  std::vector<NodeKey> nodes;
  descend(*source, 0, [&](NodeKey key, const NodeSummary&) { nodes.push_back(key); });
  std::vector<std::uint64_t> parts(nodes.size());
  tbb::parallel_for(std::size_t(0), nodes.size(), [&](std::size_t at) {
    std::array<std::uint16_t, kBrickVolume> codes;
    ChannelView view;
    view.codes = codes.data();
    ASSERT_EQ(source->read(nodes[at], 0, {&view, 1}), Status::kOk);
    const NodeSummary s = summary(*source, nodes[at], 0);
    std::uint64_t h = std::bit_cast<std::uint32_t>(view.scale);
    h = h * 31 + std::bit_cast<std::uint64_t>(s.unresolved_variance_per_m2);
    h = h * 31 + std::bit_cast<std::uint64_t>(s.error_bound_per_m);
    for (const std::uint16_t code : codes) h = h * 0x100000001b3u + code;
    parts[at] = h;
  });
  std::uint64_t all = nodes.size();
  for (const std::uint64_t part : parts) all = all * 0x9e3779b97f4a7c15u + part;
  return all;
}

TEST(Levels, SameBitsForAnyNumberOfThreads) {
  for (const char* name : {"plain", "tiles"}) {
    const std::string file = twin(name);
    EXPECT_EQ(digest(file, 1), digest(file, 8)) << name;
  }
}

// Four readers ask for frames in different orders while two are kept.
TEST(Levels, FramesCanBeReadFromManyThreads) {
  const auto source = open(twin("sequence"), {number("density_scale", 1)});
  const auto& times = source->info().times_s;
  std::vector<float> most(times.size());
  for (std::size_t f = 0; f < times.size(); ++f)
    most[f] = summary(*source, NodeKey(0, 0, 0, 0, 0), times[f]).max_extinction_per_m;
  EXPECT_EQ(most[0], 0);
  EXPECT_GT(most[3], 0);
  tbb::parallel_for(0, 64, [&](int task) {
    const std::size_t f = std::size_t(task * 7 + task / 4) % times.size();
    EXPECT_EQ(summary(*source, NodeKey(0, 0, 0, 0, 0), times[f]).max_extinction_per_m, most[f]);
    read(*source, NodeKey(0, 1, 0, 0, 0), times[f]);
  });
}

}  // namespace
}  // namespace nepho::test
