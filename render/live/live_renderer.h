#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/error.h"
#include "renderer.h"

namespace nepho {

// What one update may do, so that no frame is held up.
struct LiveLimits {
  std::uint64_t upload_bytes = 4 << 20;  // of bricks
  int light_tiles = 64;
  double light_ms = 25;  // of wall time: fewer tiles where the device is slow
};

struct LiveStatus {
  std::uint64_t leaves = 0, nodes = 0;        // of the tree that is shown
  bool complete = false;                      // it is as fine as asked for
  bool budget_bound = false;                  // but for the budget
  std::uint64_t bytes = 0, budget_bytes = 0;  // in use, by the rules of the budget; and its limit
  std::uint64_t gpu_bytes = 0, cache_bytes = 0, planet_bytes = 0;  // the last apart from the budget
  std::uint64_t bricks_read = 0, bricks_remembered = 0, bricks_uploaded = 0, tiles_lit = 0;
  std::uint64_t stale_tiles = 0;  // shown with light that was worked out in an earlier tree
  std::uint64_t trees = 0;        // taken over so far
  int trees_held = 0;             // in memory, with what is being made
  std::uint64_t overruns = 0;     // rays of the last frame that llvmpipe cut off
  std::size_t programs = 0;
  std::vector<PassReport> passes;  // of the last frame
  std::optional<Error> failure;    // why there is no tree for the last request; the last one stays
};

// A renderer that keeps what it has from frame to frame. Trees are refined, and sources read, on a
// thread of their own, for the newest request; a finished tree is uploaded and lit over several
// updates, only where it differs from what is there, and then takes the place of the last. At rest
// a frame is the picture of render() with a tree at least as fine, where half of the budget holds
// it. Needs the OpenGL 4.5 core context that was current when it was made.
class LiveRenderer {
 public:
  // `request.settings.budget_mib` is kept by all that comes. Throws Error.
  explicit LiveRenderer(const RenderRequest& request, const LiveLimits& limits = {});
  ~LiveRenderer();

  // What frames show from now on: camera, sun, times, settings; its volumes are some of those that
  // this was made with, its budget the same. Costs nothing where nothing has changed.
  void set(const RenderRequest& request);
  // One step of upload and light. True where the next frame is another than the last.
  bool update();
  // update() has bricks to upload or light to work out: a picture made meanwhile is not the last.
  bool streaming() const;
  // Nothing is left to do for the last request (or it failed: status().failure).
  bool at_rest() const;
  // From the camera of the last request, in its size, with the tree that is there; empty before the
  // first. With `each`, a power of two that divides width and height: only every so many'th pixel
  // of rows and columns is marched; where nothing has changed, further frames march the others,
  // until the picture is whole, as it is with `each` 1. Until then the other pixels are those of
  // the frames before, moved to where they are seen now (pixel_reuse.h).
  HdrImage frame(int each = 1);
  // Without reuse (it is on at first), what was marched before a change is not used after it: the
  // first frame is a small picture of its own, and later ones have the nearest marched pixels.
  void reuse_pixels(bool reuse);
  // The last frame is all that there is to see: update() says when there is more.
  bool whole() const;
  LiveStatus status() const;
  // The error line of `frame`, the last one: worked out beside all else once it is whole and
  // nothing is left to do, so to be asked for again and again; nothing until it is there, and again
  // nothing from the next change on. Of settings.probe_pixels; finest bricks are read past what is
  // remembered. Throws Error where a source failed at that.
  std::optional<ErrorEstimate> error(const HdrImage& frame);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nepho
