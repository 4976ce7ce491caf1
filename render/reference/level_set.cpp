#include "reference/level_set.h"

#include <array>
#include <atomic>
#include <mutex>
#include <unordered_map>

#include "tree/source_verbs.h"

namespace nepho {
namespace {

constexpr std::size_t kShards = 64;

std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  return h ^ h >> 32;
}

struct VolumeKey {
  std::size_t volume;
  NodeKey key;
  bool operator==(const VolumeKey&) const = default;
};
struct VolumeKeyHash {
  std::size_t operator()(const VolumeKey& k) const {
    return mixed(k.key.packed() ^ k.volume * 0x9e3779b97f4a7c15u);
  }
};

// The node of a level that holds a cell of the finest lattice.
NodeKey node_of(const Lattice& lattice, int root, const Index3& finest_cell, int level) {
  const Index3 &finest = lattice.cells(lattice.max_level()), &own = lattice.cells(level);
  const auto at = [&](std::size_t a) {
    return finest_cell[a] / (finest[a] / own[a]) / kBrickCells;
  };
  return {root, level, at(0), at(1), at(2)};
}

}  // namespace

LevelLeaf CutLevels::leaf(std::size_t volume, int root, const Index3& finest_cell) const {
  const VolumeTree& tree = forest_.volumes[volume];
  const TreeNode& node = leaf_at(tree, root, finest_cell);
  LevelLeaf leaf{
      .key = node.key, .kind = node.kind, .constant_per_m = 0, .brick = nullptr, .lit = node.lit};
  if (node.kind == NodeKind::kConstant) leaf.constant_per_m = double(node.constant_per_m);
  if (node.kind == NodeKind::kBrick)  // the forest owns it: no count to keep
    leaf.brick = {std::shared_ptr<const LeafBrick>(), &tree.bricks[node.brick]};
  return leaf;
}

double NoisyCutLevels::noise_per_m(std::size_t volume, const LevelLeaf& leaf,
                                   const Index3& global) const {
  const VolumeInfo& own = info(volume);
  const Index3& n = own.lattice.cells(leaf.key.level());
  Column column{leaf.key.root(), global[0], global[1]};
  if (column.i == 0 || column.i == n[0] || column.j == 0 || column.j == n[1])
    column = own.chart->names(column, n).owner();
  std::uint64_t h = mixed(seed_ + volume * 0x9e3779b97f4a7c15u + std::uint64_t(leaf.key.level()));
  h = mixed(h ^ (std::uint64_t(column.root) << 32 | column.i));
  h = mixed(h ^ (std::uint64_t(column.j) << 32 | global[2]));
  return double(leaf.brick->scale) * (double(h >> 11) * 0x1p-53 - 0.5);
}

struct FinestLevels::Cache {
  struct Shard {
    std::mutex mutex;
    std::unordered_map<VolumeKey, NodeSummary, VolumeKeyHash> summaries;
    std::unordered_map<VolumeKey, std::shared_ptr<const LeafBrick>, VolumeKeyHash> bricks;
  };
  std::array<Shard, kShards> shards;
  std::size_t bricks_per_shard = 0, summaries_per_shard = 0;
  std::atomic<std::uint64_t> bricks_read = 0;

  Shard& shard(const VolumeKey& key) { return shards[VolumeKeyHash()(key) % kShards]; }
};

FinestLevels::FinestLevels(std::span<const RenderVolume> volumes, double cache_mib,
                           const Forest* cut, int finer)
    : volumes_(volumes.begin(), volumes.end()),
      cut_(cut),
      finer_(finer),
      cache_(std::make_unique<Cache>()) {
  for (const RenderVolume& volume : volumes_) tells_ice_.push_back(has_ice(volume.source->info()));
  // A quarter for summaries: there are 8/7 of them for each brick, and they are 30 times smaller.
  const double bytes = cache_mib * 1024 * 1024 / double(kShards);
  cache_->bricks_per_shard = std::size_t(0.75 * bytes / sizeof(LeafBrick)) + 1;
  cache_->summaries_per_shard = std::size_t(0.25 * bytes / (2 * sizeof(NodeSummary))) + 1;
}

FinestLevels::~FinestLevels() = default;

std::uint64_t FinestLevels::bricks_read() const {
  return cache_->bricks_read;
}

NodeSummary FinestLevels::summary(std::size_t volume, NodeKey key) const {
  Cache::Shard& shard = cache_->shard({volume, key});
  {
    const std::lock_guard lock(shard.mutex);
    const auto known = shard.summaries.find({volume, key});
    if (known != shard.summaries.end()) return known->second;
  }
  const RenderVolume& v = volumes_[volume];
  NodeSummary summary;
  throw_on_failure(v.source->summary(key, v.time_s, summary), *v.source, "summarise", key);
  const std::lock_guard lock(shard.mutex);
  if (shard.summaries.size() >= cache_->summaries_per_shard) shard.summaries.clear();
  shard.summaries.insert({{volume, key}, summary});
  return summary;
}

std::shared_ptr<const LeafBrick> FinestLevels::brick(std::size_t volume, NodeKey key) const {
  Cache::Shard& shard = cache_->shard({volume, key});
  {
    const std::lock_guard lock(shard.mutex);
    const auto known = shard.bricks.find({volume, key});
    if (known != shard.bricks.end()) return known->second;
  }
  const RenderVolume& v = volumes_[volume];
  auto brick = std::make_shared<LeafBrick>();
  read_brick(*v.source, v.time_s, key, *brick);
  const std::lock_guard lock(shard.mutex);
  if (shard.bricks.size() >= cache_->bricks_per_shard) shard.bricks.clear();
  const auto [at, inserted] = shard.bricks.insert({{volume, key}, std::move(brick)});
  if (inserted) ++cache_->bricks_read;  // by two threads at once: one
  return at->second;
}

LevelLeaf FinestLevels::leaf(std::size_t volume, int root, const Index3& finest_cell) const {
  const Lattice& lattice = info(volume).lattice;
  int finest = lattice.max_level(), level = 0;
  if (cut_) {  // what it split is not the same as something coarser
    level = leaf_at(cut_->volumes[volume], root, finest_cell).key.level();
    finest = std::min(finest, level + finer_);
  }
  for (;; ++level) {
    const NodeKey key = node_of(lattice, root, finest_cell, level);
    const NodeSummary s = summary(volume, key);
    const bool last = level == finest;
    const bool empty = s.empty && (last || s.children == 0 || s.error_bound_per_m == 0);
    if (empty || (s.constant && s.constant_extinction_per_m == 0))
      return {.key = key, .kind = NodeKind::kEmpty, .constant_per_m = 0, .brick = nullptr};
    // Of a constant, the part that is ice is only in bricks.
    if (s.constant && !tells_ice_[volume])
      return {.key = key,
              .kind = NodeKind::kConstant,
              .constant_per_m = double(s.constant_extinction_per_m),
              .brick = nullptr};
    if (last || s.error_bound_per_m == 0 || s.constant)
      return {
          .key = key, .kind = NodeKind::kBrick, .constant_per_m = 0, .brick = brick(volume, key)};
  }
}

}  // namespace nepho
