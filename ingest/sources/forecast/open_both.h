#pragma once

#include "api/source_module.h"
#include "forecast/conventions/convention.h"

namespace nepho {

// open_forecast() of NetCDF and GRIB files together, told apart by their first bytes: domains of
// several models, or GRIB's triangles and the NetCDF file that says where they are. Throws Error.
std::unique_ptr<forecast::Forecast> open_both(forecast::OpenRequest request, IoLock io_lock = {});

}  // namespace nepho
