// Columns of clouds in NetCDF: satellites' products and vertical sums, with what is stated of them.

#include <cmath>

#include "nc_writer.h"

namespace nepho::forecast::test {
namespace {

// Depth and top over a map of 4 km; the axes' rows run south.
void write_columns(const std::string& path, const std::string& depth_unit = "1") {
  NcWriter nc(path);
  nc.dimension("time", 1);
  nc.dimension("y", 20);
  nc.dimension("x", 30);
  nc.variable("time", NC_DOUBLE, {"time"}, {36}, {{"units", "hours since 2017-10-25"}});
  std::vector<double> x, y, depth(600, 0.0), top(600, 40.0);
  for (int i = 0; i < 30; ++i) x.push_back(4000.0 * i);
  for (int j = 0; j < 20; ++j) y.push_back(-4000.0 * j);
  depth[7 * 30 + 21] = 9;
  nc.variable("x", NC_DOUBLE, {"x"}, x,
              {{"units", "m"}, {"standard_name", "projection_x_coordinate"}});
  nc.variable("y", NC_DOUBLE, {"y"}, y,
              {{"units", "m"}, {"standard_name", "projection_y_coordinate"}});
  nc.variable("map", NC_INT, {}, {0},
              {{"grid_mapping_name", "polar_stereographic"},
               {"straight_vertical_longitude_from_pole", -45.0},
               {"latitude_of_projection_origin", 90.0},
               {"standard_parallel", 70.0},
               {"semi_major_axis", 6378137.0},
               {"inverse_flattening", 298.257223563}});
  nc.variable("cot", NC_FLOAT, {"time", "y", "x"}, depth,
              {{"units", depth_unit}, {"grid_mapping", "map"}});
  nc.variable("top", NC_FLOAT, {"time", "y", "x"}, top,
              {{"units", "hm"},
               {"standard_name", "cloud_top_altitude"},
               {"grid_mapping", "map"},
               {"_FillValue", -1.0}});
}

std::unique_ptr<Forecast> open(const OpenRequest& request) {
  return netcdf::open_netcdf(request);
}

std::string refusal(const OpenRequest& request) {
  try {
    open(request);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Columns, AreWhereAndWhatTheFileSays) {
  OpenRequest request;
  request.files = {folder() / "columns.nc"};
  write_columns(request.files[0]);
  const auto forecast = open(request);
  const ForecastColumns columns = forecast->columns(0);
  ASSERT_EQ(columns.nx, 30);
  const std::size_t nz = std::size_t(columns.nz), cell = 7 * 30 + 21;
  double depth = 0, all = 0, top = 0;
  for (std::size_t n = 0; n < columns.extinction_per_m.size(); ++n) {
    const float* z = &columns.interface_m[n / nz * (nz + 1) + n % nz];
    const double part = double(columns.extinction_per_m[n]) * (double(z[1]) - double(z[0]));
    all += part;
    if (n / nz != cell) continue;
    depth += part;
    if (part > 0) top = double(z[1]);
  }
  EXPECT_NEAR(depth, 9, 1e-5);
  EXPECT_NEAR(all, 9, 1e-5);
  EXPECT_NEAR(top, 4000, 0.01);
  // 84 km along 45 W + 90, 28 km along 45 W: atan2(84, 28) - 45 degrees east.
  EXPECT_NEAR(forecast->grid(0)->lat_lon_deg(21.5, 7.5).y, std::atan2(84, 28) * 180 / M_PI - 45,
              1e-6);
  EXPECT_EQ(forecast->time_origin_ns(), 1509019200000000000);  // 2017-10-26T12:00Z
}

TEST(Columns, AskForWhatIsMissing) {
  OpenRequest request;
  request.files = {folder() / "columns.nc"};
  write_columns(request.files[0], "g m-2");  // no depth then
  EXPECT_NE(refusal(request).find("does not say how thick its clouds are: found top_height"),
            std::string::npos);
  request.raster.optical_depth = 4;
  request.raster.stated = true;
  EXPECT_EQ(refusal(request), "");
}

}  // namespace
}  // namespace nepho::forecast::test
