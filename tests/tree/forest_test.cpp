#include "tree/forest.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <bit>
#include <map>
#include <optional>
#include <set>

#include "analytic_field.h"
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "field_source.h"
#include "random.h"

namespace nepho {
namespace {

using test::FieldSource;

constexpr double kSide_m = 1000;

std::shared_ptr<const Chart> cube_chart(glm::dvec3 origin_m = glm::dvec3{0.0}) {
  return std::make_shared<BoxChart>(origin_m, glm::dmat3(kSide_m));
}

// Cloud in one half, nothing in a quarter, a constant in another, so that all kinds occur.
double mixed(glm::dvec3 p) {
  const glm::dvec3 q = p / kSide_m;
  if (q.x < 0.5) return 4 * test::cloud(9.0 * q);
  return q.y < 0.5 ? 0.0 : 0.01;
}

const FieldSource& mixed_source() {
  static const FieldSource source(cube_chart(), test::isotropic(3), mixed);
  return source;
}

const FieldSource& puffs_source() {
  static const FieldSource source(cube_chart({1200, 0, 0}), test::isotropic(2), [](glm::dvec3 p) {
    return test::puffs((p - glm::dvec3{1200, 0, 0}) / (kSide_m / 2));
  });
  return source;
}

std::uint64_t power_of_two_tiles(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) {
  return 16 * nodes + 1458 * std::bit_ceil(bricks) + 1458 * std::bit_ceil(lit);
}

Refinement refinement(double budget_mib) {
  Refinement r;
  r.camera = {.eye_m = {500, -2500, 500}, .target_m = {500, 500, 500}};
  r.settings.budget_mib = budget_mib;
  r.cost.total = power_of_two_tiles;
  return r;
}

RenderVolume volume_of(const BrickSource& source) {
  RenderVolume volume;
  volume.source = &source;
  return volume;
}

std::vector<RenderVolume> volumes() {
  return {volume_of(mixed_source()), volume_of(puffs_source())};
}

Forest build(const Refinement& r) {
  return build_forest(volumes(), r);
}

std::map<NodeKey, NodeKind> leaves(const VolumeTree& tree) {
  std::map<NodeKey, NodeKind> result;
  for (const TreeNode& node : tree.nodes)
    if (node.kind != NodeKind::kInner) result[node.key] = node.kind;
  return result;
}

TEST(Forest, SameBitsForAnyNumberOfThreads) {
  const auto with_threads = [](int threads) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                    std::size_t(threads));
    tbb::task_arena arena(threads);
    return arena.execute([] { return build(refinement(2)); });
  };
  const Forest one = with_threads(1), eight = with_threads(8);
  ASSERT_EQ(one.volumes.size(), 2u);
  for (std::size_t v = 0; v < 2; ++v) {
    const VolumeTree &a = one.volumes[v], &b = eight.volumes[v];
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    ASSERT_GT(a.bricks.size(), 8u);
    ASSERT_EQ(a.bricks.size(), b.bricks.size());
    for (std::size_t n = 0; n < a.nodes.size(); ++n) {
      EXPECT_EQ(a.nodes[n].key, b.nodes[n].key);
      EXPECT_EQ(a.nodes[n].kind, b.nodes[n].kind);
      EXPECT_EQ(a.nodes[n].first_child, b.nodes[n].first_child);
      EXPECT_EQ(a.nodes[n].majorant_per_m, b.nodes[n].majorant_per_m);
    }
    for (std::size_t n = 0; n < a.bricks.size(); ++n) {
      EXPECT_EQ(a.bricks[n].key, b.bricks[n].key);
      EXPECT_EQ(a.bricks[n].codes, b.bricks[n].codes);
      EXPECT_EQ(a.bricks[n].scale, b.bricks[n].scale);
    }
  }
}

TEST(Forest, BudgetHoldsAndMoreOfItNeverCoarsens) {
  std::vector<std::set<NodeKey>> before(2);
  std::size_t distinct = 0;
  bool bound = false, free = false;
  for (double mib = 0.02; mib < 8; mib *= 1.3) {
    const Forest forest = build(refinement(mib));
    std::uint64_t nodes = 0, bricks = 0, lit = 0;
    for (std::size_t v = 0; v < 2; ++v) {
      const VolumeTree& tree = forest.volumes[v];
      nodes += tree.nodes.size();
      bricks += tree.bricks.size();
      lit += tree.lit_nodes;
      std::set<NodeKey> keys;
      for (const TreeNode& node : tree.nodes) keys.insert(node.key);
      EXPECT_TRUE(std::includes(keys.begin(), keys.end(), before[v].begin(), before[v].end()))
          << mib;
      distinct += keys.size() > before[v].size();
      before[v] = std::move(keys);
    }
    const std::uint64_t bytes = power_of_two_tiles(nodes, bricks, lit);
    EXPECT_EQ(bytes, forest.cost_bytes);
    EXPECT_LE(double(bytes), mib * 1024 * 1024);
    (forest.budget_bound ? bound : free) = true;
  }
  EXPECT_GT(distinct, 5u);
  EXPECT_TRUE(bound && free);
}

TEST(Forest, BudgetBelowTheRootsIsRefused) {
  EXPECT_THROW(build(refinement(0.001)), Error);
}

TEST(Forest, TreeIsWellFormed) {
  const Forest forest = build(refinement(4));
  for (const VolumeTree& tree : forest.volumes) {
    const Lattice& lattice = tree.source->info().lattice;
    std::vector<int> seen(tree.nodes.size(), 0);
    seen[0] = 1;
    std::vector<NodeKey> lit;
    std::size_t bricks = 0;
    std::map<NodeKey, std::uint32_t> lit_index;
    for (const TreeNode& node : tree.nodes) {
      if (node.kind == NodeKind::kInner) {
        const std::vector<NodeKey> keys = lattice.children(node.key);
        for (std::size_t c = 0; c < keys.size(); ++c) {
          EXPECT_EQ(tree.nodes.at(node.first_child + c).key, keys[c]);
          ++seen[node.first_child + c];
        }
        continue;
      }
      NodeSummary summary;
      ASSERT_EQ(tree.source->summary(node.key, 0, summary), Status::kOk);
      EXPECT_EQ(node.kind == NodeKind::kBrick, !summary.empty && !summary.constant);
      EXPECT_EQ(node.kind == NodeKind::kConstant, summary.constant && !summary.empty);
      if (node.kind == NodeKind::kBrick) {
        ++bricks;
        EXPECT_EQ(tree.bricks.at(node.brick).key, node.key);
      }
      if (node.kind != NodeKind::kEmpty && node.seen) lit_index[node.key] = node.lit;
    }
    for (const int times : seen) EXPECT_EQ(times, 1);
    EXPECT_EQ(bricks, tree.bricks.size());
    EXPECT_TRUE(std::is_sorted(tree.bricks.begin(), tree.bricks.end(),
                               [](const auto& a, const auto& b) { return a.key < b.key; }));
    std::uint32_t next = 0;
    for (const auto& [key, index] : lit_index) EXPECT_EQ(index, next++);
    EXPECT_EQ(next, tree.lit_nodes);
  }
  const auto kinds = leaves(forest.volumes[0]);
  std::set<NodeKind> found;
  for (const auto& [key, kind] : kinds) found.insert(kind);
  EXPECT_EQ(found.size(), 3u) << "the field was made to have all kinds";
}

TEST(Forest, LeafAtFindsTheLeafThatHoldsTheCell) {
  const Forest forest = build(refinement(1));
  test::Random random;
  for (const VolumeTree& tree : forest.volumes) {
    const Lattice& lattice = tree.source->info().lattice;
    const Index3 n = lattice.cells(lattice.max_level());
    for (int i = 0; i < 2000; ++i) {
      Index3 cell;
      for (std::size_t a = 0; a < 3; ++a) cell[a] = std::uint32_t(random.integer(0, int(n[a]) - 1));
      const TreeNode& leaf = leaf_at(tree, 0, cell);
      ASSERT_NE(leaf.kind, NodeKind::kInner);
      const Index3 at = leaf.key.ijk(), nodes = lattice.nodes(leaf.key.level());
      for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(cell[a] * nodes[a] / n[a], at[a]);
    }
  }
}

TEST(Forest, SplitsByPixelsByErrorAndNotBeyondMaxLevel) {
  const auto finest = [](Refinement r) { return build(r).volumes[0].finest_level_used; };
  Refinement r = refinement(64);
  EXPECT_EQ(finest(r), 3);
  r.settings.max_level = 1;
  EXPECT_EQ(finest(r), 1);
  r = refinement(64);
  r.settings.pixels_per_voxel = 100;  // root voxels: 125 m of 2500 m, 29 px of 360 over 0.6 rad
  EXPECT_EQ(finest(r), 0);
  r.settings.pixels_per_voxel = 20;
  EXPECT_EQ(finest(r), 1);
  r = refinement(64);
  r.settings.tolerance = 300;  // more than any optical depth of the scene
  EXPECT_EQ(finest(r), 0);
}

TEST(Forest, NearNodesAreFinerThanFarOnesAndUnseenOnesAreKeptCoarser) {
  Refinement r = refinement(64);
  const auto level_at = [&](const Index3& cell) {
    return leaf_at(build(r).volumes[0], 0, cell).key.level();
  };
  r.camera = {.eye_m = {-200, 500, 500}, .target_m = {500, 500, 500}};
  // A voxel of level l at distance d: 125/2^l/d/pixel. Threshold between level 1 at 0.3 and 1 km.
  r.settings.pixels_per_voxel = 80;
  const int near = level_at({4, 32, 32}), far = level_at({30, 60, 60});
  EXPECT_GT(near, far);
  r.camera.target_m = {-2000, 500, 500};
  EXPECT_LT(level_at({4, 32, 32}), near);
  EXPECT_GE(level_at({4, 32, 32}), 1) << "kept: it may cast a shadow into view";
}

// A shadow that falls away from the picture is worth less than one that falls into it.
TEST(Forest, UnseenNodesAreCoarsestWhereTheirShadowIsUnseenToo) {
  Refinement r = refinement(64);
  r.camera = {.eye_m = {-600, 500, 500}, .target_m = {-2000, 500, 500}};
  r.settings.pixels_per_voxel = 20;
  const auto level_with_sun = [&](std::optional<glm::dvec3> to_sun) {
    r.to_sun = to_sun;
    return leaf_at(build(r).volumes[0], 0, {4, 32, 32}).key.level();
  };
  // 125 m at 600 m: 122 pixels, 31 at a quarter, 8 at a sixteenth.
  EXPECT_EQ(level_with_sun({}), 1);
  EXPECT_EQ(level_with_sun(glm::dvec3{1, 0, 0}), 1);
  EXPECT_EQ(level_with_sun(glm::dvec3{-1, 0, 0}), 0);
  // Beside the picture at first, and in it farther on.
  EXPECT_EQ(level_with_sun(glm::normalize(glm::dvec3{1, 0.4, 0})), 1);
}

// A source of noise: bounds that nothing comes near, and what is likely.
class Likely final : public BrickSource {
 public:
  explicit Likely(double deviation_per_m) : deviation_per_m_(deviation_per_m) {
    info_ = mixed_source().info();
    info_.refine_by_variance = true;
  }
  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double t, NodeSummary& s) const noexcept override {
    const Status status = mixed_source().summary(key, t, s);
    if (s.error_bound_per_m > 0) s.error_bound_per_m = 1;
    s.unresolved_variance_per_m2 = deviation_per_m_ * deviation_per_m_;
    return status;
  }
  Status read(NodeKey key, double t, BrickView view) const noexcept override {
    return mixed_source().read(key, t, view);
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return mixed_source().last_error(buffer, size);
  }

 private:
  VolumeInfo info_;
  double deviation_per_m_;
};

TEST(Forest, NoiseIsRefinedByWhatIsLikely) {
  Refinement r = refinement(64);
  r.settings.pixels_per_voxel = 10;  // a root's voxel: 29
  const auto finest = [&](double deviation_per_m) {
    const Likely source(deviation_per_m);
    const RenderVolume volume = volume_of(source);
    return build_forest({&volume, 1}, r).volumes[0].finest_level_used;
  };
  EXPECT_EQ(finest(0), 0);
  EXPECT_EQ(finest(1), 2);
  // Four deviations through 1 km are a depth of 0.1: 29 pixels weigh 18. Half as long and as
  // large: 6.
  EXPECT_EQ(finest(2.5e-5), 1);
  // Below the tolerance, 0.01.
  EXPECT_EQ(finest(2e-6), 0);
}

TEST(Forest, ShellFacesAreRefinedWhereTheEyeIs) {
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::wgs84(), 0.0, 16000.0);
  const FieldSource source(chart, Lattice({kSplitXy, kSplitXy}), [](glm::dvec3 p) {
    return 1e-4 * std::max(0.0, test::value_noise(p / 5e5) - 0.4);
  });
  Refinement r = refinement(64);
  r.camera = {.eye_m = {6.6e6, 0, 0}, .target_m = {0, 0, 0}};
  r.settings.pixels_per_voxel = 200;
  const RenderVolume volume = volume_of(source);
  const Forest forest = build_forest({&volume, 1}, r);
  const VolumeTree& tree = forest.volumes[0];
  EXPECT_EQ(leaf_at(tree, 0, {16, 16, 4}).key.level(), 2);
  EXPECT_EQ(leaf_at(tree, 1, {16, 16, 4}).key.level(), 0);
  for (int root = 0; root < 6; ++root) EXPECT_EQ(tree.nodes[std::size_t(root)].key.root(), root);
}

// Fails where told to.
class Failing final : public BrickSource {
 public:
  explicit Failing(bool in_summary) : in_summary_(in_summary) {}
  const VolumeInfo& info() const noexcept override { return mixed_source().info(); }
  Status summary(NodeKey key, double t, NodeSummary& s) const noexcept override {
    if (in_summary_ && key.level() == 2) return fail();
    return mixed_source().summary(key, t, s);
  }
  Status read(NodeKey key, double t, BrickView view) const noexcept override {
    ++reads;
    return in_summary_ ? mixed_source().read(key, t, view) : fail();
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }
  mutable std::atomic<int> reads = 0;

 private:
  static Status fail() noexcept {
    set_last_error("the disk caught fire");
    return Status::kReadFailed;
  }
  bool in_summary_;
};

TEST(Forest, AFailingSourceIsReportedInItsOwnWords) {
  for (const bool in_summary : {false, true}) {
    const Failing source(in_summary);
    const RenderVolume volume = volume_of(source);
    try {
      build_forest({&volume, 1}, refinement(64));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().found, "the disk caught fire");
    }
  }
}

// A view that moves back a little keeps what it had; far away it lets go.
TEST(Forest, SplitsAreHeldWhileTheViewMoves) {
  Refinement near = refinement(64);
  near.camera.eye_m.y = -700;
  near.settings.pixels_per_voxel = 16;
  const Forest first = build(near);
  const auto count = [](const Forest& forest) {
    std::size_t nodes = 0;
    for (const VolumeTree& tree : forest.volumes) nodes += tree.nodes.size();
    return nodes;
  };
  std::set<std::pair<std::uint32_t, NodeKey>> split;
  for (std::uint32_t v = 0; v < first.volumes.size(); ++v)
    for (const TreeNode& node : first.volumes[v].nodes)
      if (node.kind == NodeKind::kInner) split.insert({v, node.key});
  const auto at = [&](double y, bool held) {
    Refinement r = near;
    r.camera.eye_m.y = y;
    if (held) r.was_split = [&](std::uint32_t v, NodeKey key) { return split.contains({v, key}); };
    return count(build(r));
  };
  ASSERT_LT(at(-1000, false), count(first));
  EXPECT_EQ(at(-750, true), count(first));
  EXPECT_GT(at(-1000, true), at(-1000, false));
  EXPECT_EQ(at(-40000, true), at(-40000, false));
}

TEST(Forest, EachBrickIsReadOnce) {
  const Failing source(true);
  const RenderVolume volume = volume_of(source);
  Refinement r = refinement(64);
  r.settings.max_level = 1;
  const Forest forest = build_forest({&volume, 1}, r);
  EXPECT_EQ(std::size_t(source.reads), forest.volumes[0].bricks.size());
}

}  // namespace
}  // namespace nepho
