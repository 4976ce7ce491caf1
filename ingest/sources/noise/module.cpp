#include "api/module_support.h"
#include "sources/noise/noise_source.h"

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::noise::open_source(*request); });
      }};
  return &module;
}
