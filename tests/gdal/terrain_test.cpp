// Heights of ground as a planet's surface: where they lie, what is read of them, what is refused.

#include "sources/gdal/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy_report.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "made_raster.h"
#include "test_folder.h"

namespace nepho::gdal::test {
namespace {

// Written from the definition in surface_map.h; bilinear, as the renderers do.
struct Ground {
  double height_m = 0, water = 1;
};
Ground ground_at(const SurfaceMap& map, double latitude_deg, double longitude_deg) {
  const Ellipsoid body = Ellipsoid::wgs84();
  const double lat = latitude_deg * M_PI / 180, lon = longitude_deg * M_PI / 180;
  const glm::dvec3 p = geodetic_to_ecef_m(body, lat, lon, 0);
  const glm::dvec3 u = glm::normalize(glm::dvec3(p.x, p.y, p.z * body.equatorial_m / body.polar_m));
  double x = std::atan2(glm::dot(u, map.axes[1]), glm::dot(u, map.axes[0])) - map.low_rad.x;
  if (map.around) x -= 2 * M_PI * std::floor(x / (2 * M_PI));
  x /= map.step_rad.x;
  const double y = (std::asin(glm::dot(u, map.axes[2])) - map.low_rad.y) / map.step_rad.y;
  const int i = int(std::floor(x)), j = int(std::floor(y));
  if (i < 0 || j < 0 || (i + 1 >= map.nx && !map.around) || j + 1 >= map.ny) return {};
  Ground ground{0, 0};
  for (int c = 0; c < 4; ++c) {
    const double w = (c & 1 ? x - i : 1 - x + i) * (c & 2 ? y - j : 1 - y + j);
    const auto n =
        std::size_t(j + (c >> 1)) * std::size_t(map.nx) + std::size_t((i + (c & 1)) % map.nx);
    ground.height_m += w * double(map.height_m[n]);
    ground.water += w * double(map.water[n]);
  }
  return ground;
}

struct GdalTerrain : testing::Test {
  nepho::test::TestFolder folder{"gdal_terrain"};
  TerrainRequest request;

  Terrain open(const MadeRaster& raster) {
    request.file = folder / "dem.tif";
    raster.write(request.file);
    return open_terrain(request);
  }
  std::string refusal(const MadeRaster& raster) {
    try {
      open(raster);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

// Smooth mountains, waves of 130 km on the sphere of directions; on the raster by OGR's transform.
double mountain_m(double lat, double lon) {
  const double phi = lat * M_PI / 180, lambda = lon * M_PI / 180;
  return 1500 + 600 * std::sin(300 * std::cos(phi) * std::cos(lambda)) +
         400 * std::cos(300 * std::cos(phi) * std::sin(lambda)) +
         300 * std::sin(300 * std::sin(phi));
}
MadeRaster mountains(const char* system, std::array<double, 6> transform, int n = 120) {
  MadeRaster raster;
  raster.nx = n;
  raster.ny = n - 20;
  raster.system = system;
  raster.transform = transform;
  std::vector<double> heights;
  for (int j = 0; j < raster.ny; ++j)
    for (int i = 0; i < raster.nx; ++i) {
      const auto place = raster.lat_lon_deg(i + 0.5, j + 0.5);
      heights.push_back(mountain_m(place[0], place[1]));
    }
  raster.bands = {{"", "m", std::move(heights), {}, {}, {}}};
  return raster;
}

TEST_F(GdalTerrain, HeightsAreInTheirPlace) {
  double worst_m = 0;
  for (const MadeRaster& raster : {mountains("EPSG:4326", {10, 0.01, 0, 47, 0, -0.01}),
                                   mountains("EPSG:32632", {600000, 800, 0, 5250000, 0, -800}),
                                   mountains("EPSG:3413", {-40000, 800, 0, 40000, 0, -800}),
                                   mountains("EPSG:4326", {179.4, 0.01, 0, -17, 0, -0.01})}) {
    const Terrain terrain = open(raster);
    ASSERT_NE(terrain.map, nullptr);
    for (const double x : {3.5, 41.2, 77.7, 116.5})
      for (const double y : {3.5, 50.1, 96.5}) {
        const auto place = raster.lat_lon_deg(x, y);
        const Ground ground = ground_at(*terrain.map, place[0], place[1]);
        const double off_m = std::abs(ground.height_m - mountain_m(place[0], place[1]));
        EXPECT_LT(off_m, 2.5) << raster.system << " " << x << " " << y;
        worst_m = std::max(worst_m, off_m);
        EXPECT_EQ(ground.water, 0);
      }
  }
  nepho::test::report_accuracy("gdal", "terrain of 1 km pixels, waves of 130 km and 600 m", worst_m,
                               2.5, "m");
}

TEST_F(GdalTerrain, WholePlanetsGoAround) {
  MadeRaster raster;
  raster.nx = 360;
  raster.ny = 180;
  raster.transform = {-180, 1, 0, 90, 0, -1};
  std::vector<double> heights;
  for (int n = 0; n < raster.nx * raster.ny; ++n)
    heights.push_back(n % 360 < 2 || n % 360 > 357 ? 700 : -3000);
  raster.bands = {{"", "metre", heights, {}, {}, {}}};
  const Terrain terrain = open(raster);
  EXPECT_TRUE(terrain.map->around);
  EXPECT_NEAR(ground_at(*terrain.map, 10.2, 180).height_m, 700, 1);
  EXPECT_NEAR(ground_at(*terrain.map, -40, -179.9).height_m, 700, 1);
  EXPECT_NEAR(ground_at(*terrain.map, 10.2, 20).water, 1, 1e-6);
}

// Feet, and pixels without data, which are sea.
TEST_F(GdalTerrain, UnitsAndNodata) {
  MadeRaster raster;
  std::vector<double> heights = raster.constant(1000);
  for (int j = 10; j < 20; ++j)
    for (int i = 10; i < 20; ++i) heights[std::size_t(j * raster.nx + i)] = -32768;
  raster.type = GDT_Int16;
  raster.bands = {{"", "ft", heights, -32768, {}, {}}};
  const Terrain terrain = open(raster);
  const Ground land = ground_at(*terrain.map, 49.8, 10.3),
               sea = ground_at(*terrain.map, 48.5, 11.5);
  EXPECT_NEAR(land.height_m, 304.8, 1e-2);
  EXPECT_EQ(land.water, 0);
  EXPECT_EQ(sea.height_m, 0);
  EXPECT_EQ(sea.water, 1);
  EXPECT_TRUE(std::ranges::any_of(terrain.assumptions, [](const std::string& text) {
    return text.find("have no data: sea level") != std::string::npos;
  }));
}

// Only what is asked for is read: pixels of the region; means of them where they are too many.
TEST_F(GdalTerrain, ReadsThePartThatIsSeen) {
  const MadeRaster raster = mountains("EPSG:4326", {10, 0.01, 0, 47, 0, -0.01});
  request.region = forecast::Region{46.4, 10.3, 46.6, 10.6};
  const Terrain part = open(raster);
  EXPECT_LT(part.map->nx, 45);
  EXPECT_NEAR(ground_at(*part.map, 46.5, 10.45).height_m, mountain_m(46.5, 10.45), 2.5);
  EXPECT_EQ(ground_at(*part.map, 46.9, 11.1).height_m, 0);
  request.region.reset();
  request.most_nodes = 40;
  const Terrain coarse = open(raster);
  EXPECT_LT(coarse.map->nx, 60);
  EXPECT_NEAR(ground_at(*coarse.map, 46.5, 10.45).height_m, mountain_m(46.5, 10.45), 15);
  request.region = forecast::Region{-10, 0, -9, 1};
  EXPECT_NE(open(raster).assumptions[0].find("does not reach"), std::string::npos);
}

TEST_F(GdalTerrain, RefusesWhatIsNoGround) {
  MadeRaster raster;
  raster.bands = {{"", "m", raster.constant(20000), {}, {}, {}}};
  EXPECT_NE(refusal(raster).find("no ground lies so high"), std::string::npos);
  raster.bands[0].unit = "K";
  EXPECT_NE(refusal(raster).find("no length"), std::string::npos);
  raster.bands = {{"", "m", raster.constant(-9), -9, {}, {}}};
  EXPECT_NE(refusal(raster).find("nodata only"), std::string::npos);
  raster.type = GDT_Byte;
  raster.bands = std::vector<MadeBand>(3, {"", "", raster.constant(128), {}, {}, {}});
  EXPECT_NE(refusal(raster).find("a picture is no terrain"), std::string::npos);
}

}  // namespace
}  // namespace nepho::gdal::test
