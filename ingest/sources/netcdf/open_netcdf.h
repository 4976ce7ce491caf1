#pragma once

#include "api/source_module.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/user_names.h"

namespace nepho::netcdf {

// `names` say what its variables hold. Throws Error.
std::shared_ptr<const forecast::DataFile> open_file(const std::string& path, IoLock io_lock,
                                                    const forecast::UserNames& names = {});

// open_forecast() of netCDF files. Throws Error.
std::unique_ptr<forecast::Forecast> open_netcdf(forecast::OpenRequest request, IoLock io_lock = {});

}  // namespace nepho::netcdf
