#pragma once

#include <filesystem>

#include "nc_output.h"

namespace nepho::samples {

// A global analysis as ecCodes makes it of GRIB: pressure levels with geopotential height, 16-bit
// packing in which zero unpacks to a small negative number, latitudes from north to south,
// longitudes 0..360. Swirls of mid-latitude cyclones, the tropical convergence zone, stratocumulus
// off the subtropical west coasts, cirrus.
struct GlobalShape {
  std::size_t nx = 144, ny = 73;
};

// One level is in memory at a time. Throws Error.
void write_global(const NcWriter& writer, const std::filesystem::path& path,
                  const GlobalShape& shape);

}  // namespace nepho::samples
