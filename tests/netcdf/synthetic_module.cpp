// A module that makes forecasts in closed form for the conformance suite: `mercator.synthetic` is
// the case mercator of synthetic_forecast.h, `mercator_box.synthetic` the same in cubes around the
// planet; there are no such files.

#include <filesystem>

#include "forecast/bricks/forecast_source.h"
#include "synthetic_forecast.h"

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] {
          std::string name = std::filesystem::path(request->files[0]).stem().string();
          nepho::SourceRequest own = *request;
          const nepho::RequestParameter cubes[] = {{"chart", "box", 0, ""},
                                                   {"max_level", nullptr, 10, ""}};
          if (name.ends_with("_box")) {
            name.resize(name.size() - 4);
            own.parameters = cubes;
            own.parameter_count = 2;
          }
          nepho::Parameters parameters(own);
          return nepho::forecast::make_source(request->volume_name,
                                              nepho::test::synthetic_forecast(name), parameters);
        });
      }};
  return &module;
}
