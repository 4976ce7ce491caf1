#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer.h"
#include "scene/scene.h"

namespace nepho {

// A flight as it was flown, one camera a frame: JSON, ECEF metres, the same bits when it is read.
struct CameraPath {
  std::vector<Camera> cameras;
};
CameraPath read_camera_path(const std::filesystem::path& file);  // throws Error
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

// What the frames of a flight cost.
struct FrameTimes {
  double gap_ms = 0;  // wall time until the next
  double cpu_ms = 0;  // of it the thread's own CPU time
  std::vector<PassReport> passes;
};
// Of gaps by the wall, of each pass by the process's CPU time, and by the GPU where it has a clock:
// median and worst.
struct PassTimes {
  std::string name, clock;  // wall, cpu or gpu
  std::size_t frames = 0;
  double median_ms = 0, worst_ms = 0;
};
std::vector<PassTimes> summarise(const std::vector<FrameTimes>& frames);
// .csv or .json, by the ending; throws Error.
void write_pass_times(const std::filesystem::path& file, const std::vector<PassTimes>& times);
// "below 17 ms: 40, below 34 ms: 2, ..., longest block 80 ms, at most 20 ms of CPU".
std::string gap_histogram(const std::vector<FrameTimes>& frames);
double thread_cpu_s();  // of the thread that calls it

}  // namespace nepho
