#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/cell_window.h"
#include "forecast/files/data_file.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

struct OpenRequest {
  std::vector<std::string> files;  // times of one forecast, or of nests; at least one
  // Of the format that they have: netCDF, GRIB.
  std::function<std::shared_ptr<const DataFile>(const std::string& path)> open_file;
  // Draw what is out of every cloud's range: more than 20 g/m3 of water, or 1 /m of extinction.
  bool force = false;
  std::string names_file;        // of a model that the table does not know (user_names.h); "": none
  std::string grid_file;         // of cells that are no rows and columns; "": the data's own
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
  int (*recognise)(const DataFile& file);
  std::unique_ptr<Forecast> (*open)(std::shared_ptr<const DataFile> file,
                                    const OpenRequest& request);
};

// Times of all parts in order. At least one part.
std::unique_ptr<Forecast> join_forecasts(std::vector<std::unique_ptr<Forecast>> parts);

// What one file holds, and the file's name for what is said of it.
struct NamedForecast {
  std::string name;
  std::unique_ptr<Forecast> forecast;
};

// Parts of one forecast (cells as wide within 2 %; at the same place, or at no time together: a
// nest that moves) become one domain, joined; several domains are drawn together, each in place of
// all coarser ones where it has cells with data. Their times are those of all; at each, a domain is
// at its nearest one, if that is within half of the longest step of any domain, or its only one. At
// least one part.
std::unique_ptr<Forecast> nest_forecasts(std::vector<NamedForecast> parts);

extern const Convention kWrf;  // WRF-ARW: wrf.cpp
extern const Convention kCf;   // CF and what is near to it: cf.cpp

}  // namespace nepho::forecast
