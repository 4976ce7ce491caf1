// The CF files that make_samples writes, read with netCDF-C alone; sizes, and the same bytes twice.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "global_forecast.h"
#include "les_field.h"
#include "made_file.h"
#include "nc_twins.h"
#include "wrf_forecast.h"

namespace nepho::test {
namespace {

std::string bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(LesSample, LevelBasesAndTurrets) {
  const fs::path path = made_folder() / "les.nc";
  samples::write_les(nc_writer(), path, {});
  const MadeFile file(path);
  const std::vector<double> q = file.values("ql"), z = file.values("z");
  const std::size_t layer = file.length("lat") * file.length("lon");
  EXPECT_EQ(file.note("ql", "units"), "kg kg-1");
  std::vector<double> tops, amounts(z.size(), 0);
  for (std::size_t cell = 0; cell < layer; ++cell) {
    double top = 0;
    for (std::size_t k = 0; k < z.size(); ++k) {
      ASSERT_GE(q[k * layer + cell], 0);
      if (q[k * layer + cell] == 0) continue;
      EXPECT_GT(z[k], 610);  // the condensation level, level for all
      top = z[k];
      amounts[k] = std::max(amounts[k], q[k * layer + cell]);
    }
    if (top > 0) tops.push_back(top);
  }
  const double cover = double(tops.size()) / double(layer);
  EXPECT_GT(cover, 0.12);
  EXPECT_LT(cover, 0.45);
  std::ranges::sort(tops);
  EXPECT_LT(tops[tops.size() / 4], 1000);     // many small ones,
  EXPECT_GT(tops.back(), 1700);               // few tall ones
  EXPECT_LT(tops.back(), 2450);               // that stay in the box
  EXPECT_GT(amounts[40], 1.8 * amounts[22]);  // wetter with height
  EXPECT_LE(fs::file_size(path), 1.5e6);
}

TEST(GlobalSample, PackedNorthFirstAndHydrostatic) {
  const fs::path path = made_folder() / "globe.nc";
  samples::write_global(nc_writer(), path, {});
  const MadeFile file(path);
  const std::vector<double> lat = file.values("latitude"), lon = file.values("longitude");
  EXPECT_EQ(lat.front(), 90);
  EXPECT_EQ(lat.back(), -90);
  EXPECT_EQ(lon.front(), 0);
  EXPECT_EQ(lon.back(), 357.5);
  const std::vector<double> level = file.values("level");
  EXPECT_TRUE(std::ranges::is_sorted(level));
  const auto unpacked = [&](const char* name) {
    std::vector<double> v = file.values(name);
    for (double& x : v) x = x * file.number(name, "scale_factor") + file.number(name, "add_offset");
    return v;
  };
  const std::vector<double> q = unpacked("clwmr"), gh = unpacked("gh"), t = unpacked("t");
  const auto [least, most] = std::ranges::minmax(q);
  EXPECT_LT(least, 0);  // the trap: zero is none
  EXPECT_GT(least, -1e-15);
  EXPECT_GT(most, 5e-5);
  const std::size_t layer = lat.size() * lon.size();
  double worst_m = 0;
  for (std::size_t k = 0; k + 1 < level.size(); ++k)
    for (std::size_t cell = 0; cell < layer; ++cell) {
      const std::size_t high = k * layer + cell, low = high + layer;
      const double thick =
          287.05 / 9.80665 * 0.5 * (t[high] + t[low]) * std::log(level[k + 1] / level[k]);
      worst_m = std::max(worst_m, std::abs(gh[high] - gh[low] - thick));
    }
  EXPECT_LT(worst_m, 6);  // 2 m steps of gh, 0.25 K of t
  EXPECT_LE(fs::file_size(path), 0.3e6);
}

TEST(MadeFiles, ForecastIsSmallAndTheSameTwice) {
  const fs::path one = made_folder() / "one.nc", two = made_folder() / "two.nc";
  samples::write_wrf(nc_writer(), one, {});
  EXPECT_LE(fs::file_size(one), 2.2e6);
  const samples::WrfShape small = {.nx = 24, .ny = 20, .nz = 12, .times = 2};
  samples::write_wrf(nc_writer(), one, small);
  samples::write_wrf(nc_writer(), two, small);
  EXPECT_TRUE(bytes(one) == bytes(two));
  EXPECT_FALSE(fs::exists(one.string() + ".part"));
}

TEST(MadeFiles, EachTwinIsWrittenWithItsTrap) {
  for (const samples::NcTwin& twin : samples::nc_twins()) {
    twin.write(made_folder(), nc_writer());
    EXPECT_TRUE(fs::exists(made_folder() / twin.file)) << twin.name;
  }
  const auto open = [](const char* name) { return MadeFile(made_folder() / name); };
  EXPECT_LT(open("nc_negative.nc").values("clw").front(), 0);
  EXPECT_GT(open("nc_top_down.nc").values("height").front(), 2000);
  EXPECT_GT(open("nc_descending_lat.nc").values("lat").front(), 47.1);
  EXPECT_NEAR(open("nc_lon_360.nc").values("lon").front(), 348, 1e-9);
  EXPECT_NEAR(open("nc_packed_zero.nc").values("clw").front(), -32766, 0);
  EXPECT_EQ(open("nc_fill_time.nc").values("clw").front(), -9999);
  EXPECT_THROW(open("nc_no_units.nc").note("clw", "units"), std::runtime_error);
  EXPECT_THROW(open("nc_truncated.nc"), std::runtime_error);
  // the same cloud, turned: file order must not matter to a reader
  const std::vector<double> up = open("nc_plain.nc").values("clw");
  const std::vector<double> down = open("nc_top_down.nc").values("clw");
  const std::size_t layer = 16 * 20;
  for (std::size_t k = 0; k < 12; ++k)
    for (std::size_t cell = 0; cell < layer; ++cell)
      ASSERT_EQ(up[k * layer + cell], down[(11 - k) * layer + cell]);
}

TEST(MadeFiles, NothingIsLeftWhereWritingFails) {
  const fs::path path = made_folder() / "no" / "such" / "folder.nc";
  EXPECT_THROW(samples::write_wrf(nc_writer(), path, {.nx = 4, .ny = 4, .nz = 4}),
               std::runtime_error);
  // stopped midway
  const fs::path half = made_folder() / "half.nc";
  samples::WrfChange change;
  change.slab = [](const std::string& field, std::size_t, std::vector<double>& values) {
    if (field == "QCLOUD") values.pop_back();
  };
  EXPECT_ANY_THROW(samples::write_wrf(nc_writer(), half, {.nx = 4, .ny = 4, .nz = 4}, change));
  EXPECT_FALSE(fs::exists(half));
  EXPECT_FALSE(fs::exists(half.string() + ".part"));
}

}  // namespace
}  // namespace nepho::test
