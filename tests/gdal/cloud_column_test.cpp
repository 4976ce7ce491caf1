// The cloud that is made of a raster's column: thickness, base, top, phase, cover.

#include "forecast/rasters/cloud_column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nepho::forecast::test {
namespace {

ColumnValues column_of(double depth, double top_m) {
  ColumnValues v{};
  for (double* value : {&v.liquid_path_kg_per_m2, &v.ice_path_kg_per_m2, &v.water_path_kg_per_m2,
                        &v.cover, &v.top_Pa, &v.top_K, &v.base_m, &v.radius_m})
    *value = NAN;
  v.optical_depth = depth;
  v.top_m = top_m;
  return v;
}

TEST(CloudColumn, ThicknessIsWaterOverContent) {
  RasterOptions options;
  CloudColumn c;
  ASSERT_EQ(cloud_column(column_of(15, 3000), options, c), Lacks::kNothing);
  // 15 / 157 m2/kg is 96 g/m2; 0.3 g/m3 makes 318 m.
  EXPECT_NEAR(c.top_m - c.base_m, 318, 10);
  EXPECT_EQ(c.ice_share, 0);
  cloud_column(column_of(3, 10000), options, c);
  // -50 degC: ice of 30 um, 3 / (2 * 917 * 30e-6) = 54.5 m2/kg; 0.05 g/m3.
  EXPECT_NEAR(c.top_m - c.base_m, 1100, 10);
  EXPECT_EQ(c.ice_share, 1);
  options.phase = RasterPhase::kLiquid;
  cloud_column(column_of(3, 10000), options, c);
  EXPECT_EQ(c.ice_share, 0);
  options.thickness_m = 700;
  cloud_column(column_of(3, 10000), options, c);
  EXPECT_NEAR(c.base_m, 9300, 1e-9);
  options.base_m = 500, options.thickness_m.reset();
  cloud_column(column_of(3, 10000), options, c);
  EXPECT_NEAR(c.base_m, 500, 1e-9);
}

// Closed form of Brenguier et al.: the depth of layers of extinction z^(2/3), summed.
TEST(CloudColumn, AdiabaticCloudsAreTheirIntegral) {
  const double thick_m = adiabatic_thickness_m(10, 1e8);
  EXPECT_GT(thick_m, 150);
  EXPECT_LT(thick_m, 400);
  double sum = 0;
  constexpr int kSteps = 20000;
  for (int n = 0; n < kSteps; ++n) {
    const double z = (n + 0.5) / kSteps * thick_m, q = 2e-6 * z;
    const double radius_m = std::cbrt(3 * q / (4 * std::numbers::pi * 999.84 * 0.77 * 1e8));
    sum += 1.5 * q / (999.84 * radius_m) * thick_m / kSteps;
  }
  EXPECT_NEAR(sum, 10, 0.02 * 10);
  EXPECT_NEAR(adiabatic_depth(thick_m, 1e8), 10, 1e-9);
}

TEST(CloudColumn, TopsFollowFromPressureAndTemperature) {
  RasterOptions options;
  CloudColumn c;
  ColumnValues v = column_of(5, NAN);
  EXPECT_EQ(cloud_column(v, options, c), Lacks::kTop);
  v.top_Pa = 70000;
  cloud_column(v, options, c);
  EXPECT_NEAR(c.top_m, 3012 + 1.4, 2);  // 700 hPa of the standard atmosphere
  v.top_Pa = NAN;
  v.top_K = 288.15 - 6.5 * 4;
  cloud_column(v, options, c);
  EXPECT_NEAR(c.top_m, 4000, 1e-6);
}

// A cover of a half halves what a cell's clouds hold; water paths are means already.
TEST(CloudColumn, CoverIsOfTheCell) {
  RasterOptions options;
  CloudColumn c;
  ColumnValues v = column_of(8, 2000);
  v.cover = 0.5;
  cloud_column(v, options, c);
  EXPECT_NEAR(c.optical_depth, 4, 1e-12);
  v.optical_depth = NAN;
  v.liquid_path_kg_per_m2 = 0.1;
  cloud_column(v, options, c);
  const double with = c.optical_depth;
  v.cover = NAN;
  cloud_column(v, options, c);
  EXPECT_EQ(c.optical_depth, with);
}

}  // namespace
}  // namespace nepho::forecast::test
