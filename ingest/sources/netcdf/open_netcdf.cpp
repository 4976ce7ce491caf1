#include "sources/netcdf/open_netcdf.h"

#include "forecast/conventions/user_names.h"
#include "sources/netcdf/nc_file.h"

namespace nepho::netcdf {

std::shared_ptr<const forecast::DataFile> open_file(const std::string& path, IoLock io_lock,
                                                    const forecast::UserNames& names) {
  const auto file = std::make_shared<NcFile>(path, io_lock);
  forecast::apply_names(names, *file);
  return file;
}

std::unique_ptr<forecast::Forecast> open_netcdf(forecast::OpenRequest request, IoLock io_lock) {
  const forecast::UserNames names = forecast::read_user_names(request.names_file);
  const std::string grid_file = request.grid_file;
  request.open_file = [io_lock, names, grid_file](const std::string& path) {
    return open_file(path, io_lock, path == grid_file ? forecast::UserNames{} : names);
  };
  return forecast::open_forecast(request);
}

}  // namespace nepho::netcdf
