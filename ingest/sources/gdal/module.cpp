#include "api/module_support.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "forecast/bricks/forecast_source.h"
#include "forecast/conventions/open_request.h"
#include "pyramid/serve.h"
#include "sources/gdal/clouds.h"
#include "sources/gdal/terrain.h"

namespace nepho::gdal {
namespace {

// A ground without clouds.
class TerrainSource final : public BrickSource {
 public:
  explicit TerrainSource(Terrain terrain)
      : chart_(std::make_shared<ShellChart>(Ellipsoid::wgs84(), -1000, 20000)),
        empty_(*chart_, Lattice({}), {{}, [](NodeKey, double*) {}, {}}) {
    info_.name = "terrain";
    info_.chart = chart_;
    info_.on_planet = true;
    info_.surface = std::move(terrain.map);
    info_.source_bytes = info_.surface->height_m.size() * 2 * sizeof(float);
    info_.assumptions = std::move(terrain.assumptions);
    info_.facts = std::move(terrain.facts);
  }
  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return serve_summary(info_, empty_, key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    return serve_read(info_, empty_, key, time_s, brick);
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  std::shared_ptr<const ShellChart> chart_;
  SparsePyramid empty_;
  VolumeInfo info_;
};

// Parameters: those of open_request(), raster_options() and make_source(); and
//   use   clouds | terrain: heights of ground (terrain.h), a source without clouds
//   gaps  of terrain: sea | nan
std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  Parameters parameters(request);
  const bool terrain = parameters.choice("use", {"clouds", "terrain"}) == "terrain";
  forecast::OpenRequest open = forecast::open_request(request, parameters, "gdal");
  if (terrain) {
    TerrainRequest wanted{open.files.front(), open.region};
    wanted.keep_gaps = parameters.choice("gaps", {"sea", "nan"}) == "nan";
    parameters.finish();
    return std::make_unique<TerrainSource>(open_terrain(wanted));
  }
  if (!open.grid_file.empty())
    throw Error(
        {"a raster has its own grid", parameters.where("grid"), "none", open.grid_file, ""});
  const CloudRequest clouds{std::move(open.files), std::move(open.raster), open.region, open.force};
  return forecast::make_source(request.volume_name ? request.volume_name : "", open_clouds(clouds),
                               parameters);
}

}  // namespace
}  // namespace nepho::gdal

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::gdal::open_source(*request); });
      }};
  return &module;
}
