#pragma once

#include <memory>
#include <vector>

#include "forecast/rasters/raster_options.h"
#include "sources/gdal/raster_file.h"

namespace nepho::gdal {

// One band that holds something of a cloud.
struct CloudBand {
  std::size_t file;
  int band;
  forecast::CloudQuantity quantity;
  Unit unit;
};

// What the files' bands are: as the user states, or as their metadata do. Throws Error where no
// band is of a cloud, where two are the same, and where a unit is missing.
std::vector<CloudBand> cloud_bands(const std::vector<std::unique_ptr<RasterFile>>& files,
                                   const forecast::RasterOptions& options);

}  // namespace nepho::gdal
