#pragma once

#include <functional>

#include "nc_output.h"

namespace nepho::samples {

// A file with the names, attributes, staggering and units of WRF-ARW 4 (Skamarock et al. 2019,
// A Description of the Advanced Research WRF Model Version 4), of the weather in weather.h.
// Hydrostatic, saturated in cloud; terrain-following mass coordinate (HYBRID_OPT 0).
struct WrfShape {
  std::size_t nx = 96, ny = 96, nz = 40, times = 1;
  double cell_m = 2000;
  double minutes_between = 60;
  double nest_step_m = 0;  // by which the domain moves east and north with each time
};

// Traps of real files: `layout` changes what is written of a variable, `slab` its values.
struct WrfChange {
  std::function<void(NcLayout&)> layout;
  std::function<void(const std::string& field, std::size_t time, std::vector<double>&)> slab;
};

// One level is in memory at a time. Throws Error.
void write_wrf(const NcWriter& writer, const std::filesystem::path& path, const WrfShape& shape,
               const WrfChange& change = {});

}  // namespace nepho::samples
