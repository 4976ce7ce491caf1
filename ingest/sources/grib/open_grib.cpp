#include "sources/grib/open_grib.h"

#include "sources/grib/grib_file.h"

namespace nepho::grib {

std::unique_ptr<forecast::Forecast> open_grib(forecast::OpenRequest request, IoLock io_lock) {
  const std::vector<std::string> files = request.files;
  // The forecast's files are one; a grid file is its own.
  const forecast::UserNames names = forecast::read_user_names(request.names_file);
  request.open_file = [files, io_lock, names](const std::string& path) {
    const auto file = std::make_shared<GribFile>(
        path == files.front() ? files : std::vector<std::string>{path}, io_lock, names);
    if (path == files.front()) forecast::apply_names(names, *file);
    return file;
  };
  if (files.size() > 1) request.files.resize(1);
  return forecast::open_forecast(request);
}

}  // namespace nepho::grib
