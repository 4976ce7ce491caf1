// A module that makes forecasts in closed form for the conformance suite: `mercator.synthetic` is
// the case mercator of synthetic_forecast.h; there is no such file.

#include <filesystem>

#include "sources/netcdf/netcdf_source.h"
#include "synthetic_forecast.h"

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] {
          const std::filesystem::path file = request->files[0];
          nepho::Parameters parameters(*request);
          return nepho::netcdf::make_source(request->volume_name,
                                            nepho::test::synthetic_forecast(file.stem().string()),
                                            parameters);
        });
      }};
  return &module;
}
