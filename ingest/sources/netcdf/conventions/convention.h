#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell_window.h"
#include "forecast.h"
#include "nc_file.h"

namespace nepho::netcdf {

struct OpenRequest {
  std::vector<std::string> files;  // times of one forecast; at least one
  IoLock io_lock{};
  // Draw what is out of every cloud's range: more than 20 g/m3 of water, or 1 /m of extinction.
  bool force = false;
  std::optional<Region> region;  // all that is read; the whole file without one
};

// Recognises the files' convention and opens them. Reads the first time that holds data, so that
// what is refused is refused here. Throws Error.
std::unique_ptr<Forecast> open_forecast(const OpenRequest& request);

// A way in which models write files. Another model is one more row in convention.cpp, and one
// small file.
struct Convention {
  const char* name;
  // 0: not this one; the highest wins.
  int (*recognise)(const NcFile& file);
  std::unique_ptr<Forecast> (*open)(std::shared_ptr<const NcFile> file, const OpenRequest& request);
};

// Times of all parts in order. At least one part.
std::unique_ptr<Forecast> join_forecasts(std::vector<std::unique_ptr<Forecast>> parts);

extern const Convention kWrf;  // WRF-ARW: wrf.cpp
extern const Convention kCf;   // CF and what is near to it: cf.cpp

}  // namespace nepho::netcdf
