#include "sources/grib/open_grib.h"

#include "sources/grib/grib_file.h"

namespace nepho::grib {

std::unique_ptr<forecast::Forecast> open_grib(forecast::OpenRequest request, IoLock io_lock) {
  const std::vector<std::string> files = request.files;
  // The forecast's files are one; a grid file is its own.
  request.open_file = [files, io_lock](const std::string& path) {
    return std::make_shared<const GribFile>(
        path == files.front() ? files : std::vector<std::string>{path}, io_lock);
  };
  if (files.size() > 1) request.files.resize(1);
  return forecast::open_forecast(request);
}

}  // namespace nepho::grib
