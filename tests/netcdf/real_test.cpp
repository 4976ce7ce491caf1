// Files of models that no one of us wrote.

#include <gtest/gtest.h>

#include <cstdio>

#include "conventions/convention.h"
#include "core/error.h"

namespace nepho::netcdf {
namespace {

std::unique_ptr<Forecast> open(const std::string& name) {
  OpenRequest request;
  request.files = {std::string(NEPHO_TEST_REAL_DATA) + "/" + name};
  return open_forecast(request);
}

void print(const Forecast& f) {
  for (const auto& fact : f.facts()) std::printf("measured: fact: %s\n", fact.c_str());
  for (const auto& text : f.assumptions()) std::printf("measured: assumption: %s\n", text.c_str());
  std::printf("measured: heights %.1f to %.1f m, thinnest %.2f m, radius %.2f um, %zu times\n",
              f.height_range_m().x, f.height_range_m().y, f.thinnest_layer_m(),
              f.liquid_radius_m() * 1e6, f.times_s().size());
  const auto grid = f.grid(0);
  const auto low = grid->lat_lon_deg(0, 0), high = grid->lat_lon_deg(grid->nx(), grid->ny());
  std::printf("measured: grid %d x %d, around %d, %.4f %.4f to %.4f %.4f\n", grid->nx(), grid->ny(),
              int(grid->around()), low.x, low.y, high.x, high.y);
}

TEST(RealFiles, Katrina) {
  const auto f = open("nc/wrf_katrina_10km_nest_4t.nc");
  print(*f);
}

TEST(RealFiles, GfsPackedCf) {
  const auto f = open("nc/gfs_2p5deg_20110110_f120_DERIVED_cf_packed.nc");
  print(*f);
}
TEST(RealFiles, Um) {
  const auto f = open("nc/um_38lev_cosp_input_2d.nc");
  print(*f);
}
TEST(RealFiles, Icon) {
  const auto f = open("nc/icon_les_stratocumulus_L150.nc");
  print(*f);
}
TEST(RealFiles, Edges) {
  for (const char* name : {"byte_truncated", "netcdf-4d", "rotated_pole", "scale_offset"}) try {
      open(std::string("edge/gdal_") + name + ".nc");
      ADD_FAILURE() << name;
    } catch (const Error& e) {
      std::printf("measured: %s\n", e.what());
    }
  try {
    open("edge/psyplot_icon_test.nc");
    ADD_FAILURE();
  } catch (const Error& e) {
    std::printf("measured: %s\n", e.what());
  }
}

}  // namespace
}  // namespace nepho::netcdf
