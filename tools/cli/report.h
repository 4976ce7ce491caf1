#pragma once

#include <string>
#include <vector>

#include "common/open_scene.h"
#include "renderer.h"

namespace nepho {

// "error (estimated): integration 0.3 %, level of detail 1.2 %, quantisation 0.01 %, light model
// 30 % (16 paths a pixel)": what every render prints and stores.
std::string error_line(const ErrorEstimate& error);

// "1.2 %": two digits.
std::string percent_text(double part);

// Process so far: CPU of all threads, time since its start, largest resident size.
struct Usage {
  double cpu_s = 0, wall_s = 0, peak_mib = 0;
};
Usage usage_now();

// File names of the shared libraries that this process has mapped (/proc/self/maps), ascending.
std::vector<std::string> mapped_libraries();
// Those that were there at each step of a command, in this order.
struct Libraries {
  std::vector<std::string> start, format_known, device, scene_open, picture_written;
};

// What --explain prints: modules and the libraries that they ask for (`all`: each one that came
// with them), bricks, bytes, passes,
// switches, and what was left out.
std::string explanation(const OpenedScene& opened, const RenderResult& result,
                        const std::string& context, const Libraries& libraries, bool all);

}  // namespace nepho
