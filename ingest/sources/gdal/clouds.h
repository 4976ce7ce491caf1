#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/cell_window.h"
#include "forecast/forecast.h"
#include "forecast/rasters/raster_options.h"

namespace nepho::gdal {

struct CloudRequest {
  std::vector<std::string> files;  // each holds other quantities
  forecast::RasterOptions options;
  std::optional<forecast::Region> region;  // all that is read; the whole raster without one
  bool force = false;
  double most_cells = 4e6;  // of the grid; a finer raster is read in blocks
};

// The grid is that of the first file with a band of clouds; other files are taken at its cells'
// centres. Blocks of a fine raster keep their mean optical depth and water, their heights are means
// weighted by it. Throws Error.
std::unique_ptr<forecast::Forecast> open_clouds(const CloudRequest& request);

}  // namespace nepho::gdal
