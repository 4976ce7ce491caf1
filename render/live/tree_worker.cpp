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

void TreeWorker::ask(const RenderRequest& request, bool from_coarse, std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    // A request that was never begun may have been the one with new contents.
    const bool coarse = from_coarse || (next_ && next_->from_coarse);
    next_ = Task{request, coarse, number};
    for (RenderVolume& volume : next_->request.volumes) {
      std::unique_ptr<CachedSource>& cached = sources_[volume.source];
      if (!cached) cached = std::make_unique<CachedSource>(*volume.source, cache_bytes_each_);
      volume.source = cached.get();
    }
  }
  wake_.notify_one();
}

std::unique_ptr<LiveTree> TreeWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::move(finished_);
}

std::optional<Error> TreeWorker::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

bool TreeWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_ || next_;
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
      wake_.wait(lock, [&] { return stop_ || next_; });
      if (stop_) return;
      std::swap(task, next_);
      busy_ = true;
      failure_.reset();
    }
    make(std::move(*task));
  }
}

bool TreeWorker::superseded() const {
  const std::lock_guard lock(mutex_);
  return stop_ || next_;
}

void TreeWorker::make(Task task) {
  const auto request = std::make_shared<const RenderRequest>(std::move(task.request));
  Refinement refinement = gl::refinement_of(*request);
  refinement.cost = budget_.cost;
  refinement.light_unseen = true;
  refinement.was_split = [&](std::uint32_t volume, NodeKey key) {
    const RenderVolume& of = request->volumes[volume];
    return splits_.contains({of.source, of.time_s, key});
  };
  const std::uint32_t most = budget_.most_leaves();
  if (task.from_coarse || leaves_ == 0) leaves_ = std::min(kFirstLeaves, most);
  for (;;) {
    const bool last = leaves_ >= most;
    bool complete = last;
    refinement.settings.budget_mib = budget_.tree_mib(leaves_);
    leaves_ = std::min(leaves_ * kMoreLeaves, most);
    try {
      std::unique_ptr<LiveTree> tree = make_live_tree(request, refinement, tables_for(*request));
      complete = last || !tree->forest.budget_bound;
      tree->complete = complete;
      tree->number = task.number;
      if (complete) remember_splits(*tree);
      const std::lock_guard lock(mutex_);
      finished_ = std::move(tree);
    } catch (const Error& error) {
      if (!last) continue;  // a few leaves may not hold all roots
      const std::lock_guard lock(mutex_);
      failure_ = error;
      return;
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      failure_ = Error({"a tree could not be made", "view", "", error.what(), ""});
      return;
    }
    if (complete) leaves_ = most;
    if (complete || superseded()) return;
  }
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

void TreeWorker::remember_splits(const LiveTree& tree) {
  splits_.clear();
  for (const VolumeTree& volume : tree.forest.volumes)
    for (const TreeNode& node : volume.nodes)
      if (node.kind == NodeKind::kInner) splits_.insert({volume.source, volume.time_s, node.key});
}

}  // namespace nepho
