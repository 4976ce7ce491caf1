// What is refused: one clear message each, within 5 s, and nothing else on the streams.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <glm/glm.hpp>
#include <random>
#include <stdexcept>

#include "cf_twin.h"
#include "forecast/files/survives.h"
#include "refused.h"
#include "wrf_twin.h"

namespace nepho::forecast::test {
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
  EXPECT_EQ(refusal(twin.write("hours")), "");  // from no date, which is said
  twin.time_units = "parsecs";
  refused(twin.write("parsecs"), {"which times"});
  twin.time_units = "fortnights since 2000-01-01";
  refused(twin.write("fortnights"), {"[time]", "fortnights"});
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

// A variable beside `like`, or `like` itself, with one value everywhere.
void put_everywhere(const std::string& path, const char* name, const char* like, double value,
                    const std::string& units) {
  int file = 0, variable = 0, rank = 0, dimensions[NC_MAX_VAR_DIMS];
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  nc_inq_varid(file, like, &variable);
  nc_inq_var(file, variable, nullptr, nullptr, &rank, dimensions, nullptr);
  if (std::string(name) != like) {
    ASSERT_EQ(nc_def_var(file, name, NC_FLOAT, rank, dimensions, &variable), NC_NOERR);
    nc_put_att_text(file, variable, "units", units.size(), units.data());
  }
  std::size_t total = 1, length = 0;
  for (int d = 0; d < rank; ++d, total *= length) nc_inq_dimlen(file, dimensions[d], &length);
  const std::vector<double> values(total, value);
  ASSERT_EQ(nc_put_var_double(file, variable, values.data()), NC_NOERR);
  nc_close(file);
}

TEST(Malformed, TooThick) {
  CfTwin twin;
  twin.water_scale = 40;  // 16 g/m3 at most
  const std::string path = twin.write("thick");
  EXPECT_EQ(refusal(path), "");
  put_everywhere(path, "qnc", "clw", 1e12, "m-3");  // in droplets of 4 um
  refused(path, {"extinction is higher", "1 /m", "--force"});
  EXPECT_NO_THROW(open(path, true));
}

TEST(Malformed, AirOfNoCloud) {
  const std::string path = CfTwin().write("celsius");
  put_everywhere(path, "t", "t", -20, "");  // degC under the name of K
  refused(path, {"as cold or as warm", "100 to 400 K", "-20 K"});
  EXPECT_THROW(open(path, true), Error);  // no density to draw with
  put_everywhere(path, "t", "t", 5000, "");
  refused(path, {"as cold or as warm", "5000 K"});
  put_everywhere(path, "t", "t", 250, "");
  EXPECT_EQ(refusal(path), "");
}

TEST(Malformed, LayersInNoAtmosphere) {
  WrfTwin twin;
  const std::string path = twin.write("high");
  put_everywhere(path, "PH", "PH", 3e7, "");
  refused(path, {"in no atmosphere", "-15000 to 1000000 m"});
}

TEST(Malformed, Levels) {
  CfTwin twin;
  twin.pressure_hPa = {1000, 700, 900, 500};
  refused(twin.write("levels"),
          {"[level]", "neither rise nor fall", "100000, 70000, 90000, 50000"});
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
          {"[clw]", "the cells of the grid have no place", "5 cells", "--grid"});
  refused(write_flat("mesh", {"height", "index"}, {{"grid_type", "unstructured"}}),
          {"the cells of the grid have no place", "along index"});
  refused(write_flat("no_axes", {"lev", "y", "x"}), {"no coordinates"});
  refused(write_flat("members", {"number", "lev", "lat", "lon"}), {"dimension too many"});
}

TEST(Malformed, SurvivesTellsTheEndOfACopy) {
  EXPECT_TRUE(survives([] {}));
  EXPECT_TRUE(survives([] { throw std::runtime_error("met again here"); }));
  testing::internal::CaptureStderr();
  EXPECT_FALSE(survives([] { std::abort(); }));
  EXPECT_FALSE(survives([] {
    std::fputs("last words\n", stderr);
    std::raise(SIGSEGV);
  }));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Headers with a few bytes changed: opened or refused, never the end of this process, and nothing
// on its streams.
TEST(Malformed, FlippedHeaders) {
  std::mt19937 random(20);
  int opened = 0, refusals = 0, broken_down = 0;
  for (const bool wrf : {true, false})
    for (const int format : {NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL, 0}) {
      if (wrf && format != NC_NETCDF4) continue;
      CfTwin twin;
      twin.format = format;
      const std::string whole = bytes_of(wrf ? WrfTwin().write("flip") : twin.write("flip"));
      for (int n = 0; n < (wrf ? 150 : 100); ++n) {
        std::string bytes = whole;
        for (auto flips = 1 + random() % 6; flips > 0; --flips)
          bytes[random() % std::min<std::size_t>(bytes.size(), 12000)] = char(random());
        const std::string path = write_bytes("flipped.nc", bytes);
        testing::internal::CaptureStderr();
        const std::string text = refusal(path);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        (text.empty() ? opened : refusals) += 1;
        broken_down += text.find("breaks down") != std::string::npos;
      }
    }
  std::printf("measured: %d opened, %d refused, of these %d for HDF5's sake\n", opened, refusals,
              broken_down);
  EXPECT_GT(opened, 20);
  EXPECT_GT(refusals, 100);
}

TEST(Malformed, MissingHeights) {
  const std::string wrf = WrfTwin().write("no_ph");
  put_everywhere(wrf, "PH", "PH", NAN, "");
  refused(wrf, {"[PH, PHB]", "neither rise nor fall", "or missing"});
  const std::string cf = CfTwin().write("no_gh");
  put_everywhere(cf, "gh", "gh", NAN, "");
  refused(cf, {"[gh]", "neither rise nor fall", "missing values only"});
}

// Latitudes in no order: cells that turn both ways.
TEST(Malformed, PlacesWithoutOrder) {
  WrfTwin twin;
  twin.nx = twin.ny = 12;
  const std::string path = twin.write("scrambled");
  int file = 0, variable = 0;
  nc_open(path.c_str(), NC_WRITE, &file);
  nc_inq_varid(file, "XLAT", &variable);
  std::vector<double> values(2u * 12 * 12);
  std::mt19937 random(3);
  for (double& value : values) value = double(random() % 60);
  nc_put_var_double(file, variable, values.data());
  nc_close(file);
  refused(path, {"[XLAT, XLONG]", "turn to the other"});
}

// Idealised runs: every cell at 0 N 0 E.
TEST(Malformed, OnePlaceForAllCells) {
  WrfTwin twin;
  const std::string path = twin.write("one_place");
  put_everywhere(path, "XLAT", "XLAT", 0, "");
  put_everywhere(path, "XLONG", "XLONG", 0, "");
  twin.with_xlat = false;
  const auto map = open(twin.write("no_place"))->grid(0), by_map = open(path)->grid(0);
  for (const double x : {0.0, 2.5, 6.0})
    EXPECT_LT(glm::length(map->lat_lon_deg(x, 1) - by_map->lat_lon_deg(x, 1)), 1e-12);
  int file = 0;
  const double none = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  ASSERT_EQ(nc_put_att_double(file, NC_GLOBAL, "MAP_PROJ", NC_INT, 1, &none), NC_NOERR);
  nc_close(file);
  const auto plane = open(path);
  const glm::dvec2 west = plane->grid(0)->lat_lon_deg(0, 2.5),
                   east = plane->grid(0)->lat_lon_deg(6, 2.5);
  const double metre_deg = 360 / (2 * M_PI * 6378137.0);
  EXPECT_NEAR(west.y, -3 * twin.dx_m * metre_deg, 1e-5);
  EXPECT_NEAR(east.y, 3 * twin.dx_m * metre_deg, 1e-5);
  EXPECT_NEAR(east.x, 0, 1e-9);
  const auto said = plane->assumptions();
  EXPECT_TRUE(std::ranges::any_of(
      said, [](const std::string& text) { return text.find("0 N 0 E") != std::string::npos; }));
}

TEST(Malformed, GroundOfFillValuesIsSea) {
  const std::string path = WrfTwin().write("ground");
  put_everywhere(path, "HGT", "HGT", 1e20, "");
  put_everywhere(path, "LANDMASK", "LANDMASK", -9999, "");
  const ForecastGround ground = open(path)->ground(0);
  EXPECT_EQ(ground.height_m, std::vector<float>(30, 0.0f));
  EXPECT_EQ(ground.water, std::vector<float>(30, 1.0f));
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

// Soundings of stations: half way between them there are no cells.
TEST(Malformed, UnconnectedPoints) {
  const auto written = [](const char* kind) {
    const std::string path = folder() / "stations.nc";
    NcWriter nc(path);
    nc.dimension("station", 6);
    nc.dimension("lev", 4);
    if (*kind) nc.global("featureType", std::string(kind));
    nc.variable("lev", NC_DOUBLE, {"lev"}, {100, 500, 900, 1300},
                {{"units", std::string("m")}, {"standard_name", std::string("altitude")}});
    nc.variable("lat", NC_DOUBLE, {"station"}, {1, 2, 3, 1, 2, 3},
                {{"units", std::string("degrees_north")}});
    nc.variable("lon", NC_DOUBLE, {"station"}, {1, 1, 1, 2, 2, 2},
                {{"units", std::string("degrees_east")}});
    nc.variable("clw", NC_FLOAT, {"lev", "station"}, std::vector<double>(24, 1e-4),
                {{"units", std::string("kg m-3")}});
    return path;
  };
  refused(written("timeSeriesProfile"),
          {"unconnected points", "[clw]", "timeSeriesProfile", "--grid FILE", "interpolate"});
  EXPECT_EQ(refusal(written("")), "");  // centres of cells, as models write them
}

// A chunk of a later time: what came before is read, and that time refused.
TEST(Malformed, DamagedInTheMiddleOfARun) {
  const auto written = [](double change) {
    const std::string path = folder() / "later.nc";
    {
      NcWriter nc(path, NC_NETCDF4);
      nc.dimension("time", 2);
      nc.dimension("lev", 4);
      nc.dimension("lat", 5);
      nc.dimension("lon", 6);
      nc.variable("time", NC_DOUBLE, {"time"}, {0, 6},
                  {{"units", std::string("hours since 2020-01-01")}});
      nc.variable("lev", NC_DOUBLE, {"lev"}, {100, 500, 900, 1300},
                  {{"units", std::string("m")}, {"standard_name", std::string("altitude")}});
      nc.variable("lat", NC_DOUBLE, {"lat"}, {1, 2, 3, 4, 5},
                  {{"units", std::string("degrees_north")}});
      nc.variable("lon", NC_DOUBLE, {"lon"}, {1, 2, 3, 4, 5, 6},
                  {{"units", std::string("degrees_east")}});
      std::vector<double> water;
      for (int n = 0; n < 240; ++n)
        water.push_back(n < 120 ? 1e-4 : 1e-4 + 1e-6 * (n % 37) + change * (n % 11));
      nc.variable("clw", NC_FLOAT, {"time", "lev", "lat", "lon"}, water,
                  {{"units", std::string("kg m-3")}}, {1, 4, 5, 6});
    }
    return bytes_of(path);
  };
  // The second time's chunk is where two files differ that are alike before.
  std::string bytes = written(0);
  const std::string other = written(3e-7);
  ASSERT_EQ(bytes.size(), other.size());
  const auto differ = std::mismatch(bytes.begin(), bytes.end(), other.begin());
  ASSERT_NE(differ.first, bytes.end());
  std::fill_n(differ.first + 20, 24, '\0');
  const std::string path = write_bytes("later_damaged.nc", bytes);
  const auto forecast = open(path);
  ASSERT_EQ(forecast->times_s().size(), 2u);
  EXPECT_GT(forecast->columns(0).extinction_per_m[0], 0);
  nepho::test::expect_quiet_refusal([&] { forecast->columns(1); }, {path, "[clw]", "damaged"});
}

}  // namespace
}  // namespace nepho::forecast::test
