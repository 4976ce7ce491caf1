// NetCDF and GRIB files of one volume: domains of several models, told apart by their first bytes.
#include <algorithm>
#include <fstream>

#include "api/module_support.h"
#include "forecast/bricks/forecast_source.h"
#include "forecast/conventions/open_request.h"
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

// Parameters: those of open_request() and make_source().
std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  Parameters parameters(request);
  forecast::OpenRequest open = forecast::open_request(request, parameters, "forecast");
  std::vector<std::string> grib_files, others;
  for (const std::string& path : open.files) (is_grib(path) ? grib_files : others).push_back(path);
  grib::GribDomains domains(grib_files, request.io_lock);
  open.files = others;
  for (const std::string& path : domains.files()) open.files.push_back(path);
  open.open_file = [domains = std::move(domains), lock = request.io_lock](
                       const std::string& path) -> std::shared_ptr<const forecast::DataFile> {
    if (is_grib(path)) return domains.open(path);
    return netcdf::open_file(path, lock);
  };
  return forecast::make_source(request.volume_name ? request.volume_name : "",
                               forecast::open_forecast(open), parameters);
}

}  // namespace
}  // namespace nepho

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::open_source(*request); });
      }};
  return &module;
}
