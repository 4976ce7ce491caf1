#include "tree/forest.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "tree/source_verbs.h"
#include "tree/view_metric.h"

namespace nepho {
namespace {

// Candidates whose children are summarised together. Fixed, so that work, not results, depends on
// the number of threads.
constexpr std::size_t kBatch = 256;
// Standard deviations that an octave of noise can reach: the closure's own end (docs/lattice.md 2).
constexpr double kDeviations = 4;
// Tolerances that noise counts in full from. A depth of 0.1 by default: with 1, blocks of unlike
// levels showed in cirrus.
constexpr double kStrong = 10;
constexpr double kHold = 1.5;  // a node that was split counts so much more
constexpr double kBytesPerMib = 1024.0 * 1024.0;

struct Counts {
  std::uint64_t nodes = 0, bricks = 0, lit = 0;
};

struct Candidate {
  double priority;
  std::uint32_t volume;
  NodeKey key;
  std::uint32_t node;
  bool operator<(const Candidate& other) const {
    if (priority != other.priority) return priority > other.priority;
    if (volume != other.volume) return volume < other.volume;
    return key < other.key;
  }
};

// `whole`: what is constant needs no brick. Not where ice is told apart: its part of a constant is
// only in bricks.
TreeNode leaf_from(NodeKey key, const NodeSummary& summary, bool whole) {
  TreeNode node;
  node.key = key;
  node.kind = NodeKind::kBrick;
  if (summary.constant) {
    node.constant_per_m = summary.constant_extinction_per_m;
    node.kind = node.constant_per_m > 0 ? (whole ? NodeKind::kConstant : NodeKind::kBrick)
                                        : NodeKind::kEmpty;
  } else if (summary.empty) {
    node.kind = NodeKind::kEmpty;
  }
  node.majorant_per_m = summary.max_extinction_per_m;
  // Rounded up, so that the float is a bound as well.
  node.error_bound_per_m = std::nextafter(float(summary.error_bound_per_m), INFINITY);
  if (summary.error_bound_per_m == 0) node.error_bound_per_m = 0;
  node.unresolved_variance_per_m2 = float(summary.unresolved_variance_per_m2);
  return node;
}

// What no ray meets only casts shadows: it needs no light of its own.
bool has_light(const TreeNode& node) {
  return node.seen && (node.kind == NodeKind::kBrick || node.kind == NodeKind::kConstant);
}

class Refiner {
 public:
  Refiner(std::span<const RenderVolume> volumes, const Refinement& refinement)
      : refinement_(refinement),
        metric_(refinement.camera, refinement.settings, refinement.to_sun),
        budget_bytes_(refinement.settings.budget_mib * kBytesPerMib) {
    for (const RenderVolume& volume : volumes)
      forest_.volumes.push_back(
          {.source = volume.source, .time_s = volume.time_s, .nodes = {}, .bricks = {}});
  }

  Forest run() {
    plant_roots();
    while (!queue_.empty() && split_first()) {
    }
    forest_.budget_bound = !queue_.empty();
    forest_.held = held_ || (any_hold_ && forest_.budget_bound);
    forest_.cost_bytes = cost(counts_);
    queue_.clear();
    summaries_.clear();
    for (VolumeTree& tree : forest_.volumes) read_bricks(tree);
    return std::move(forest_);
  }

 private:
  // All volumes share the renderer's textures, so the bill is made out once, for the sums.
  std::uint64_t cost(const Counts& counts) const {
    return refinement_.cost.bytes(counts.nodes, counts.bricks, counts.lit);
  }

  static void count(Counts& counts, const TreeNode& node, int sign) {
    const auto add = std::uint64_t(std::int64_t(sign));
    if (node.kind == NodeKind::kBrick) counts.bricks += add;
    if (has_light(node)) counts.lit += add;
  }

  TreeNode leaf(std::uint32_t volume, NodeKey key, const NodeSummary& summary) const {
    const VolumeInfo& info = forest_.volumes[volume].source->info();
    TreeNode node = leaf_from(key, summary, !has_ice(info));
    node.seen =
        node.kind == NodeKind::kEmpty || refinement_.light_unseen || metric_.seen(info, key);
    return node;
  }

  NodeSummary summarise(std::uint32_t volume, NodeKey key) const {
    const VolumeTree& tree = forest_.volumes[volume];
    NodeSummary summary;
    throw_on_failure(tree.source->summary(key, tree.time_s, summary), *tree.source, "summarise",
                     key);
    return summary;
  }

  void plant_roots() {
    for (std::uint32_t v = 0; v < forest_.volumes.size(); ++v) {
      const VolumeInfo& info = forest_.volumes[v].source->info();
      for (int root = 0; root < info.chart->roots(); ++root) {
        const NodeKey key(root, 0, 0, 0, 0);
        append(v, key, summarise(v, key));
      }
    }
    if (double(cost(counts_)) > budget_bytes_)
      throw Error(
          {.what = "the memory budget does not hold the coarsest level of the scene",
           .where = "budget",
           .expected = "at least " + std::to_string(double(cost(counts_)) / kBytesPerMib) + " MiB",
           .found = std::to_string(refinement_.settings.budget_mib) + " MiB",
           .hint = "raise --budget-mib"});
  }

  // Adds a leaf to its tree, and to the queue where a split of it is worth something.
  void append(std::uint32_t volume, NodeKey key, const NodeSummary& summary) {
    VolumeTree& tree = forest_.volumes[volume];
    const TreeNode node = leaf(volume, key, summary);
    const auto index = std::uint32_t(tree.nodes.size());
    tree.nodes.push_back(node);
    tree.finest_level_used = std::max(tree.finest_level_used, key.level());
    ++counts_.nodes;
    count(counts_, node, +1);

    const VolumeInfo& info = tree.source->info();
    const bool nothing_below = summary.empty && summary.children == 0;
    if (key.level() >= std::min(refinement_.settings.max_level, info.lattice.max_level()) ||
        summary.constant || nothing_below || !(summary.error_bound_per_m > 0))
      return;
    const ViewMetric::NodeView view = metric_.view(info, key);
    double hold = refinement_.was_split && refinement_.was_split(volume, key) ? kHold : 1;
#if defined(NEPHO_MUTANT_FOREST_HOLD)
    hold = 1;
#endif
    const Worth worth = worth_of(info, summary, view, hold);
    if (!worth.split) return;
    queue_.insert({worth.priority, volume, key, index});
    any_hold_ = any_hold_ || hold > 1;
    held_ = held_ || !worth_of(info, summary, view, 1).split;
  }

  struct Worth {
    double priority = 0;
    bool split = false;
  };
  Worth worth_of(const VolumeInfo& info, const NodeSummary& summary,
                 const ViewMetric::NodeView& view, double hold) const {
    const double error = hold * depth_error(info, summary, view);
    const double tolerance = refinement_.settings.tolerance;
    const double strong = info.refine_by_variance ? kStrong * tolerance : 1;
    const double voxel_pixels = hold * view.voxel_pixels;
    const double priority = voxel_pixels * -std::expm1(-error / strong);
    // Faint voxels may be larger, where all that is known of them is what they are likely to hide.
    const double pixels = info.refine_by_variance ? priority : voxel_pixels;
    return {priority, pixels > refinement_.settings.pixels_per_voxel && error > tolerance};
  }

  // What a ray's optical depth in the node can be off by; for noise, what it is likely to be.
  static double depth_error(const VolumeInfo& info, const NodeSummary& summary,
                            const ViewMetric::NodeView& view) {
    const double surely = summary.error_bound_per_m * view.length_m;
    if (!info.refine_by_variance) return surely;
#if defined(NEPHO_MUTANT_FOREST_VARIANCE)
    return surely;
#endif
    const double deviation_per_m = std::sqrt(summary.unresolved_variance_per_m2);
    return std::min(surely, kDeviations * deviation_per_m * view.path_m);
  }

  const std::vector<NodeSummary>& children_of(const Candidate& first) {
    const auto known = summaries_.find({first.volume, first.node});
    if (known != summaries_.end()) return known->second;
    struct Task {
      const Candidate* candidate;
      std::vector<NodeSummary> summaries;
    };
    std::vector<Task> tasks;
    for (auto it = queue_.begin(); it != queue_.end() && tasks.size() < kBatch; ++it)
      if (!summaries_.contains({it->volume, it->node})) tasks.push_back({&*it, {}});
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t t) {
      const Candidate& c = *tasks[t].candidate;
      for (const NodeKey child : lattice(c.volume).children(c.key))
        tasks[t].summaries.push_back(summarise(c.volume, child));
    });
    for (Task& task : tasks)
      summaries_[{task.candidate->volume, task.candidate->node}] = std::move(task.summaries);
    return summaries_.at({first.volume, first.node});
  }

  const Lattice& lattice(std::uint32_t volume) const {
    return forest_.volumes[volume].source->info().lattice;
  }

  // False where the budget refuses.
  bool split_first() {
    const Candidate first = *queue_.begin();
    const std::vector<NodeSummary>& summaries = children_of(first);
    const std::vector<NodeKey> keys = lattice(first.volume).children(first.key);
    Counts after = counts_;
    after.nodes += keys.size();
    count(after, forest_.volumes[first.volume].nodes[first.node], -1);
    for (std::size_t c = 0; c < keys.size(); ++c)
      count(after, leaf(first.volume, keys[c], summaries[c]), +1);
#if !defined(NEPHO_MUTANT_FOREST_BUDGET)
    if (double(cost(after)) > budget_bytes_) return false;
#endif

    queue_.erase(queue_.begin());
    std::vector<TreeNode>& nodes = forest_.volumes[first.volume].nodes;
    count(counts_, nodes[first.node], -1);
    nodes[first.node].kind = NodeKind::kInner;
    nodes[first.node].first_child = std::uint32_t(nodes.size());
    for (std::size_t c = 0; c < keys.size(); ++c) append(first.volume, keys[c], summaries[c]);
    summaries_.erase({first.volume, first.node});
    return true;
  }

  // Numbers the bricks and sun tiles in key order, then reads each brick once.
  static void read_bricks(VolumeTree& tree) {
    std::vector<std::uint32_t> order(tree.nodes.size());
    for (std::uint32_t n = 0; n < order.size(); ++n) order[n] = n;
#if !defined(NEPHO_MUTANT_FOREST_ORDER)
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return tree.nodes[a].key < tree.nodes[b].key;
    });
#endif
    tree.nodes.shrink_to_fit();
    tree.bricks.reserve(std::size_t(std::ranges::count_if(
        tree.nodes, [](const TreeNode& node) { return node.kind == NodeKind::kBrick; })));
    for (const std::uint32_t n : order) {
      TreeNode& node = tree.nodes[n];
      if (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant) continue;
      if (has_light(node)) node.lit = tree.lit_nodes++;
      if (node.kind != NodeKind::kBrick) continue;
      node.brick = std::uint32_t(tree.bricks.size());
      tree.bricks.emplace_back().key = node.key;
    }
    tbb::parallel_for(std::size_t{0}, tree.bricks.size(), [&](std::size_t b) {
      read_brick(*tree.source, tree.time_s, tree.bricks[b].key, tree.bricks[b]);
    });
  }

  const Refinement& refinement_;
  ViewMetric metric_;
  double budget_bytes_;
  Forest forest_;
  Counts counts_;
  bool any_hold_ = false, held_ = false;
  std::set<Candidate> queue_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<NodeSummary>> summaries_;
};

}  // namespace

Forest build_forest(std::span<const RenderVolume> volumes, const Refinement& refinement) {
  return Refiner(volumes, refinement).run();
}

const TreeNode& leaf_at(const VolumeTree& tree, int root, const Index3& finest_cell) {
  const Lattice& lattice = tree.source->info().lattice;
  const Index3& finest = lattice.cells(lattice.max_level());
  const TreeNode* node = &tree.nodes[std::size_t(root)];
  std::array<int, 3> bits;  // log2 of finest cells in a node
  for (std::size_t axis = 0; axis < 3; ++axis)
    bits[axis] = std::countr_zero(finest[axis] / lattice.cells(0)[axis] * kBrickCells);
  while (node->kind == NodeKind::kInner) {
    const SplitMask mask = lattice.split_axes(node->key.level());
    std::uint32_t child = 0, bit = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (splits(mask, axis))
        child |= (finest_cell[std::size_t(axis)] >> --bits[std::size_t(axis)] & 1) << bit++;
    node = &tree.nodes[node->first_child + child];
  }
  return *node;
}

}  // namespace nepho
