#include "api/module_support.h"
#include "forecast/bricks/forecast_source.h"
#include "forecast/conventions/open_request.h"
#include "sources/grib/open_grib.h"

namespace nepho::grib {
namespace {

// Parameters: those of open_request() and make_source().
std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  Parameters parameters(request);
  const forecast::OpenRequest open = forecast::open_request(request, parameters, "grib");
  return forecast::make_source(request.volume_name ? request.volume_name : "",
                               open_grib(open, request.io_lock), parameters);
}

}  // namespace
}  // namespace nepho::grib

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::grib::open_source(*request); });
      }};
  return &module;
}
