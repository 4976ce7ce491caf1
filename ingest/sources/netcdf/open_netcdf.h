#pragma once

#include "api/source_module.h"
#include "forecast/conventions/convention.h"

namespace nepho::netcdf {

// Throws Error.
std::shared_ptr<const forecast::DataFile> open_file(const std::string& path, IoLock io_lock);

// open_forecast() of netCDF files. Throws Error.
std::unique_ptr<forecast::Forecast> open_netcdf(forecast::OpenRequest request, IoLock io_lock = {});

}  // namespace nepho::netcdf
