#include "sources/netcdf/open_netcdf.h"

#include "sources/netcdf/nc_file.h"

namespace nepho::netcdf {

std::shared_ptr<const forecast::DataFile> open_file(const std::string& path, IoLock io_lock) {
  return std::make_shared<const NcFile>(path, io_lock);
}

std::unique_ptr<forecast::Forecast> open_netcdf(forecast::OpenRequest request, IoLock io_lock) {
  request.open_file = [io_lock](const std::string& path) { return open_file(path, io_lock); };
  return forecast::open_forecast(request);
}

}  // namespace nepho::netcdf
