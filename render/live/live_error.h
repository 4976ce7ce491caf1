#pragma once

#include <memory>
#include <optional>

#include "core/error.h"
#include "live/live_tree.h"
#include "renderer.h"

namespace nepho {

// The error line of a picture that stands still (reference/probe.h), worked out on a thread of its
// own, with one processor left to whoever shows the picture. No call waits.
class LiveError {
 public:
  LiveError();
  ~LiveError();
  LiveError(const LiveError&) = delete;
  LiveError& operator=(const LiveError&) = delete;

  // Begins, but where something is known, under way or ending. `request`: what `picture` is of,
  // with the sources that the finest bricks come from; `finest_mib`: for those.
  void begin(const RenderRequest& request, std::shared_ptr<const LiveTree> tree,
             const HdrImage& picture, double finest_mib);
  // What is known or under way is of a picture that is no more.
  void drop();
  bool under_way() const;
  // The ray in hand of what was dropped is not at its end: its tree is held.
  bool ending();
  // Nothing until it is there. Throws Error where a source failed, once more at each call.
  std::optional<ErrorEstimate> result() const;

 private:
  struct Job;
  std::unique_ptr<Job> job_, ending_;
};

}  // namespace nepho
