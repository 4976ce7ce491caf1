// A file of a model that no one of us wrote, against the NetCDF that ecCodes's own tool made of it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "accuracy_report.h"
#include "grib_twin.h"
#include "optical_depths.h"
#include "sources/netcdf/nc_file.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::grib::test {
namespace {

const std::string kData = NEPHO_TEST_REAL_DATA;
const std::string kGrib = kData + "/grib/gfs_2p5deg_20110110_f120.grib2";
const std::string kNetcdf = kData + "/nc/gfs_2p5deg_20110110_f120_DERIVED_cf_packed.nc";

// All values of four variables: half a step of the NetCDF's 16 bits apart, and missing alike.
TEST(GribReal, ValuesAreTheDerivedFiles) {
  const GribFile grib({kGrib}, {});
  const netcdf::NcFile nc(kNetcdf, {});
  const std::vector<double> lat = all_of(grib, "lat"), lon = all_of(grib, "lon"),
                            level = all_of(grib, "isobaric");
  const std::vector<double> nc_lat = nc.read_all(*nc.find("latitude")),
                            nc_lon = nc.read_all(*nc.find("longitude")),
                            nc_level = nc.read_all(*nc.find("level"));
  ASSERT_EQ(lat.size(), nc_lat.size());
  ASSERT_EQ(lon.size(), nc_lon.size());
  ASSERT_EQ(level.size(), nc_level.size());
  for (std::size_t i = 0; i < lon.size(); ++i) EXPECT_NEAR(lon[i], nc_lon[i], 1e-5);
  for (std::size_t j = 0; j < lat.size(); ++j)
    EXPECT_NEAR(lat[j], nc_lat[lat.size() - 1 - j], 1e-5);  // ours rise
  for (std::size_t k = 0; k < level.size(); ++k) EXPECT_NEAR(level[k], 100 * nc_level[k], 1e-6);
  for (const char* name : {"clwmr", "t", "r", "gh"}) {
    const std::vector<double> ours = all_of(grib, name), theirs = nc.read_all(*nc.find(name));
    ASSERT_EQ(ours.size(), theirs.size()) << name;
    const double step = *nc.find(name)->number("scale_factor");
    double worst = 0;
    std::size_t missing = 0;
    for (std::size_t n = 0; n < ours.size(); ++n) {
      const std::size_t i = n % lon.size(), j = n / lon.size() % lat.size(),
                        k = n / lon.size() / lat.size();
      const double other = theirs[(k * lat.size() + lat.size() - 1 - j) * lon.size() + i];
      ASSERT_EQ(std::isnan(ours[n]), std::isnan(other)) << name << " " << n;
      missing += std::isnan(other);
      if (!std::isnan(other)) worst = std::max(worst, std::abs(ours[n] - other) / step);
    }
    nepho::test::report_accuracy(
        "Forecasts in GRIB", std::string(name) + " against grib_to_netcdf, steps of its packing",
        worst, 0.6, "1");
    EXPECT_LE(worst, 0.6) << name;
    // Levels without cloud water or humidity.
    EXPECT_EQ(missing, name[0] == 'c' ? 52560u : name[0] == 'r' ? 10512u : 0u) << name;
  }
}

// The four variables alone, as the NetCDF has them: without the land, whose droplets are smaller.
std::string selection() {
  std::ifstream in(kGrib, std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(in), {}};
  const FieldTable table = table_of({kGrib});
  std::string bytes;
  for (const Field& field : table.fields)
    if (field.header.level.kind == LevelKind::kIsobaric &&
        std::string(" clwmr t r gh ").find(" " + field.header.parameter.name + " ") !=
            std::string::npos)
      bytes += all.substr(std::size_t(field.place.message), std::size_t(field.place.bytes()));
  return write_bytes("selection.grib2", bytes);
}

TEST(GribReal, OpticalDepthIsTheDerivedFiles) {
  forecast::OpenRequest request;
  request.files = {kNetcdf};
  const auto nc = netcdf::open_netcdf(request);
  const auto grib = open({selection()});
  EXPECT_EQ(grib->time_origin_ns(), nc->time_origin_ns());
  const std::vector<double> ours = nepho::test::optical_depths(grib->columns(0)),
                            theirs = nepho::test::optical_depths(nc->columns(0));
  ASSERT_EQ(ours.size(), theirs.size());
  const std::size_t nx = 144, ny = 73;
  double sum = 0, other_sum = 0, apart = 0;
  for (std::size_t n = 0; n < ours.size(); ++n) {
    const double other = theirs[(ny - 1 - n / nx) * nx + n % nx];
    sum += ours[n];
    other_sum += other;
    apart += std::abs(ours[n] - other);
  }
  nepho::test::report_accuracy("Forecasts in GRIB", "optical depth against grib_to_netcdf, all",
                               std::abs(sum / other_sum - 1), 1e-3, "1");
  nepho::test::report_accuracy("Forecasts in GRIB", "optical depth, mean of columns apart / mean",
                               apart / other_sum, 2e-3, "1");
  EXPECT_NEAR(sum / other_sum, 1, 1e-3);
  EXPECT_LT(apart / other_sum, 2e-3);
}

TEST(GribReal, SaysWhatItHolds) {
  const auto whole = open({kGrib});
  EXPECT_TRUE(says(whole->facts(), "fields of the file are means, sums or extremes"));
  EXPECT_TRUE(says(whole->facts(), "clwmr is in the file for 21 of 26"));
  EXPECT_TRUE(whole->grid(0)->around());
  EXPECT_FALSE(whole->ground(0).height_m.empty());
  EXPECT_FALSE(whole->ground(0).water.empty());
}

}  // namespace
}  // namespace nepho::grib::test
