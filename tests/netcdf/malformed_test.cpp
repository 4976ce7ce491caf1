// What is refused: one clear message each, within 5 s, and nothing else on the streams.

#include <chrono>
#include <fstream>

#include "twins.h"

namespace nepho::netcdf::test {
namespace {

std::string refused(const std::string& path, const std::vector<std::string>& says) {
  const auto start = std::chrono::steady_clock::now();
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const std::string text = refusal(path);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  for (const std::string& part : says)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in: " << text;
  EXPECT_NE(text.find(path), std::string::npos) << text;
  // What crosses to the host is 512 characters a part.
  try {
    open(path);
  } catch (const Error& e) {
    for (const std::string* part : {&e.parts().expected, &e.parts().hint, &e.parts().what})
      EXPECT_LT(part->size(), 512u) << *part;
  }
  std::printf("measured: %s\n", text.c_str());
  return text;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {(std::istreambuf_iterator<char>(in)), {}};
}

std::string write_bytes(const std::string& name, const std::string& bytes) {
  const std::string path = folder() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

TEST(Malformed, NoNetcdf) {
  refused(write_bytes("text.nc", "This is a letter, not a forecast.\n"), {"not a netCDF file"});
  refused(write_bytes("empty.nc", ""), {"is empty", "0 bytes"});
  refused(folder() / "nothing.nc", {"no such file"});
  refused(std::filesystem::temp_directory_path().string(), {"folder"});
}

TEST(Malformed, Truncated) {
  for (const int format : {NC_NETCDF4, 0, NC_64BIT_OFFSET, NC_CDF5}) {
    CfTwin twin;
    twin.format = format;
    const std::string whole = bytes_of(twin.write("whole"));
    int refusals = 0;
    // A netCDF-4 file's end may hold nothing that is read.
    for (const double part : {0.02, 0.1, 0.3, 0.6, 0.9}) {
      const std::string path =
          write_bytes("cut.nc", whole.substr(0, std::size_t(part * double(whole.size()))));
      testing::internal::CaptureStderr();
      refusals += !refusal(path).empty();
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }
    EXPECT_EQ(refusals, 5) << format;
    EXPECT_EQ(refusal(write_bytes("all.nc", whole)), "");
  }
}

TEST(Malformed, NoCloudWater) {
  CfTwin twin;
  twin.water_name = "wind";
  refused(twin.write("no_water"),
          {"no cloud water", "wind(time 2, level 4, lat 5, lon 6)", "qcloud", "clw"});
}

TEST(Malformed, Units) {
  CfTwin twin;
  twin.water_units = "";
  refused(twin.write("no_units"), {"[clw]", "no units", "kg kg-1"});
  twin.water_units = "spoons";
  refused(twin.write("spoons"), {"[clw]", "not known", "spoons"});
  twin.water_units = "K";
  refused(twin.write("kelvin"), {"[clw]", "no water content", "\"K\""});
  twin = CfTwin();
  twin.level_units = "furlongs";
  EXPECT_EQ(refusal(twin.write("furlongs")), "");  // gh stands beside it
  twin.time_units = "hours";
  refused(twin.write("hours"), {"which times"});
  twin.time_units = "months since 2000-01-01";
  refused(twin.write("months"), {"[time]", "months"});
}

TEST(Malformed, MissingEverywhere) {
  CfTwin twin;
  twin.water_scale = NAN;
  refused(twin.write("nan"), {"[clw]", "missing", "NaN"});
  twin.water_scale = 0;
  twin.fill = 0;  // all values are the fill value
  refused(twin.write("fill"), {"[clw]", "all values"});
}

TEST(Malformed, TooMuchWater) {
  CfTwin twin;
  twin.water_scale = 1000;  // g/kg under the name of kg/kg
  const std::string path = twin.write("thousand");
  refused(path, {"[clw]", "more water than any cloud", "20 g/m3", "--force"});
  EXPECT_NO_THROW(open(path, true));
}

TEST(Malformed, Levels) {
  CfTwin twin;
  twin.pressure_hPa = {1000, 700, 900, 500};
  refused(twin.write("levels"), {"[level]", "neither rise nor fall", "100000, 70000, 90000, 50000"});
  twin.pressure_hPa = {1000, 1000, 900, 500};
  refused(twin.write("twice"), {"[level]", "neither rise nor fall"});
}

TEST(Malformed, Latitudes) {
  CfTwin twin;
  twin.latitude = {-30, 0, 30, 60, 95};
  refused(twin.write("beyond"), {"lat", "-90 to 90", "95"});
  twin.latitude = {-30, 0, 30, 10, 20};
  refused(twin.write("zigzag"), {"lat", "rise or fall"});
}

std::string write_flat(const std::string& name, const std::vector<std::string>& dimensions,
                       const Attributes& more = {}) {
  const std::string path = folder() / (name + ".nc");
  NcWriter nc(path);
  std::size_t total = 1;
  for (std::size_t d = 0; d < dimensions.size(); ++d) {
    nc.dimension(dimensions[d], 3 + d);
    total *= 3 + d;
  }
  Attributes attributes = more;
  attributes["units"] = std::string("kg kg-1");
  nc.variable("clw", NC_FLOAT, dimensions, std::vector<double>(total, 1e-4), attributes);
  return path;
}

TEST(Malformed, NoHorizontalGrid) {
  refused(write_flat("profile", {"time", "height"}), {"[clw]", "no horizontal grid", "height 4"});
  refused(write_flat("triangles", {"time", "height", "ncells"}),
          {"[clw]", "triangular grids are not read yet", "ncells 5"});
  refused(write_flat("mesh", {"height", "index"}, {{"grid_type", "unstructured"}}),
          {"triangular grids are not read yet"});
  refused(write_flat("no_axes", {"lev", "y", "x"}), {"no coordinates"});
  refused(write_flat("members", {"number", "lev", "lat", "lon"}), {"dimension too many"});
}

TEST(Malformed, WrfWithoutItsAir) {
  const std::string path = folder() / "wrf_bare.nc";
  {
    NcWriter nc(path);
    nc.global("TITLE", std::string("OUTPUT FROM WRF V4"));
    for (const auto& [name, size] : std::map<std::string, std::size_t>{{"Time", 1},
                                                                       {"west_east", 3},
                                                                       {"south_north", 3},
                                                                       {"bottom_top", 2},
                                                                       {"bottom_top_stag", 3}})
      nc.dimension(name, size);
    nc.variable("QCLOUD", NC_FLOAT, {"Time", "bottom_top", "south_north", "west_east"},
                std::vector<double>(18, 1e-4), {{"units", "kg kg-1"}});
  }
  refused(path, {"lacks a variable", "PH"});
}

}  // namespace
}  // namespace nepho::netcdf::test
