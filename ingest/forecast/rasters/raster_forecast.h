#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "forecast/forecast.h"
#include "forecast/rasters/raster_options.h"

namespace nepho::forecast {

// Fields over one grid, whatever format they come from.
struct Raster {
  std::string path;  // of the first file, for errors
  std::shared_ptr<const HorizontalGrid> grid;
  std::map<CloudQuantity, std::vector<float>> fields;  // SI, [j * nx + i]; NaN: nothing there
  std::int64_t utc_ns = 0;                             // 0: not known
  std::vector<std::string> assumptions, facts;
};

// A raster with its vertical model (cloud_column.h) as one time of a forecast: below each cloud a
// clear layer, the cloud in one layer (uniform) or eight (adiabatic), a clear one above. Each
// column's layers have its optical depth. Throws Error: nothing to see, no height, or, unless
// forced, values that no cloud has.
std::unique_ptr<Forecast> make_raster_forecast(Raster raster, const RasterOptions& options,
                                               bool force);

// Refuses, unless forced, fields with values that no cloud has; the units may be wrong.
void check_values(const Raster& raster);

}  // namespace nepho::forecast
