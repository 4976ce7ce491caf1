#include "sources/forecast/open_both.h"

#include <fstream>

#include "sources/grib/open_grib.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho {
namespace {

bool is_grib(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(4, '\0');
  in.read(bytes.data(), 4);
  return bytes == "GRIB";
}

}  // namespace

std::unique_ptr<forecast::Forecast> open_both(forecast::OpenRequest request, IoLock io_lock) {
  std::vector<std::string> grib_files, others;
  for (const std::string& path : request.files)
    (is_grib(path) ? grib_files : others).push_back(path);
  const forecast::UserNames names = forecast::read_user_names(request.names_file);
  const std::string grid_file = request.grid_file;
  grib::GribDomains domains(grib_files, io_lock, names);
  request.files = std::move(others);
  for (const std::string& path : domains.files()) request.files.push_back(path);
  request.open_file = [domains = std::move(domains), io_lock, names, grid_file](
                          const std::string& path) -> std::shared_ptr<const forecast::DataFile> {
    if (is_grib(path)) return domains.open(path);
    return netcdf::open_file(path, io_lock, path == grid_file ? forecast::UserNames{} : names);
  };
  return forecast::open_forecast(request);
}

}  // namespace nepho
