#include "live/tree_worker.h"

#if defined(__linux__)
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#include <algorithm>

#include "reference/surface.h"

namespace nepho {
namespace {

constexpr std::uint32_t kFirstLeaves = 64, kMoreLeaves = 8;

// Frames are marched on the same processors, and come first: this thread, and those that it starts.
void yield_to_frames() {
#if defined(__linux__)
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, id_t(syscall(SYS_gettid)), kNice);
#endif
}

}  // namespace

TreeWorker::TreeWorker(const LiveBudget& budget, std::size_t most_sources)
    : budget_(budget),
      cache_bytes_each_(budget.cache_bytes / std::max<std::size_t>(most_sources, 1)),
      thread_([this] { run(); }) {}

TreeWorker::~TreeWorker() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    next_.reset();
    for (const auto& [source, cached] : sources_) cached->stop();
  }
  wake_.notify_one();
  thread_.join();
}

void TreeWorker::ask(const RenderRequest& request, bool from_coarse, std::uint64_t number,
                     bool give_up) {
  std::unique_ptr<LiveTree> given_up;  // ends without the lock
  {
    const std::lock_guard lock(mutex_);
#if defined(NEPHO_MUTANT_LIVE_FOURTH_TREE)
    give_up = false;
#endif
    if (give_up) given_up = std::move(finished_);
    // A request that was never begun may have been the one with new contents.
    const bool coarse = from_coarse || (next_ && next_->from_coarse);
    next_ = Task{std::make_shared<RenderRequest>(request), coarse, number};
    for (RenderVolume& volume : next_->request->volumes) {
      std::unique_ptr<CachedSource>& cached = sources_[volume.source];
      if (!cached) cached = std::make_unique<CachedSource>(*volume.source, cache_bytes_each_);
      volume.source = cached.get();
    }
  }
  wake_.notify_one();
}

std::unique_ptr<LiveTree> TreeWorker::take() {
  std::unique_ptr<LiveTree> taken;
  {
    const std::lock_guard lock(mutex_);
    taken = std::move(finished_);
  }
  if (taken) wake_.notify_one();
  return taken;
}

std::optional<Error> TreeWorker::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

bool TreeWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_ || next_;
}

std::uint64_t TreeWorker::rested() const {
  const std::lock_guard lock(mutex_);
  return rested_;
}

int TreeWorker::trees() const {
  const std::lock_guard lock(mutex_);
  return int(making_bytes_ > 0) + int(finished_ != nullptr);
}

std::uint64_t TreeWorker::tree_bytes() const {
  const std::lock_guard lock(mutex_);
  return making_bytes_ + (finished_ ? finished_bytes_ : 0);
}

CachedSource::Counts TreeWorker::cache_counts() const {
  const std::lock_guard lock(mutex_);
  CachedSource::Counts sum;
  for (const auto& [source, cached] : sources_) {
    const CachedSource::Counts counts = cached->counts();
    sum.bytes += counts.bytes;
    sum.bricks_read += counts.bricks_read;
    sum.bricks_remembered += counts.bricks_remembered;
  }
  return sum;
}

void TreeWorker::run() {
  yield_to_frames();
  for (;;) {
    std::optional<Task> task;
    {
      std::unique_lock lock(mutex_);
      busy_ = false;
      wake_.wait(lock, [&] { return stop_ || (next_ && room(budget_.tree_bytes)); });
      if (stop_) return;
      std::swap(task, next_);
      busy_ = true;
      failure_.reset();
    }
    make(*task);
  }
}

// One that waits to be taken and one that is being made are no more than one whole one.
bool TreeWorker::room(std::uint64_t bytes) const {
#if defined(NEPHO_MUTANT_LIVE_FOURTH_TREE)
  return true;
#endif
  return !finished_ || finished_bytes_ + bytes <= budget_.tree_bytes;
}

bool TreeWorker::wait_for_room(std::uint64_t bytes) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stop_ || next_ || room(bytes); });
  return !stop_ && !next_;
}

std::uint64_t TreeWorker::bytes_of(std::uint32_t leaves) const {
  return std::uint64_t(budget_.tree_mib(leaves) * 1024 * 1024);
}

bool TreeWorker::superseded() const {
  const std::lock_guard lock(mutex_);
  return stop_ || next_;
}

std::unique_ptr<LiveTree> TreeWorker::make_tree(const Task& task, std::uint32_t leaves, bool hold) {
  Refinement refinement = gl::refinement_of(*task.request);
  refinement.cost = budget_.cost;
  refinement.settings.budget_mib = budget_.tree_mib(leaves);
  refinement.light_unseen = true;
  if (hold)
    refinement.was_split = [&](std::uint32_t volume, NodeKey key) {
      const RenderVolume& of = task.request->volumes[volume];
      return splits_.contains({of.source, of.time_s, key});
    };
  {
    const std::lock_guard lock(mutex_);
    making_bytes_ = bytes_of(leaves);
  }
  struct Made {
    TreeWorker& worker;
    ~Made() {
      const std::lock_guard lock(worker.mutex_);
      worker.making_bytes_ = 0;
    }
  } const made{*this};
  auto tree = make_live_tree(task.request, refinement, tables_for(*task.request));
  tree->number = task.number;
  return tree;
}

void TreeWorker::hand_over(std::unique_ptr<LiveTree> tree) {
  const std::uint64_t bytes = tree->host_bytes();
  const std::lock_guard lock(mutex_);
  std::swap(finished_, tree);
  finished_bytes_ = bytes;
}

void TreeWorker::make(const Task& task) {
  const std::uint32_t most = budget_.most_leaves();
  if (task.from_coarse || leaves_ == 0) leaves_ = std::min(kFirstLeaves, most);
  for (bool whole = false, first = true;; first = false) {
    const std::uint32_t leaves = leaves_;
    const bool last = leaves >= most;
    if (!first && !wait_for_room(bytes_of(leaves))) return;
    leaves_ = std::min(leaves * kMoreLeaves, most);
    try {
      std::unique_ptr<LiveTree> tree = make_tree(task, leaves, true);
      whole = last || !tree->forest.budget_bound;
      const bool held = tree->forest.held;
      tree->complete = whole && !held;
      if (whole) remember_splits(*tree);
      hand_over(std::move(tree));
      if (whole) leaves_ = most;
#if defined(NEPHO_MUTANT_LIVE_HELD)
      if (whole && held) rest(task);
#else
      if (whole && held) make_rested(task);
#endif
      if (whole || superseded()) return;
    } catch (const Error& error) {
      if (!last && !whole) continue;  // a few leaves may not hold all roots
      return fail(error);
    } catch (const std::exception& error) {
      return fail(Error({"a tree could not be made", "view", "", error.what(), ""}));
    }
  }
}

// Once nothing newer is asked for: in motion trees hold on to splits, and no picture at rest is to
// depend on where the eye was before.
void TreeWorker::make_rested(const Task& task) {
  if (!wait_for_room(budget_.tree_bytes)) return;
  std::unique_ptr<LiveTree> tree = make_tree(task, budget_.most_leaves(), false);
  const bool another = remember_splits(*tree);
  tree->complete = true;
  another ? hand_over(std::move(tree)) : rest(task);
}

void TreeWorker::rest(const Task& task) {
  const std::lock_guard lock(mutex_);
  rested_ = task.number;
}

void TreeWorker::fail(const Error& error) {
  const std::lock_guard lock(mutex_);
  failure_ = error;
}

std::shared_ptr<const AirTables> TreeWorker::tables_for(const RenderRequest& request) {
  if (!request.planet || !request.planet->air) return nullptr;
  const glm::dvec3 albedo = mean_ground_albedo(request);
  if (!tables_ || albedo != tables_albedo_) {
    tables_ = std::make_shared<const AirTables>(
        make_air_tables(*request.planet->air, request.planet->body.equatorial_m, albedo));
    tables_albedo_ = albedo;
  }
  return tables_;
}

bool TreeWorker::remember_splits(const LiveTree& tree) {
  std::set<SlotKey> splits;
  for (const VolumeTree& volume : tree.forest.volumes)
    for (const TreeNode& node : volume.nodes)
      if (node.kind == NodeKind::kInner) splits.insert({volume.source, volume.time_s, node.key});
  const bool others = !std::ranges::equal(
      splits, splits_, [](const SlotKey& a, const SlotKey& b) { return a.order() == b.order(); });
  splits_ = std::move(splits);
  return others;
}

}  // namespace nepho
