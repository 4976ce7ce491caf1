#pragma once

#include <array>

#include <epoxy/gl.h>

namespace nepho::gl {

// The GPU's own time between two places in its stream of commands: a pair of TIMESTAMP queries. Not
// from a rasteriser that runs on the CPU (llvmpipe and its like): its stamps are those of a wall
// clock at the moment of the call, while its work is spread over threads; process CPU time is what
// counts there. Needs a current context.
class GpuClock {
 public:
  GpuClock();  // the first place
  ~GpuClock();
  GpuClock(const GpuClock&) = delete;
  GpuClock& operator=(const GpuClock&) = delete;

  // The second place, to be called once; waits for the GPU. Seconds, or -1 where this device has no
  // such clock, or one that says what cannot be: 0, or more than has passed on the wall.
  double stop_s();

  // Whether this context's device tells its own time, and in words why not.
  static const char* why_not();  // null: it does

 private:
  std::array<GLuint, 2> queries_{};
  double wall_start_s_ = 0;
};

}  // namespace nepho::gl
