// `info` as programs read it: through a parser, against its published schema, and against what made
// and real files hold.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "test_folder.h"

namespace nepho::test {
namespace {

using Json = nlohmann::json;

const TestFolder& folder() {
  static const TestFolder folder("info");
  return folder;
}

struct Ran {
  std::string out;
  int status = 0;
};
Ran run(const std::string& command) {
  Ran ran;
  FILE* pipe = popen((command + " 2>" + folder() / "stderr").c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    ran.out.append(buffer, n);
  ran.status = WEXITSTATUS(pclose(pipe));
  return ran;
}
Ran info(const std::string& arguments) {
  return run(NEPHO_PROGRAM " info " + arguments);
}

const Json& schema() {
  static const Json schema = Json::parse(std::ifstream(NEPHO_PROJECT_DIR "/docs/info.schema.json"));
  return schema;
}

bool has_type(const Json& value, const std::string& type) {
  return type == "object"    ? value.is_object()
         : type == "array"   ? value.is_array()
         : type == "string"  ? value.is_string()
         : type == "boolean" ? value.is_boolean()
         : type == "null"    ? value.is_null()
         : type == "integer" ? value.is_number_integer()
                             : value.is_number();
}

// The keywords that docs/info.schema.json uses.
void expect_valid(const Json& value, const Json& rule, const std::string& where) {
  const Json types = rule["type"].is_array() ? rule["type"] : Json::array({rule["type"]});
  EXPECT_TRUE(std::any_of(types.begin(), types.end(),
                          [&](const Json& t) { return has_type(value, t.get<std::string>()); }))
      << where << ": " << value;
  if (value.is_array() && rule.contains("items"))
    for (std::size_t n = 0; n < value.size(); ++n)
      expect_valid(value[n], rule["items"], where + "[" + std::to_string(n) + "]");
  if (!value.is_object()) return;
  for (const Json& name : rule.value("required", Json::array()))
    EXPECT_TRUE(value.contains(name.get<std::string>())) << where << ": no " << name;
  for (const auto& [key, member] : value.items()) {
    const Json properties = rule.value("properties", Json::object());
    const Json& more = rule["additionalProperties"];
    if (properties.contains(key))
      expect_valid(member, properties[key], where + "." + key);
    else if (more.is_object())
      expect_valid(member, more, where + "." + key);
    else
      EXPECT_EQ(more, true) << where << ": unpublished " << key;
  }
}

// Throws where it is no JSON.
Json told(const std::string& arguments) {
  const Ran ran = info(arguments + " --json");
  EXPECT_EQ(ran.status, 0) << arguments;
  Json json = Json::parse(ran.out);
  expect_valid(json, schema(), "");
  return json;
}

std::string scene(const std::string& name, const std::string& parameters) {
  const std::string path = folder() / name;
  std::ofstream(path) << R"({"volumes": [{"source": "analytic", "name": "ball", "parameters": {)"
                      << parameters << "}}]}";
  return path;
}

TEST(Info, TellsOfBricksWhereThereAreNoData) {
  const Json v = told(scene("ball.json", R"("kind": "sphere", "radius_m": 500, "max_level": 4,
      "extinction_per_m": 0.01)") +
                      " --check")["volumes"][0];
  EXPECT_EQ(v["columns"]["from"], "bricks");
  EXPECT_NEAR(v["columns"]["optical_depth_max"], 10, 0.2);
  EXPECT_NEAR(v["columns"]["optical_depth_mean_of_cloudy"], 10 * 2.0 / 3, 0.2);
  EXPECT_NEAR(v["columns"]["cloud_top_highest_m"].get<double>() -
                  v["columns"]["cloud_base_lowest_m"].get<double>(),
              1000, 40);
  EXPECT_TRUE(v["check"]["kept"]);
  EXPECT_LT(std::abs(v["check"]["total_optical_depth_difference"].get<double>()), 2e-3);
}

// Coarse bricks are told to be coarse: all is printed, valid, and the exit status is 1.
TEST(Info, BrokenPromisesAreExitStatusOne) {
  const std::string coarse = scene("coarse.json", R"("kind": "sphere", "radius_m": 500,
      "extinction_per_m": 0.01, "max_level": 0)");
  const Ran ran = info(coarse + " --check --json");
  EXPECT_EQ(ran.status, 1);
  const Json json = Json::parse(ran.out);
  expect_valid(json, schema(), "");
  EXPECT_FALSE(json["volumes"][0]["check"]["kept"]);
  std::ifstream said(folder() / "stderr");
  const std::string text{std::istreambuf_iterator<char>(said), {}};
  EXPECT_NE(text.find("the bricks are not what the source holds"), std::string::npos) << text;
  EXPECT_EQ(info(coarse).status, 0);
}

TEST(Info, PicturesOfScenesAreEstimated) {
  const Json p = told(scene("picture.json", R"("kind": "sphere", "max_level": 3)"))["picture"];
  EXPECT_GT(p["bricks"], 8);
  EXPECT_GT(p["gpu_bytes"], p["bricks"].get<double>() * 729 * 2);
  EXPECT_FALSE(p["budget_bound"]);
}

#ifdef NEPHO_HAS_NETCDF
// A nest of two times, made by make_samples in its own words.
const std::string& made() {
  static const std::string path = [] {
    const Ran ran =
        run(std::string(NEPHO_MAKE_SAMPLES) + " " + folder() / "made" + " --like nc_moving_nest");
    EXPECT_EQ(ran.status, 0);
    return std::string(folder() / "made/nc_moving_nest.nc");
  }();
  return path;
}

TEST(Info, ForecastsAreRecognised) {
  const Json out = told(made() + " --check"), v = out["volumes"][0];
  for (const char* what : {"model", "grid", "levels", "droplets"})
    EXPECT_FALSE(v["recognised"][what].get<std::string>().empty()) << what;
  ASSERT_FALSE(v["variables"].empty());
  for (const Json& variable : v["variables"]) {
    EXPECT_FALSE(variable["unit"].get<std::string>().empty());
    EXPECT_GT(variable["max"], 0);
  }
  const Json& c = v["columns"];
  EXPECT_EQ(c["from"], "data");
  EXPECT_GT(c["optical_depth_max"], c["optical_depth_mean"]);
  EXPECT_GT(c["liquid_path_max_kg_per_m2"], 0);
  EXPECT_GT(c["cover"], 0);
  EXPECT_LT(c["cloud_base_lowest_m"], c["cloud_top_highest_m"]);
  EXPECT_LE(c["cloud_top_highest_m"], c["data_top_m"]);
  EXPECT_TRUE(v["check"]["kept"]);
  EXPECT_EQ(v["time"]["times_utc"].size(), v["states"].size());
  EXPECT_GT(out["picture"]["bricks"], 0);
}

TEST(Info, TimesAreChosenByPlaceAndAmount) {
  const Json states = told(made())["volumes"][0]["states"];
  ASSERT_GE(states.size(), 2u);
  std::size_t cloudiest = 0;
  for (std::size_t i = 1; i < states.size(); ++i)
    if (states[i]["optical_depth_mean"] > states[cloudiest]["optical_depth_mean"]) cloudiest = i;
  const auto shown = [&](const std::string& time) {
    return told(made() + " --time " + time)["volumes"][0]["time"]["shown_index"].get<std::size_t>();
  };
  EXPECT_EQ(shown("first"), 0u);
  EXPECT_EQ(shown("last"), states.size() - 1);
  EXPECT_EQ(shown("cloudiest"), cloudiest);
  EXPECT_EQ(shown("1"), 1u);
  EXPECT_EQ(shown(states[1]["utc"].get<std::string>()), 1u);
  EXPECT_EQ(shown(std::to_string(states[1]["time_s"].get<int>()) + "s"), 1u);
  EXPECT_EQ(info(made() + " --time " + std::to_string(states.size())).status, 1);
}

TEST(Info, FitsAScreen) {
  const std::string text = info(made()).out;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 40);
  for (const char* part : {"model  ", "grid  ", "levels  ", "times  ", "water path  ",
                           "optical depth  ", "cloud  ", "picture by default"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}
#endif

#ifdef NEPHO_TEST_REAL_DATA
// What ncdump and grib_ls say of these files.
TEST(Info, RealFilesHaveTheirFacts) {
  const struct {
    const char *file, *time, *variable;
    double max;
    int missing;
    const char* grid;
    double top_m;
  } files[] = {
      {"nc/wrf_katrina_10km_nest_4t.nc --time 0", "2005-08-28T12:00:00Z", "QCLOUD", 1.81e-3, 0,
       "48 x 48 cells of 10 km, Mercator", 6200},
      {"nc/um_38lev_cosp_input_2d.nc", "", "mr_lsliq", 8.02e-4, 0, "17 x 9 cells", 42400},
      {"nc/icon_les_stratocumulus_L150.nc", "2013-05-02T13:40:00Z", "clw", 8.14e-4, 0,
       "6 x 9 cells", 21000},
      {"nc/gfs_2p5deg_20110110_f120_DERIVED_cf_packed.nc", "2011-01-15T12:00:00Z", "clwmr",
       1.118e-3, 52560, "144 x 73 cells", 34500},
      {"grib/gfs_2p5deg_20110110_f120.grib2", "2011-01-15T12:00:00Z", "clwmr", 1.118e-3, 52560,
       "144 x 73 cells", 34500},
  };
  for (const auto& f : files) {
    SCOPED_TRACE(f.file);
    const Json v = told(std::string(NEPHO_TEST_REAL_DATA "/") + f.file)["volumes"][0];
    EXPECT_EQ(v["time"].value("shown_utc", std::string()), f.time);
    const Json& water = v["variables"][0];
    EXPECT_EQ(water["name"], f.variable);
    EXPECT_NEAR(water["max"].get<double>() / f.max, 1, 3e-3);
    EXPECT_EQ(water["missing"], f.missing);
    EXPECT_EQ(v["recognised"]["grid"].get<std::string>().find(f.grid), 0u);
    EXPECT_NEAR(v["columns"]["data_top_m"].get<double>() / f.top_m, 1, 0.01);
  }
}

TEST(Info, BricksOfRealFilesKeepTheirPromise) {
  for (const char* file : {"nc/wrf_katrina_10km_nest_4t.nc", "nc/um_38lev_cosp_input_2d.nc",
                           "nc/icon_les_stratocumulus_L150.nc",
                           "grib/gfs_2p5deg_20110110_f120.grib2", "vdb/wdas_cloud_sixteenth.vdb"}) {
    SCOPED_TRACE(file);
    EXPECT_EQ(info(std::string(NEPHO_TEST_REAL_DATA "/") + file + " --check").status, 0);
  }
}
#endif

}  // namespace
}  // namespace nepho::test
