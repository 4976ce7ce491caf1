#pragma once

#include <optional>
#include <string>

#include "api/source_module.h"

namespace nepho::vdb {

enum class UpAxis { kY, kZ };

// What a request may say to this source; everything absent is worked out and said aloud.
struct Options {
  std::string volume_name, file;  // a file, or a pattern with '#' for the digits of the frame
  std::string grid;               // empty: "density", else the only float fog grid
  std::optional<double> density_scale_per_m;  // extinction of density 1
  std::optional<UpAxis> up;                   // y, z or auto
  std::optional<double> metres_per_unit;
  std::optional<long> frame;
  std::optional<double> frames_per_second;  // 24
};

// Throws Error on an unknown name, a wrong type or a value out of range.
Options parse_options(const SourceRequest& request);

}  // namespace nepho::vdb
