#include "live/live_error.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "reference/probe.h"

namespace nepho {

// The thread reads it, and owns nothing: a tree has textures, which end where they were made.
struct LiveError::Job {
  RenderRequest request;
  std::shared_ptr<const LiveTree> tree;
  HdrImage picture;
  double finest_mib = 0;
  std::atomic<bool> stop = false, done = false;
  ErrorEstimate estimate;        // once it is done
  std::optional<Error> failure;  // the same
  std::thread thread;

  void run();
  ~Job() {
    stop = true;
    if (thread.joinable()) thread.join();
  }
};

void LiveError::Job::run() {
  try {
    const auto tables = tree->planet ? tree->planet->tables() : nullptr;
    tbb::task_arena others(std::max(tbb::info::default_concurrency() - 1, 1));
    estimate = others.execute([&] {
      return estimate_error(request, tree->forest, picture, tables, {finest_mib, &stop});
    });
  } catch (const Error& error) {
    failure = error;
  } catch (const std::exception& error) {
    failure = Error({"no error line", "view", "", error.what(), ""});
  }
  picture = {};
  done = true;
}

LiveError::LiveError() = default;
LiveError::~LiveError() = default;

void LiveError::begin(const RenderRequest& request, std::shared_ptr<const LiveTree> tree,
                      const HdrImage& picture, double finest_mib) {
  if (job_ || ending()) return;
  job_ = std::make_unique<Job>();
  job_->request = request;
  job_->tree = std::move(tree);
  job_->picture = picture;
  job_->finest_mib = finest_mib;
  job_->thread = std::thread([job = job_.get()] { job->run(); });
}

void LiveError::drop() {
  if (!job_) return;
  job_->stop = true;
  // Of a job there is no other that ends: it was not begun before that one's end.
  if (job_->done)
    job_.reset();
  else
    ending_ = std::move(job_);
}

bool LiveError::under_way() const {
  return job_ && !job_->done;
}

bool LiveError::ending() {
  if (ending_ && ending_->done) ending_.reset();
  return ending_ != nullptr;
}

std::optional<ErrorEstimate> LiveError::result() const {
  if (!job_ || !job_->done) return std::nullopt;
  if (job_->failure) throw Error(*job_->failure);
  return job_->estimate;
}

}  // namespace nepho
