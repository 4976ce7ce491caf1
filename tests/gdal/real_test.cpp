// Rasters that no one of us wrote.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "sources/gdal/clouds.h"
#include "sources/gdal/terrain.h"

namespace nepho::gdal::test {
namespace {

const std::string kData = std::string(NEPHO_TEST_REAL_DATA) + "/raster/";

// SRTM, 3 seconds of arc, 387 to 3727 m: the Wildspitze (3768 m, its pixels 3727 m at most) stands
// at 46.885 N 10.867 E.
TEST(GdalReal, MountainsStandWhereTheyDo) {
  const Terrain terrain = open_terrain({kData + "dem_srtm_oetztal.tif", {}, 4096});
  const SurfaceMap& map = *terrain.map;
  const auto [low, high] = std::ranges::minmax(map.height_m);
  EXPECT_NEAR(double(high), 3727, 30);
  const auto at = std::size_t(std::ranges::max_element(map.height_m) - map.height_m.begin());
  const double x = map.low_rad.x + double(int(at) % map.nx) * map.step_rad.x,
               y = map.low_rad.y + double(int(at) / map.nx) * map.step_rad.y;
  const glm::dvec3 u =
      map.axes * glm::dvec3(std::cos(y) * std::cos(x), std::cos(y) * std::sin(x), std::sin(y));
  // Scaled space has parametric latitudes.
  const double latitude_deg =
      std::atan2(u.z * 6378137.0 / 6356752.3142, std::hypot(u.x, u.y)) * 180 / M_PI;
  EXPECT_NEAR(latitude_deg, 46.885, 0.004);
  EXPECT_NEAR(std::atan2(u.y, u.x) * 180 / M_PI, 10.867, 0.004);
  std::printf("measured: highest %.0f m at %.4f N %.4f E\n", double(high), latitude_deg,
              std::atan2(u.y, u.x) * 180 / M_PI);
}

TEST(GdalReal, APhotoIsNoCloudAndNoGround) {
  CloudRequest request;
  request.files = {kData + "rasterio_world.rgb.tif"};
  EXPECT_THROW(open_clouds(request), Error);
  EXPECT_THROW(open_terrain({request.files[0], {}, 4096}), Error);
}

}  // namespace
}  // namespace nepho::gdal::test
