// Rasters of clouds to columns: where pixels lie, what their values mean, and what is refused.

#include "sources/gdal/clouds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy_report.h"
#include "core/error.h"
#include "made_raster.h"
#include "optical_depths.h"
#include "synthetic_forecast.h"

#include "remapped.h"
#include "test_folder.h"

namespace nepho::gdal::test {
namespace {

using forecast::CloudQuantity;
using forecast::ForecastColumns;

struct GdalClouds : testing::Test {
  nepho::test::TestFolder folder{"gdal_clouds"};
  CloudRequest request;

  std::shared_ptr<const forecast::Forecast> open(const std::vector<MadeRaster>& rasters) {
    request.files.clear();
    for (const MadeRaster& raster : rasters) {
      request.files.push_back(folder / (std::to_string(request.files.size()) + ".tif"));
      raster.write(request.files.back());
    }
    return open_clouds(request);
  }
  std::string refusal(const std::vector<MadeRaster>& rasters) {
    try {
      open(rasters);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

// Optical depth of each column.
std::vector<double> depths(const ForecastColumns& c) {
  const std::size_t nz = std::size_t(c.nz);
  for (std::size_t n = 0; n < c.extinction_per_m.size(); ++n) {
    const float* z = &c.interface_m[n / nz * (nz + 1) + n % nz];
    EXPECT_GT(z[1], z[0]);
  }
  return nepho::test::optical_depths(c);
}

// Height range that holds extinction.
glm::dvec2 cloud_m(const ForecastColumns& c, std::size_t cell) {
  const std::size_t nz = std::size_t(c.nz);
  glm::dvec2 range(1e9, -1e9);
  for (std::size_t k = 0; k < nz; ++k)
    if (c.extinction_per_m[cell * nz + k] > 0) {
      range.x = std::min(range.x, double(c.interface_m[cell * (nz + 1) + k]));
      range.y = std::max(range.y, double(c.interface_m[cell * (nz + 1) + k + 1]));
    }
  return range;
}

MadeBand depth_band(std::vector<double> values) {
  return {"cloud_optical_depth", "", std::move(values), {}, {}, {}};
}
MadeBand top_band(std::vector<double> values) {
  return {"cloud_top_height", "m", std::move(values), {}, {}, {}};
}

struct Map {
  const char* name;
  const char* system;
  std::array<double, 6> transform;
};

class GdalMaps : public GdalClouds, public testing::WithParamInterface<Map> {};

// One pixel, found again where OGR says that it is: in the cells, and in the bricks' hats.
TEST_P(GdalMaps, PlantedPixelIsInItsPlace) {
  MadeRaster raster;
  raster.system = GetParam().system;
  raster.transform = GetParam().transform;
  const int i = 31, j = 7;
  raster.bands = {depth_band(raster.planted(i, j, 12)), top_band(raster.constant(3000))};
  const auto forecast = open({raster});
  const auto grid = forecast->grid(0);
  ASSERT_EQ(grid->nx(), raster.nx);
  const std::vector<double> depth = depths(forecast->columns(0));
  std::size_t found = 0;
  for (std::size_t n = 0; n < depth.size(); ++n)
    if (depth[n] > 0) found = n;
  EXPECT_EQ(found, std::size_t(j * raster.nx + i));
  const auto truth = raster.lat_lon_deg(i + 0.5, j + 0.5), next = raster.lat_lon_deg(i + 1, j + 1);
  const glm::dvec3 wanted = unit_vector({truth[0], truth[1]});
  const double half_cell = glm::length(unit_vector({next[0], next[1]}) - wanted);
  const glm::dvec3 ours = unit_vector(grid->lat_lon_deg(i + 0.5, j + 0.5));
  EXPECT_LT(glm::length(ours - wanted), 1e-3 * half_cell);
  // The middle of what the bricks hold.
  const nepho::test::Remapped r(forecast);
  glm::dvec3 middle(0.0);
  for (const Column& column : r.columns_with_cloud()) {
    const glm::dvec3 q{double(column.i) / r.cells()[0], double(column.j) / r.cells()[1], 0.1};
    const GeodeticPoint p = geodetic_point(r.chart().body(), r.chart().ecef_m({column.root, q}));
    middle += r.column_depth(column) * unit_vector({p.latitude_deg, p.longitude_deg});
  }
  const double off = glm::length(glm::normalize(middle) - wanted) / half_cell;
  nepho::test::report_accuracy("gdal", "planted pixel in the bricks, in half diagonals of it", off,
                               1, "1");
  EXPECT_LT(off, 1);
}

// The last two straddle 180 degrees; longitudes beyond are written either way.
INSTANTIATE_TEST_SUITE_P(
    Systems, GdalMaps,
    testing::Values(Map{"geographic", "EPSG:4326", {10, 0.1, 0, 50, 0, -0.1}},
                    Map{"rows_run_north", "EPSG:4326", {10, 0.1, 0, 47, 0, 0.1}},
                    Map{"columns_run_west", "EPSG:4326", {14, -0.1, 0, 50, 0, -0.1}},
                    Map{"utm", "EPSG:32632", {600000, 3000, 0, 5300000, 0, -3000}},
                    Map{"turned_utm", "EPSG:32632", {600000, 2500, 1500, 5300000, 1500, -2500}},
                    Map{"south_utm", "EPSG:32756", {300000, 3000, 0, 6300000, 0, -3000}},
                    Map{"laea", "EPSG:3035", {4300000, 5000, 0, 3000000, 0, -5000}},
                    Map{"polar", "EPSG:3413", {-100000, 5000, 0, 75000, 0, -5000}},
                    Map{"geostationary",
                        "+proj=geos +h=35786023 +lon_0=-75 +sweep=x +ellps=GRS80 +units=m",
                        {-2000000, 10000, 0, 3000000, 0, -10000}},
                    Map{"whole_disc",
                        "+proj=geos +h=35786023 +lon_0=0 +sweep=y +ellps=WGS84 +units=m",
                        {-6000000, 300000, 0, 4500000, 0, -300000}},
                    Map{"feet", "EPSG:2263", {900000, 10000, 0, 300000, 0, -10000}},
                    Map{"seam_of_360", "EPSG:4326", {178, 0.1, 0, 2, 0, -0.1}},
                    Map{"seam_of_180", "EPSG:4326", {-182, 0.1, 0, 2, 0, -0.1}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(GdalClouds, GlobalRastersGoAround) {
  MadeRaster raster;
  raster.nx = 72;
  raster.ny = 37;  // points at the poles, as models write them
  raster.transform = {-2.5, 5, 0, 92.5, 0, -5};
  raster.bands = {depth_band(raster.constant(2)), top_band(raster.constant(2000))};
  const auto forecast = open({raster});
  EXPECT_TRUE(forecast->grid(0)->around());
  EXPECT_NEAR(forecast->grid(0)->lat_lon_deg(0, 0).x, 90, 1e-9);
  raster.nx = 73;  // the last column repeats the first
  raster.bands = {depth_band(raster.constant(2)), top_band(raster.constant(2000))};
  EXPECT_EQ(open({raster})->grid(0)->nx(), 72);
}

// Packed numbers and what is missing: depth 0.02 n + 1; a nodata of the stored kind.
TEST_F(GdalClouds, PackedValuesAndNodata) {
  MadeRaster raster;
  raster.type = GDT_Int16;
  std::vector<double> stored = raster.constant(450);
  stored[5] = 20000;
  stored[6] = -50;
  raster.bands = {{"COT", "1", stored, 20000, 0.02, 1}, top_band(raster.constant(3000))};
  const std::vector<double> depth = depths(open({raster})->columns(0));
  EXPECT_NEAR(depth[0], 10, 1e-5);
  EXPECT_EQ(depth[5], 0);
  EXPECT_EQ(depth[6], 0);
}

// 60 g/m2 of droplets of 10 um: kext of water.h; the same in kg/m2; a thousand times is refused.
TEST_F(GdalClouds, WaterPathsHaveTheirUnits) {
  MadeRaster raster;
  const auto with = [&](double value, const char* unit) {
    raster.bands = {{"lwp", unit, raster.constant(value), {}, {}, {}},
                    top_band(raster.constant(1500))};
    return raster;
  };
  const double in_g = depths(open({with(60, "g m-2")})->columns(0))[7];
  EXPECT_NEAR(in_g, 0.06 * 157, 0.06 * 157 * 0.03);  // 157 m2/kg: Mie, re 10 um, 0.55 um
  EXPECT_NEAR(depths(open({with(0.06, "kg m-2")})->columns(0))[7], in_g, 1e-5 * in_g);
  EXPECT_NE(refusal({with(60, "kg m-2")}).find("no cloud has such a value"), std::string::npos);
  request.force = true;
  request.options.thickness_m = 20000;
  EXPECT_NEAR(depths(open({with(60, "kg m-2")})->columns(0))[7], 1000 * in_g, in_g);
}

// Bricks keep the raster's optical depth: all of it to 0.2 %, under each hat to 0.5 % rms.
TEST_F(GdalClouds, BricksKeepOpticalDepth) {
  MadeRaster raster;
  raster.nx = raster.ny = 48;
  raster.system = "EPSG:3035";
  raster.transform = {4300000, 4000, 0, 3000000, 0, -4000};
  std::vector<double> depth, top;
  for (int n = 0; n < raster.nx * raster.ny; ++n) {
    const double x = n % raster.nx, y = n / raster.nx;
    depth.push_back(std::max(0.0, 20 * std::sin(0.4 * x) * std::cos(0.3 * y)));
    top.push_back(2500 + 1500 * std::sin(0.2 * x + 0.3 * y));
  }
  raster.bands = {depth_band(depth), top_band(top)};
  for (const auto profile : {forecast::Profile::kUniform, forecast::Profile::kAdiabatic}) {
    request.options.profile = profile;
    const auto forecast = open({raster});
    const std::vector<double> got = depths(forecast->columns(0));
    double worst = 0;
    for (std::size_t n = 0; n < got.size(); ++n)
      worst = std::max(worst, std::abs(got[n] - double(float(depth[n]))) / 20);
    const nepho::test::Remapped r(forecast);
    const double drift = std::abs(r.total() / nepho::test::file_total(r) - 1);
    const double rms = nepho::test::column_rms(r, 60);
    using nepho::test::report_accuracy;
    report_accuracy("gdal", "optical depth of columns, raster against layers", worst, 1e-6, "1");
    report_accuracy("gdal", "total optical depth, raster against finest bricks", drift, 2e-3, "1");
    report_accuracy("gdal", "column optical depth under the same hats, rms", rms, 5e-3, "1");
    EXPECT_LT(worst, 1e-6);
    EXPECT_LT(drift, 2e-3);
    EXPECT_LT(rms, 5e-3);
  }
}

// A fine raster in blocks: the mean depth of the pixels, missing ones clear, and heights by depth.
TEST_F(GdalClouds, BlocksKeepTheMeanDepth) {
  MadeRaster raster;
  raster.nx = 41;  // the last block is cut
  raster.ny = 30;
  std::vector<double> depth, top;
  for (int n = 0; n < raster.nx * raster.ny; ++n) {
    depth.push_back(n % 7 == 0 ? -1 : n % 5);
    top.push_back(1000 + 100 * (n % 5));
  }
  raster.bands = {depth_band(depth), top_band(top)};
  raster.bands[0].nodata = -1;
  request.most_cells = 200;  // blocks of 3 x 3
  const auto forecast = open({raster});
  const auto grid = forecast->grid(0);
  ASSERT_EQ(grid->nx(), 14);
  ASSERT_EQ(grid->ny(), 10);
  EXPECT_NEAR(grid->lat_lon_deg(14, 10).y, 14.1, 1e-9);
  const std::vector<double> got = depths(forecast->columns(0));
  const auto mean = [&](int bi, int bj, bool heights) {
    double sum = 0, weight = 0, count = 0;
    for (int b = 3 * bj; b < std::min(3 * bj + 3, raster.ny); ++b)
      for (int a = 3 * bi; a < std::min(3 * bi + 3, raster.nx); ++a, ++count) {
        const auto n = std::size_t(b * raster.nx + a);
        const double tau = std::max(depth[n], 0.0);
        sum += heights ? tau * top[n] : tau;
        weight += tau;
      }
    return sum / (heights ? weight : count);
  };
  for (const int bi : {0, 6, 13})
    for (const int bj : {0, 9}) {
      const std::size_t cell = std::size_t(bj * 14 + bi);
      EXPECT_NEAR(got[cell], mean(bi, bj, false), 1e-5) << bi << " " << bj;
      EXPECT_NEAR(cloud_m(forecast->columns(0), cell).y, mean(bi, bj, true), 0.01);
    }
}

// Another file on another map counts by its pixel under each cell's middle.
TEST_F(GdalClouds, FilesOfOtherGridsAreSampled) {
  MadeRaster depth, top;
  depth.bands = {depth_band(depth.constant(5))};
  top.system = "EPSG:3035";
  top.nx = 12;
  top.ny = 14;
  top.transform = {4300000, 30000, 0, 3020000, 0, -30000};
  std::vector<double> heights;
  for (int n = 0; n < 12 * 14; ++n) heights.push_back(1000 + 10 * n);
  top.bands = {top_band(heights)};
  const auto forecast = open({depth, top});
  const ForecastColumns columns = forecast->columns(0);
  int checked = 0;
  for (int n = 0; n < 12 * 14; ++n) {
    const auto place = top.lat_lon_deg(n % 12 + 0.5, n / 12 + 0.5);
    const int i = int(std::floor((place[1] - 10) / 0.1)),
              j = int(std::floor((50 - place[0]) / 0.1));
    if (i < 0 || i >= depth.nx || j < 0 || j >= depth.ny) continue;
    ++checked;
    EXPECT_NEAR(cloud_m(columns, std::size_t(j * depth.nx + i)).y, 1000 + 10 * n, 0.01);
  }
  EXPECT_GT(checked, 50);
  ASSERT_FALSE(forecast->assumptions().empty());
  EXPECT_NE(forecast->assumptions()[0].find("of another grid"), std::string::npos);
}

TEST_F(GdalClouds, RegionsReadTheirPart) {
  MadeRaster raster;
  raster.bands = {depth_band(raster.planted(20, 15, 8)), top_band(raster.constant(2000))};
  request.region = forecast::Region{48.2, 11.8, 48.7, 12.3};
  const auto forecast = open({raster});
  const auto grid = forecast->grid(0);
  EXPECT_LT(grid->nx(), 12);
  const std::vector<double> depth = depths(forecast->columns(0));
  const auto at = std::size_t(std::ranges::max_element(depth) - depth.begin());
  EXPECT_NEAR(depth[at], 8, 1e-5);
  const glm::dvec2 place =
      grid->lat_lon_deg(int(at) % grid->nx() + 0.5, int(at) / grid->nx() + 0.5);
  EXPECT_NEAR(place.x, 48.45, 1e-6);
  EXPECT_NEAR(place.y, 12.05, 1e-6);
}

// What a file does not say is asked for, once, with the words that would do.
TEST_F(GdalClouds, AsksForWhatIsMissing) {
  MadeRaster raster;
  raster.bands = {depth_band(raster.constant(4))};
  EXPECT_NE(refusal({raster}).find("--cloud-top"), std::string::npos);
  request.options.top_m = 2000;
  EXPECT_EQ(refusal({raster}), "");
  request.options = {};
  raster.bands = {top_band(raster.constant(4000))};
  EXPECT_NE(refusal({raster}).find("--optical-depth"), std::string::npos);
  request.options.optical_depth = 5;
  EXPECT_NEAR(depths(open({raster})->columns(0))[3], 5, 1e-5);
  request.options = {};
  raster.bands = {{"", "", raster.constant(4), {}, {}, {}}};
  EXPECT_NE(refusal({raster}).find("--bands"), std::string::npos);
  raster.bands = {{"lwp", "", raster.constant(4), {}, {}, {}}};
  EXPECT_NE(refusal({raster}).find("have no unit"), std::string::npos);
  raster.bands = {{"cth", "hPa", raster.constant(4), {}, {}, {}}};
  EXPECT_NE(refusal({raster}).find("of another quantity"), std::string::npos);
  raster.bands = {depth_band(raster.constant(4)), depth_band(raster.constant(4))};
  EXPECT_NE(refusal({raster}).find("two bands hold the same quantity"), std::string::npos);
}

TEST_F(GdalClouds, RefusesRastersThatLieNowhere) {
  MadeRaster raster;
  raster.bands = {depth_band(raster.constant(4)), top_band(raster.constant(2000))};
  raster.system = "";
  EXPECT_NE(refusal({raster}).find("gdal_edit.py"), std::string::npos);
  raster.system = "LOCAL_CS[\"plan\",UNIT[\"metre\",1]]";
  EXPECT_NE(refusal({raster}).find("planet"), std::string::npos);
  raster.system = "EPSG:4326";
  raster.control_points = 4;
  EXPECT_NE(refusal({raster}).find("gdalwarp"), std::string::npos);
}

}  // namespace
}  // namespace nepho::gdal::test
