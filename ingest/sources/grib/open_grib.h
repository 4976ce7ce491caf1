#pragma once

#include "api/source_module.h"
#include "forecast/conventions/convention.h"

namespace nepho::grib {

// open_forecast() of GRIB files: all of them together, whatever fields and times each holds. Throws
// Error.
std::unique_ptr<forecast::Forecast> open_grib(forecast::OpenRequest request, IoLock io_lock = {});

}  // namespace nepho::grib
