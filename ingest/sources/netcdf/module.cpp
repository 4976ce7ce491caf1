#include "api/module_support.h"
#include "forecast/bricks/forecast_source.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::netcdf {
namespace {

// Parameters beside those of make_source():
//   force   1 draws what is out of every cloud's range, and is else refused (0)
//   grid    a file with the places of the cells (triangles, Voronoi's cells); the data's own
//   region  "SOUTH,WEST,NORTH,EAST" in degrees: only cells there are read (the whole file)
std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  const std::string name = request.volume_name ? request.volume_name : "";
  if (request.file_count == 0)
    throw Error({"a netcdf volume without a file", "volume '" + name + "'",
                 "one file, or several that hold times of one forecast", "none", ""});
  Parameters parameters(request);
  forecast::OpenRequest open;
  open.files.assign(request.files, request.files + request.file_count);
  open.force = parameters.integer("force", 0, 0, 1) == 1;
  open.grid_file = parameters.word("grid", "");
  if (const std::string region = parameters.word("region", ""); !region.empty())
    open.region = forecast::parse_region(region, parameters.where("region"));
  return forecast::make_source(name, open_netcdf(open, request.io_lock), parameters);
}

}  // namespace
}  // namespace nepho::netcdf

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::netcdf::open_source(*request); });
      }};
  return &module;
}
