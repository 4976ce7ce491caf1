// ONE suite for every source, through the host and its modules (lattice.md 8). It knows a source by
// its verbs only. Each check prints its line of the conformance table; mutants: CMakeLists.txt.
// What a file format promises beyond this (a VDB's voxels are the finest samples) is tested beside
// it, in tests/openvdb.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <thread>

#include "accuracy_report.h"
#include "bricks/box_chart.h"
#include "bricks/coarsen.h"
#include "pyramid/level_filter.h"
#include "random.h"
#include "scenes.h"

namespace nepho::test {
namespace {

constexpr std::size_t kMostNodes = 6000;  // per level

std::string count(std::size_t number, const char* things) {
  return std::to_string(number) + ' ' + things;
}

class Conformance : public testing::TestWithParam<ConformanceScene> {
 protected:
  void SetUp() override {
    source_ = open_scene(GetParam().volume);
    ASSERT_LT(GetParam().time, info().times_s.size());
    levels_ = nodes_by_level(*source_, kMostNodes, time_s());
  }

  const VolumeInfo& info() const { return source_->info(); }
  const Lattice& lattice() const { return info().lattice; }
  const Chart& chart() const { return *info().chart; }
  double time_s() const { return info().times_s[GetParam().time]; }
  DecodedBrick decoded(NodeKey key) const { return read_decoded(*source_, key, time_s()); }
  NodeSummary summary_at(NodeKey key) const { return summary_of(*source_, key, time_s()); }
  // A line of the conformance table, per scene; docs/accuracy.md has the worst of each source.
  void report(const char* item, double worst, double bound, const std::string& of) const {
    const ConformanceScene& scene = GetParam();
    std::printf("measured: conformance | %-24s | %-38s | %.1e | %.1e | %s\n", scene.name.c_str(),
                item, worst, bound, of.c_str());
    append_accuracy_row("conformance", scene.source + ": " + item, worst, bound, "1");
  }
  std::vector<NodeKey> all_nodes() const {
    std::vector<NodeKey> all;
    for (const auto& level : levels_) all.insert(all.end(), level.begin(), level.end());
    return all;
  }
  double top() const {
    double most = 0;
    for (const NodeKey root : levels_[0])
      most = std::max(most, double(summary_at(root).max_extinction_per_m));
    return most;
  }
  // Calls visit(offset in brick, column, k) for the samples of a node.
  template <class Visit>
  static void for_each_sample(NodeKey key, Visit&& visit) {
    for (std::uint32_t k = 0; k < kBrickSamples; ++k)
      for (std::uint32_t j = 0; j < kBrickSamples; ++j)
        for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
          const Index3 g = Lattice::global_sample(key, {i, j, k});
          visit(brick_offset(i, j, k), Column{key.root(), g[0], g[1]}, g[2]);
        }
  }
  // Hash of all bricks and summaries, bricks read by `threads` in interleaved order.
  std::uint64_t hash(const BrickSource& source, unsigned threads) const {
    const std::vector<NodeKey> keys = all_nodes();
    std::vector<std::uint64_t> hashes(keys.size());
    std::vector<std::thread> workers;
    for (unsigned t = 0; t < threads; ++t)
      workers.emplace_back([&, t] {
        for (std::size_t at = t; at < keys.size(); at += threads) {
          const NodeSummary s = summary_of(source, keys[at], time_s());
          const double parts[] = {s.min_extinction_per_m,
                                  s.max_extinction_per_m,
                                  s.constant_extinction_per_m,
                                  s.unresolved_variance_per_m2,
                                  s.error_bound_per_m,
                                  double(s.children),
                                  double(s.empty),
                                  double(s.constant)};
          std::uint64_t h = read_decoded(source, keys[at], time_s()).hash;
          for (const double part : parts)
            h = h * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(part);
          hashes[at] = h;
        }
      });
    for (std::thread& worker : workers) worker.join();
    return std::accumulate(hashes.begin(), hashes.end(), std::uint64_t{0},
                           [](std::uint64_t h, std::uint64_t part) { return h * 31 + part; });
  }

  std::unique_ptr<BrickSource> source_;
  std::vector<std::vector<NodeKey>> levels_;
};

TEST_P(Conformance, SharedFacesAgreeWithinBothErrors) {
  std::size_t shared = 0, broken = 0;
  double worst = 0;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    std::map<std::pair<Column, std::uint32_t>, std::pair<double, double>> known;
    const Index3& cells = lattice().cells(int(level));
    for (const NodeKey key : levels_[level]) {
      const DecodedBrick brick = decoded(key);
      for_each_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
        if (column.i % kBrickCells && column.j % kBrickCells && k % kBrickCells) return;
        const auto [place, first] = known.try_emplace({chart().names(column, cells).owner(), k},
                                                      brick.value[at], brick.max_abs_error);
        if (first) return;
        const auto [other, other_error] = place->second;
        const double gap = std::abs(other - brick.value[at]);
        ++shared;
        broken += gap > other_error + brick.max_abs_error;
        if (gap > 0) worst = std::max(worst, gap / (other_error + brick.max_abs_error));
      });
    }
  }
  report("gap on shared faces / both code errors", worst, 1, count(shared, "shared samples"));
  EXPECT_EQ(broken, 0u);
}

// To 1e-5 where rounding averages out. A level of few bricks, or of bricks that repeat each other,
// keeps the rounding of its codes: there, what the codes' own error bounds allow.
TEST_P(Conformance, ConservesBetweenLevels) {
  if (!GetParam().conserves) GTEST_SKIP() << "levels are expectations: tests/noise, Closure";
  constexpr std::size_t kMany = 100;
  double worst = 0, worst_few = 0, worst_allowed = 0, coarser = 0, coarser_error = 0;
  std::size_t coarser_bricks = 0;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    double sum = 0, error = 0;
    std::size_t bricks = 0;
    for (const NodeKey key : levels_[level]) {
      const HatWeights hats = owned_hats(chart(), lattice(), key);
      const DecodedBrick brick = decoded(key);
      bricks += std::ranges::any_of(brick.value, [](double value) { return value > 0; });
      for (std::size_t at = 0; at < brick.value.size(); ++at) {
        const double volume = hats.horizontal[at % 81] * hats.vertical[at / 81];
        sum += brick.value[at] * volume;
        error += brick.max_abs_error * volume;
      }
    }
    if (level > 0) {
      const double drift = std::abs(sum / coarser - 1);
      if (std::min(bricks, coarser_bricks) >= kMany) {
        worst = std::max(worst, drift);
      } else {
        worst_few = std::max(worst_few, drift);
        worst_allowed = std::max(worst_allowed, drift / ((error + coarser_error) / sum));
      }
    }
    coarser = sum, coarser_error = error, coarser_bricks = bricks;
  }
  const std::string of = count(levels_.size(), "levels");
  report("sum c V, drift per level", worst, 1e-5, of);
  report("sum c V, drift, few bricks", worst_few, 1e-4, of);
  report("sum c V, drift, few bricks / rounding", worst_allowed, 1, of);
  EXPECT_LE(worst, 1e-5);
  EXPECT_LE(worst_few, 1e-4);
  EXPECT_LE(worst_allowed, 1);
}

// Bottom-up over what is read: every bound holds for the node's own brick and all below it.
TEST_P(Conformance, SummaryBoundsNodeAndDescendants) {
  std::map<NodeKey, std::pair<double, double>> seen;
  std::size_t broken = 0, wide = 0, nodes = 0, lies = 0;
  double nearest = 0, widest = 0;
  for (std::size_t level = levels_.size(); level-- > 0;)
    for (const NodeKey key : levels_[level]) {
      const DecodedBrick brick = decoded(key);
      const NodeSummary summary = summary_at(key);
      const auto [own_least, own_most] = std::ranges::minmax(brick.value);
      double least = own_least, most = own_most;
      if (level + 1 < levels_.size())
        for (const NodeKey child : lattice().children(key)) {
          const auto below = seen.find(child);
          if (below == seen.end()) {
            if (summary.children == 0) least = std::min(least, 0.0);
            continue;
          }
          least = std::min(least, below->second.first);
          most = std::max(most, below->second.second);
        }
      if (summary.children == 0 && int(level) < lattice().max_level()) least = std::min(least, 0.0);
      seen[key] = {least, most};
      ++nodes;
      broken += most > summary.max_extinction_per_m || least < summary.min_extinction_per_m;
      lies += summary.empty != (own_most == 0);
      if (summary.constant)
        for (const double value : {least, most})
          lies += std::abs(value - summary.constant_extinction_per_m) > brick.max_abs_error;
      const double ratio = most > 0 ? summary.max_extinction_per_m / most : 0;
      if (most > 0) nearest = std::max(nearest, 1 / ratio);
      widest = std::max(widest, ratio);
      wide += ratio > 4;
    }
  char of[80];
  std::snprintf(of, sizeof of, "%zu nodes, %zu > 4x too wide, widest %.2fx", nodes, wide, widest);
  report("largest sample below / summary maximum", nearest, 1, of);
  EXPECT_EQ(broken, 0u);
  EXPECT_EQ(lies, 0u);
}

// |own trilinear - child| <= own error bound + child's error bound, and what quantisation adds.
TEST_P(Conformance, ChildrenLieWithinTheErrorBound) {
  std::size_t compared = 0, broken = 0;
  double worst = 0;
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level)
    for (const NodeKey key : levels_[level]) {
      const NodeSummary summary = summary_at(key);
      if (summary.children == 0) continue;
      const DecodedBrick own = decoded(key);
      for (const NodeKey child : lattice().children(key)) {
        const DecodedBrick fine = decoded(child);
        BrickSamples refined;
        refine(lattice(), key, own.value.data(), child, refined.data());
        const double allowed = summary.error_bound_per_m + summary_at(child).error_bound_per_m +
                               own.max_abs_error + fine.max_abs_error;
        for (std::size_t at = 0; at < refined.size(); ++at) {
          const double gap = std::abs(refined[at] - fine.value[at]);
          ++compared;
          broken += gap > allowed;
          if (gap > 0) worst = std::max(worst, gap / allowed);
        }
      }
    }
  report("children off trilinear / error bounds", worst, 1, count(compared, "samples"));
  EXPECT_EQ(broken, 0u);
}

// Where a source can be asked for its own field, its finest point samples are that field.
TEST_P(Conformance, FinestSamplesAreTheField) {
  double unused = 0;
  const bool complete = int(levels_.size()) == lattice().max_level() + 1;
  if (!complete || info().finest != SampleKind::kPoint ||
      source_->point_extinction_per_m(glm::dvec3(0), time_s(), unused) == Status::kUnsupported)
    GTEST_SKIP() << "no point field, or too fine to visit";
  const double rounding = 1e-7 * top();
  double worst = 0;
  std::size_t points = 0, not_zero = 0, broken = 0;
  for (const NodeKey key : levels_.back()) {
    const DecodedBrick brick = decoded(key);
    for_each_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
      if (at % 3) return;  // a third is plenty: points are slow
      const glm::dvec3 p = sample_ecef_m(chart(), lattice(), column.root, lattice().max_level(),
                                         {column.i, column.j, k});
      double truth = -1;
      ASSERT_EQ(source_->point_extinction_per_m(p, time_s(), truth), Status::kOk);
      const double gap = std::abs(brick.value[at] - truth);
      broken += gap > brick.max_abs_error + rounding;
      if (gap > 0) worst = std::max(worst, gap / (brick.max_abs_error + rounding));
      ++points;
      not_zero += truth == 0 && brick.value[at] != 0 && brick.value[at] > rounding;
    });
  }
  report("finest samples off field / code error", worst, 1, count(points, "points"));
  EXPECT_EQ(broken, 0u);
  EXPECT_EQ(not_zero, 0u);
}

// A zero next to something decodes to exactly zero: the least value of a brick that touches zero.
TEST_P(Conformance, ZeroDecodesToExactlyZero) {
  std::size_t bricks = 0, inexact = 0;
  for (const NodeKey key : all_nodes()) {
    const DecodedBrick brick = decoded(key);
    const auto [least, most] = std::ranges::minmax(brick.value);
    const NodeSummary summary = summary_at(key);
    if (summary.empty) inexact += most != 0;
    // A brick that has an offset has no zero in it, so that its summary has none either.
    if (least > 0) continue;
    ++bricks;
    inexact += std::signbit(least) || least != 0 || summary.min_extinction_per_m != 0;
  }
  report("bricks whose zero is not exact", double(inexact), 0, count(bricks, "bricks with zeros"));
  EXPECT_EQ(inexact, 0u);
}

TEST_P(Conformance, PositionAndKeyRoundTrip) {
  Random random;
  double worst = 0;
  std::size_t lost = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int level = random.integer(0, lattice().max_level());
    const Index3 n = lattice().nodes(level);
    const auto pick = [&](std::uint32_t count) {
      return std::uint32_t(random.integer(0, int(count) - 1));
    };
    const NodeKey key(random.integer(0, chart().roots() - 1), level, pick(n[0]), pick(n[1]),
                      pick(n[2]));
    glm::dvec3 q;
    for (int a = 0; a < 3; ++a)
      q[a] = (key.ijk()[std::size_t(a)] + random.uniform(0.01, 0.99)) / n[std::size_t(a)];
    const glm::dvec3 p = chart().ecef_m({key.root(), q});
    const RootPosition back = chart().locate(p);
    lost += lattice().node_at(back.root, back.q, level) != key;
    const double size_m = glm::length(
        chart().ecef_m({key.root(), q + glm::dvec3(0.5 / n[0], 0.5 / n[1], 0.5 / n[2])}) -
        chart().ecef_m({key.root(), q - glm::dvec3(0.5 / n[0], 0.5 / n[1], 0.5 / n[2])}));
    const double allowed_m = std::max(1e-9 * size_m, 5e-9);
    worst = std::max(worst, glm::length(chart().ecef_m(back) - p) / allowed_m);
    EXPECT_EQ(NodeKey::from_packed(key.packed()), key);
  }
  report("round trip / max(1e-9 node, 5 nm)", worst, 1, "2000 keys");
  EXPECT_EQ(lost, 0u);
  EXPECT_LE(worst, 1);
}

TEST_P(Conformance, PeriodicAxesWrap) {
  const auto* box = dynamic_cast<const BoxChart*>(&chart());
  if (!box || !(box->periodic().x || box->periodic().y)) GTEST_SKIP() << "not periodic";
  Random random;
  double worst = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const glm::dvec3 q = {random.uniform(0.001, 0.499), random.uniform(0.001, 0.999),
                          random.uniform(0.001, 0.999)};
    const glm::dvec3 p = box->ecef_m({0, q});
    for (int axis = 0; axis < 2; ++axis) {
      if (!(axis == 0 ? box->periodic().x : box->periodic().y)) continue;
      for (const double periods : {-3.0, 1.0, 2.0}) {
        const glm::dvec3 away = p + periods * box->edges_m()[axis];
        worst = std::max(worst, glm::length(box->locate(away).q - q));
        double here = 0, there = 0;
        const Status status = source_->point_extinction_per_m(p, time_s(), here);
        if (status == Status::kUnsupported) continue;
        source_->point_extinction_per_m(away, time_s(), there);
        EXPECT_NEAR(here, there, 1e-8 * top());
      }
    }
  }
  report("periodic wrap / root", worst, 1e-8, "500 points");
  EXPECT_LE(worst, 1e-8);
}

TEST_P(Conformance, SameBitsForAnyNumberOfThreads) {
  const std::uint64_t one = hash(*source_, 1);
  int differ = hash(*source_, 4) != one;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{8}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::unique_ptr<BrickSource> again = open_scene(GetParam().volume);
    differ += hash(*again, 1) != one;
  }
  report("hashes that differ, 1 to 8 threads", differ, 0, count(all_nodes().size(), "nodes"));
  EXPECT_EQ(differ, 0);
}

TEST_P(Conformance, RefusesWhatDoesNotExist) {
  NodeSummary summary;
  std::array<std::uint16_t, kBrickVolume> codes{};
  ChannelView view;
  view.codes = codes.data();
  const auto said = [&] {
    char text[200] = "";
    EXPECT_GT(source_->last_error(text, sizeof text), 0u);
    return std::string(text);
  };
  const auto refused = [&](NodeKey key, double at_s, Status expected) {
    EXPECT_EQ(source_->read(key, at_s, {&view, 1}), expected);
    EXPECT_EQ(said(), to_string(expected));
    EXPECT_EQ(source_->summary(key, at_s, summary), expected);
  };
  const NodeKey root(0, 0, 0, 0, 0);
  refused(NodeKey(0, lattice().max_level() + 1, 0, 0, 0), time_s(), Status::kNoSuchNode);
  refused(NodeKey(chart().roots(), 0, 0, 0, 0), time_s(), Status::kNoSuchNode);
  refused(NodeKey(0, 0, 1, 0, 0), time_s(), Status::kNoSuchNode);
  refused(NodeKey(0, 0, 0, 0, 1), time_s(), Status::kNoSuchNode);
  refused(root, info().times_s.back() + 0.125, Status::kNoSuchTime);
  view.channel = Channel::kTemperature;
  EXPECT_EQ(source_->read(root, time_s(), {&view, 1}), Status::kNoSuchChannel);
  EXPECT_FALSE(said().empty());
  char small[4] = "";
  EXPECT_GT(source_->last_error(small, sizeof small), sizeof small);
  EXPECT_EQ(std::strlen(small), 3u);
}

std::string scene_name(const testing::TestParamInfo<ConformanceScene>& scene) {
  return scene.param.name;
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Conformance);
INSTANTIATE_TEST_SUITE_P(Analytic, Conformance, testing::ValuesIn(analytic_scenes()), scene_name);
INSTANTIATE_TEST_SUITE_P(Noise, Conformance, testing::ValuesIn(noise_scenes()), scene_name);
INSTANTIATE_TEST_SUITE_P(Files, Conformance, testing::ValuesIn(file_scenes()), scene_name);

}  // namespace
}  // namespace nepho::test
