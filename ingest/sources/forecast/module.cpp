#include "api/module_support.h"
#include "forecast/bricks/forecast_source.h"
#include "forecast/conventions/open_request.h"
#include "sources/forecast/open_both.h"

namespace nepho {
namespace {

// Parameters: those of open_request() and make_source().
std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  Parameters parameters(request);
  const forecast::OpenRequest open = forecast::open_request(request, parameters, "forecast");
  return forecast::make_source(request.volume_name ? request.volume_name : "",
                               open_both(open, request.io_lock), parameters);
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
