#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "core/error.h"
#include "live/cached_source.h"
#include "live/live_budget.h"
#include "live/live_tree.h"

namespace nepho {

// Makes trees on a thread of its own, for the newest request; whoever shows them never waits.
class TreeWorker {
 public:
  // `most_sources`: that the memory for bricks is shared by.
  TreeWorker(const LiveBudget& budget, std::size_t most_sources);
  ~TreeWorker();

  // `from_coarse`: trees of few leaves come first, each of eight times more. `request` is one of
  // sources that outlive this; its trees bear `number`. A finished tree that was not taken is given
  // up where `give_up` says so, and otherwise waited for: there is memory for one whole tree here.
  void ask(const RenderRequest& request, bool from_coarse, std::uint64_t number, bool give_up);
  // The newest tree that is finished and was not taken yet, or null. A tree lives no longer than
  // this.
  std::unique_ptr<LiveTree> take();
  // Why the last request has no tree.
  std::optional<Error> failure() const;
  bool busy() const;
  // The last request whose tree depends on nothing that was before it.
  std::uint64_t rested() const;
  // How many trees are here, finished or being made, and no more than what they take.
  int trees() const;
  std::uint64_t tree_bytes() const;
  CachedSource::Counts cache_counts() const;

 private:
  struct Task {
    std::shared_ptr<RenderRequest> request;
    bool from_coarse;
    std::uint64_t number;
  };
  void run();
  void make(const Task& task);
  std::unique_ptr<LiveTree> make_tree(const Task& task, std::uint32_t leaves, bool hold);
  // Where the tree of `task` is another than it would be without those before: the latter.
  void make_rested(const Task& task);
  void hand_over(std::unique_ptr<LiveTree> tree);
  void rest(const Task& task);  // its tree is as it would be without those before
  void fail(const Error& error);
  bool superseded() const;
  bool room(std::uint64_t bytes) const;     // under the lock
  bool wait_for_room(std::uint64_t bytes);  // false: superseded
  std::uint64_t bytes_of(std::uint32_t leaves) const;
  std::shared_ptr<const AirTables> tables_for(const RenderRequest& request);
  bool remember_splits(const LiveTree& tree);  // true: others than before

  LiveBudget budget_;
  std::uint64_t cache_bytes_each_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Task> next_;
  std::unique_ptr<LiveTree> finished_;
  std::uint64_t finished_bytes_ = 0, making_bytes_ = 0, rested_ = 0;
  std::optional<Error> failure_;
  bool busy_ = false, stop_ = false;
  std::map<const BrickSource*, std::unique_ptr<CachedSource>> sources_;

  // Of the worker's thread only.
  std::set<SlotKey> splits_;  // of the last complete tree
  std::uint32_t leaves_ = 0;  // of the next tree: it goes on where a request was left
  std::shared_ptr<const AirTables> tables_;
  glm::dvec3 tables_albedo_{-1.0};
  std::thread thread_;
};

}  // namespace nepho
