#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "scene/json_tree.h"
#include "scene/object_reader.h"
#include "scene/parameter.h"
#include "scene/scene_file.h"
#include "scene/scene_grammar.h"

namespace nepho {
namespace {

Scene parse(const std::string& text) {
  return parse_scene(text, "s.json", "/data");
}

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

void expect_in(const std::string& part, const std::string& whole) {
  EXPECT_NE(whole.find(part), std::string::npos) << whole << "\n  lacks: " << part;
}

const std::string kVolume = R"({"source": "analytic", "parameters": {"kind": "sphere"}})";

TEST(JsonTree, every_key_and_value_knows_its_line_and_column) {
  const std::string text =
      "{\n  \"a\" : [1, -2.5e1,\n\t\"x\\\"y\"],\"b\":{\"c\":true } ,\n\"d\":12}";
  const JsonValue tree = parse_json(text, "t");
  const auto at = [](const TextPosition& p) { return std::pair(p.line, p.column); };
  EXPECT_EQ(at(tree.at), std::pair(1, 1));
  ASSERT_EQ(tree.members.size(), 3u);
  const JsonValue& a = tree.members[0].value;
  EXPECT_EQ(at(tree.members[0].at), std::pair(2, 3));
  EXPECT_EQ(at(a.at), std::pair(2, 9));
  EXPECT_EQ(at(a.items[0].at), std::pair(2, 10));
  EXPECT_EQ(at(a.items[1].at), std::pair(2, 13));
  EXPECT_EQ(at(a.items[2].at), std::pair(3, 2));
  EXPECT_EQ(a.items[1].number, -25.0);
  EXPECT_EQ(a.items[2].text, "x\"y");
  EXPECT_EQ(at(tree.members[1].at), std::pair(3, 10));
  EXPECT_EQ(at(tree.members[1].value.members[0].at), std::pair(3, 15));
  EXPECT_EQ(at(tree.members[1].value.members[0].value.at), std::pair(3, 19));
  EXPECT_EQ(at(tree.members[2].at), std::pair(4, 1));
  EXPECT_EQ(at(tree.members[2].value.at), std::pair(4, 5));
}

TEST(JsonTree, what_is_no_json_is_named_with_its_place) {
  for (const auto& [text, where] : std::initializer_list<std::pair<const char*, const char*>>{
           {"{\"a\": 1,}", "t:1:9"},
           {"{\n\"a\" 1}", "t:2:5"},
           {"", "t:1:"},
           {"{\"a\": nan}", "t:1:8"},
           {"{\"a\": 1e999}", "t:1:"},
           {"{\"a\":1, \"a\":2}", "t:1:9"}}) {
    try {
      parse_json(text, "t");
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      expect_in(where, e.what());
    }
  }
  EXPECT_THROW(parse_json(std::string(100000, '['), "t"), Error);
}

TEST(SceneFile, errors_name_line_column_and_field) {
  const std::string head = "{\n \"volumes\": [" + kVolume + "],\n ";
  const auto with = [&](const std::string& rest) { return message_of(head + rest + "}"); };
  expect_in("s.json:3:2 (colour): unknown field: found 'colour'", with("\"colour\": 1"));
  expect_in("did you mean 'camera'?", with("\"camra\": {}"));
  expect_in("s.json:3:10 (sun.elevation): missing unit", with("\"sun\": {\"elevation\": 40}"));
  expect_in("did you mean 'elevation_deg'?", with("\"sun\": {\"elevation\": 40}"));
  expect_in("s.json:3:21 (image.width): wrong type: found the text '640', expected a whole number",
            with("\"image\": {\"width\": \"640\"}"));
  expect_in("expected a whole number", with("\"image\": {\"width\": 64.5}"));
  expect_in("out of range: found 0, expected 1 to 16384", with("\"image\": {\"width\": 0}"));
  expect_in("found 100000", with("\"image\": {\"width\": 100000}"));
  expect_in("a list of three numbers", with("\"camera\": {\"look_from_m\": [1, 2]}"));
  expect_in("camera.look_from_m[1]", with("\"camera\": {\"look_from_m\": [1, \"2\", 3]}"));
  expect_in("exclude each other", with("\"render\": {\"step_voxels\": 1, \"tolerance\": 0.1}"));
  for (const char* given : {"tolerance", "step_voxels", "budget_mib"})
    expect_in("exclude each other",
              with("\"render\": {\"target_error\": 0.01, \"" + std::string(given) + "\": 1}"));
  expect_in("exclude each other", with("\"render\": {\"target_error\": 0.1, \"target_ms\": 5}"));
  expect_in("expected 0.0001 to 1", with("\"render\": {\"target_error\": 0}"));
  expect_in("nothing to choose",
            with("\"render\": {\"target_ms\": 33, \"engine\": \"reference\"}"));
  expect_in("expected 'elevation_deg'", with("\"sun\": {\"azimuth_deg\": 40}"));
  expect_in("one of aces, none", with("\"tone_map\": \"filmic\""));
  expect_in("camera looks nowhere",
            with("\"camera\": {\"look_from_m\": [1,2,3], \"look_at_m\": [1,2,3]}"));
  expect_in("not a direction", with("\"camera\": {\"up_ecef\": [0,0,0]}"));
  expect_in(
      "does not belong",
      message_of(R"({"volumes": [{"source": "a", "phase": {"kind": "mie", "asymmetry": 0}}]})"));
  expect_in("missing field: expected 'volumes'", message_of("{}"));
  expect_in("nothing to draw", message_of("{\"volumes\": []}"));
  expect_in("not a scene", message_of("[1]"));
  expect_in("volumes[1]", message_of("{\"volumes\": [" + kVolume + ", {\"source\": 3}]}"));
}

TEST(SceneFile, parameters_come_in_si_with_or_without_a_unit_in_the_name) {
  const Scene scene = parse(R"({"volumes": [{"source": "x", "parameters": {
      "radius": "0.5 km", "height_km": 2, "extinction_per_m": 0.02, "extinction2": "20 1/km",
      "water": "0.3 g m-3", "angle": "90 deg", "kind": "step_cloud", "max_level": 4,
      "metres_per_unit": 0.1, "file": "3d", "open": true}}]})");
  const std::pair<const char*, double> expected[] = {{"radius_m", 500},
                                                     {"height_m", 2000},
                                                     {"extinction_per_m", 0.02},
                                                     {"extinction2_per_m", 0.02},
                                                     {"water_kg_per_m3", 3e-4},
                                                     {"angle_rad", glm::half_pi<double>()},
                                                     {"kind", 0},
                                                     {"max_level", 4},
                                                     {"metres_per_unit", 0.1},
                                                     {"file", 0},
                                                     {"open", 1}};
  const auto& parameters = scene.volumes[0].parameters;
  ASSERT_EQ(parameters.size(), std::size(expected));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_EQ(parameters[i].name, expected[i].first);
    EXPECT_NEAR(parameters[i].number, expected[i].second, 1e-12 * std::abs(expected[i].second));
  }
  EXPECT_EQ(parameters[6].text, "step_cloud");
  EXPECT_EQ(parameters[9].text, "3d");
}

TEST(SceneFile, parameters_without_or_with_a_wrong_unit_are_refused) {
  const auto with = [](const std::string& rest) {
    return message_of("{\"volumes\": [{\"source\": \"x\", \"parameters\": {" + rest + "}}]}");
  };
  expect_in("s.json:1:59 (parameters.extinction): missing unit", with("\"extinction\": \"0.02\""));
  expect_in("wrong unit", with("\"radius_m\": \"3 1/m\""));
  expect_in("s.json:1:", with("\"radius\": \"3 parsnips\""));
  expect_in("wrong type", with("\"radius\": [1]"));
}

TEST(SceneFile, local_points_stand_in_the_scenes_frame) {
  const Scene scene = parse(R"({"place": {"lat_deg": 0, "lon_deg": 90, "height_m": 100},
      "volumes": [)" + kVolume +
                            R"(], "camera": {"look_from_m": [1, 2, 3],
      "look_at": {"lat_deg": 0, "lon_deg": 90, "height_m": 100}, "fov_deg": 30},
      "sun": {"azimuth_deg": 90, "elevation_deg": 0}})");
  // At 0 N 90 E: east = -x, north = z, up = y.
  const glm::dvec3 eye = *scene.camera.eye_m, target = *scene.camera.target_m;
  EXPECT_NEAR(glm::length(target - glm::dvec3(0, 6378237.0, 0)), 0, 1e-8);
  EXPECT_NEAR(glm::length(eye - target - glm::dvec3(-1, 3, 2)), 0, 1e-8);
  EXPECT_NEAR(glm::length(*scene.sun.to_sun - glm::dvec3(-1, 0, 0)), 0, 1e-15);
  EXPECT_NEAR(*scene.camera.vertical_fov_rad, glm::pi<double>() / 6, 1e-15);
}

TEST(SceneFile, files_are_relative_to_the_scene_file) {
  const Scene scene =
      parse(R"({"volumes": [{"source": "openvdb", "files": ["../a.vdb", "/b/c.vdb"]}]})");
  EXPECT_EQ(scene.volumes[0].files, (std::vector<std::string>{"/a.vdb", "/b/c.vdb"}));
  EXPECT_EQ(scene.volumes[0].name, "a");
}

// What a picture's metadata holds draws the same picture only if no bit is lost.
TEST(SceneFile, what_is_written_reads_back_to_the_same_bits) {
  Scene scene = parse(R"({"name": "n", "place": {"lat_deg": 46.1, "lon_deg": 7.3, "height_m": 1e3,
      "heading_deg": 33.3}, "volumes": [{"source": "x", "name": "v", "files": ["d/a.vdb", "/z/b"],
      "place": {"lat_deg": 1, "lon_deg": 2}, "phase": {"kind": "mie", "effective_radius_m": 8e-6},
      "co_albedo": [0.1, 0.2, 0.3], "time_s": 0.041666666666666664,
      "parameters": {"radius": "0.3 km", "w": "text", "n": 3, "e_per_m": 0.1}},
      {"source": "y", "phase": {"kind": "henyey_greenstein", "asymmetry": 0.7}},
      {"source": "z", "phase": {"kind": "hg_draine", "effective_radius_m": 7e-6}}],
      "camera": {"look_from_m": [1.1, 2.2, 3.3], "look_at_m": [0.1, 0.7, 900], "fov_deg": 33},
      "sun": {"azimuth_deg": 123.4, "elevation_deg": 5.6, "irradiance_W_per_m2_nm": [1, 2, 3]},
      "sky": {"zenith_W_per_m2_sr_nm": [0.1, 0.2, 0.3], "horizon_W_per_m2_sr_nm": [1, 1, 1],
      "below_W_per_m2_sr_nm": [0, 0, 0]}, "image": {"width": 33, "height": 44},
      "render": {"budget_mib": 12.5, "tolerance": 0.003, "fetch": "texels8", "light": "single",
      "octaves": 4, "pixels_per_voxel": 1.5, "max_level": 7, "seed": 77, "probe_pixels": 5,
      "probe_paths": 9, "pixels": "all"},
      "exposure_ev": 1.37, "tone_map": "none", "dither": "ordered"})");
  scene.camera.up = glm::normalize(glm::dvec3(0.1, 0.7, 0.3));
  const std::string once = write_scene(scene, "/data");
  const Scene back = parse(once);
  EXPECT_EQ(write_scene(back, "/data"), once);
  EXPECT_EQ(once.find('\n'), std::string::npos);
  EXPECT_EQ(back.camera.eye_m, scene.camera.eye_m);
  EXPECT_EQ(back.camera.target_m, scene.camera.target_m);
  EXPECT_EQ(back.camera.up, scene.camera.up);
  EXPECT_EQ(back.camera.vertical_fov_rad, scene.camera.vertical_fov_rad);
  EXPECT_EQ(back.sun.to_sun, scene.sun.to_sun);
  EXPECT_EQ(back.sky->up, scene.sky->up);
  EXPECT_EQ(back.volumes[0].parameters[0].number, scene.volumes[0].parameters[0].number);
  EXPECT_EQ(back.volumes[0].files, scene.volumes[0].files);
  EXPECT_EQ(back.volumes[0].time_s, scene.volumes[0].time_s);
  EXPECT_EQ(back.volumes[1].phase->asymmetry, 0.7);
  EXPECT_EQ(back.render.seed, 77u);
  EXPECT_EQ(back.render.tolerance, 0.003);
  EXPECT_EQ(back.render.probe_paths, 9);
  EXPECT_EQ(back.render.pixels, WhichPixels::kAll);
  EXPECT_EQ(back.exposure_ev, 1.37);
  EXPECT_TRUE(back.dither);
}

TEST(SceneFile, a_target_stands_for_the_settings_that_it_chooses) {
  const Scene scene =
      parse("{\"volumes\": [" + kVolume + R"(], "render": {"target_error": 0.03}})");
  EXPECT_EQ(scene.target.error, 0.03);
  const std::string written = write_scene(scene, "/data");
  EXPECT_EQ(parse(written).target.error, 0.03);
  EXPECT_EQ(written.find("tolerance"), std::string::npos);
  const Scene timed = parse("{\"volumes\": [" + kVolume + R"(], "render": {"target_ms": 33}})");
  EXPECT_EQ(parse(write_scene(timed, "/data")).target.frame_ms, 33);
}

TEST(SceneFile, points_are_over_the_scenes_own_planet) {
  const Scene scene = parse("{\"volumes\": [" + kVolume + R"(],
      "planet": {"equatorial_m": 3400000, "polar_m": 3380000},
      "camera": {"look_from": {"lat_deg": 0, "lon_deg": 90, "height_m": 1000},
                 "look_at": {"lat_deg": 90, "lon_deg": 0, "height_m": 0}}})");
  EXPECT_LT(glm::length(*scene.camera.eye_m - glm::dvec3(0, 3401000, 0)), 1e-6);
  EXPECT_LT(glm::length(*scene.camera.target_m - glm::dvec3(0, 0, 3380000)), 1e-6);
}

TEST(Parameter, keeps_the_name_as_it_was_written) {
  EXPECT_EQ(make_parameter("base", "5 s", "x").name, "base_s");
  EXPECT_EQ(make_parameter("base", "5 s", "x").written, "base");
  EXPECT_EQ(make_parameter("base_km", "5", "x").written, "base_km");
  EXPECT_EQ(make_parameter("base_m", "5", "x").written, "");
}

// The same for what a scene has on a planet.
TEST(SceneFile, a_planet_reads_back_to_the_same_bits) {
  Scene scene = parse(R"({"volumes": [{"source": "netcdf", "files": ["a.nc"],
      "utc": "2005-08-28T15:00:00Z"}], "camera": {"stand": {"lat_deg": 24.1, "lon_deg": -86.7,
      "azimuth_deg": 33.3, "elevation_deg": 7.7, "eye_height_m": 1.7}},
      "sun": {"utc": "2005-08-28T15:00:00.5Z"}, "planet": {"equatorial_m": 3396190.1,
      "polar_m": 3376200.3, "air": {"rayleigh_per_m": [1.1e-7, 2.2e-7, 3.3e-7],
      "rayleigh_scale_m": 11100.1, "aerosol_extinction_per_m": [1e-5, 2e-5, 3e-5],
      "aerosol_albedo": 0.77, "aerosol_asymmetry": 0.66, "aerosol_scale_m": 1234.5,
      "ozone_per_m": [0, 1e-7, 0], "ozone_low_m": 1e4, "ozone_peak_m": 2e4, "ozone_high_m": 3e4,
      "top_m": 88888.8}, "ground": {"land_albedo": [0.3, 0.2, 0.1],
      "water_albedo": [0.01, 0.02, 0.03], "wind_m_per_s": 3.3}}})");
  const std::string once = write_scene(scene, "/data");
  const Scene back = parse(once);
  EXPECT_EQ(write_scene(back, "/data"), once);
  EXPECT_EQ(back.volumes[0].utc_ns, 1125241200000000000);
  EXPECT_EQ(back.sun.utc_ns, 1125241200500000000);
  EXPECT_EQ(back.camera.stand->azimuth_deg, 33.3);
  EXPECT_EQ(back.camera.stand->elevation_deg, 7.7);
  EXPECT_EQ(back.camera.stand->eye_height_m, 1.7);
  ASSERT_TRUE(back.planet && back.planet->air);
  EXPECT_EQ(back.planet->body.equatorial_m, 3396190.1);
  EXPECT_EQ(back.planet->body.polar_m, 3376200.3);
  EXPECT_EQ(back.planet->air->rayleigh_per_m, glm::dvec3(1.1e-7, 2.2e-7, 3.3e-7));
  EXPECT_EQ(back.planet->air->aerosol_scale_m, 1234.5);
  EXPECT_EQ(back.planet->air->top_m, 88888.8);
  EXPECT_EQ(back.planet->ground.land_albedo, glm::dvec3(0.3, 0.2, 0.1));
  EXPECT_EQ(back.planet->ground.wind_m_per_s, 3.3);

  scene.planet->air.reset();
  EXPECT_FALSE(parse(write_scene(scene, "/data")).planet->air);
  scene.planet.reset();
  EXPECT_FALSE(parse(write_scene(scene, "/data")).planet);
  EXPECT_FALSE(parse(write_scene(scene, "/data")).no_planet);
  scene.no_planet = true;
  EXPECT_TRUE(parse(write_scene(scene, "/data")).no_planet);
  scene.camera = {};
  for (const View view : {View::kAuto, View::kOblique, View::kGlobe, View::kGround}) {
    scene.camera.view = view;
    EXPECT_EQ(parse(write_scene(scene, "/data")).camera.view, view);
  }
}

TEST(SceneFile, a_planet_has_a_size_and_the_earths_air_by_default) {
  const auto planet = [&](const std::string& members) {
    return *parse("{\"volumes\": [" + kVolume + "], \"planet\": {" + members + "}}").planet;
  };
  EXPECT_EQ(planet("").body.polar_m, Ellipsoid::wgs84().polar_m);
  EXPECT_EQ(planet("\"radius_m\": 1e9").body.polar_m, 1e9);
  EXPECT_EQ(planet("\"radius_m\": 1e9").air->top_m, Air{}.top_m);
  EXPECT_EQ(planet("\"air\": {\"top_m\": 5e4}").air->top_m, 5e4);
  EXPECT_EQ(planet("\"air\": {\"top_m\": 5e4}").air->rayleigh_scale_m, Air{}.rayleigh_scale_m);
  EXPECT_FALSE(planet("\"air\": \"none\"").air);
}

TEST(SceneFile, planets_suns_and_stands_that_cannot_be_are_named) {
  const std::string head = "{\n \"volumes\": [" + kVolume + "],\n ";
  const auto with = [&](const std::string& rest) { return message_of(head + rest + "}"); };
  expect_in(
      "s.json:3:12 (planet): wrong type: found the text 'mars', expected an object, or \"none\"",
      with("\"planet\": \"mars\""));
  expect_in("s.json:3:20 (planet.air): wrong type", with("\"planet\": {\"air\": \"thin\"}"));
  expect_in("did you mean 'radius_m'", with("\"planet\": {\"radius\": 1e6}"));
  expect_in("exclude each other",
            with("\"planet\": {\"radius_m\": 1e6, \"equatorial_m\": 1e6, \"polar_m\": 1e6}"));
  expect_in("expected 'polar_m'", with("\"planet\": {\"equatorial_m\": 1e6}"));
  expect_in("not a planet's shape", with("\"planet\": {\"equatorial_m\": 1e6, \"polar_m\": 5e5}"));
  expect_in("planet.air.rayleigh_per_m[2]): out of range",
            with("\"planet\": {\"air\": {\"rayleigh_per_m\": [0, 0, -1]}}"));
  expect_in("not a tent", with("\"planet\": {\"air\": {\"ozone_low_m\": 3e4}}"));
  const std::string sky = R"("sky": {"zenith_W_per_m2_sr_nm": [0, 0, 0],
      "horizon_W_per_m2_sr_nm": [0, 0, 0], "below_W_per_m2_sr_nm": [0, 0, 0]})";
  expect_in("exclude each other", with(sky + ", \"planet\": {}"));
  EXPECT_EQ(with(sky + ", \"planet\": \"none\""), "no error");
  expect_in("s.json:3:17 (sun.utc): not a date: found '2005-02-30'",
            with("\"sun\": {\"utc\": \"2005-02-30\"}"));
  expect_in("exclude each other", with("\"sun\": {\"utc\": \"2005-02-03\", \"azimuth_deg\": 1, "
                                       "\"elevation_deg\": 2}"));
  expect_in("expected 'lon_deg'", with("\"camera\": {\"stand\": {\"lat_deg\": 1}}"));
  expect_in("exclude each other", with("\"camera\": {\"stand\": {\"lat_deg\": 1, \"lon_deg\": 2},"
                                       "\"look_from_m\": [1, 2, 3]}"));
  expect_in("exclude each other",
            with("\"camera\": {\"view\": \"globe\", \"look_at_m\": [1, 2, 3]}"));
  expect_in("one of auto, oblique", with("\"camera\": {\"view\": \"side\"}"));
  expect_in("exclude each other",
            message_of(R"({"volumes": [{"source": "a", "time_s": 1, "utc": "2005-01-01"}]})"));
}

// Angles of the sun belong to the scene's place; a scene that is nowhere keeps them for later.
TEST(SceneFile, a_suns_angles_wait_for_a_place) {
  const std::string sun = R"("sun": {"azimuth_deg": 90, "elevation_deg": 0})";
  const Scene nowhere = parse("{\"volumes\": [" + kVolume + "], " + sun + "}");
  EXPECT_FALSE(nowhere.sun.to_sun);
  EXPECT_EQ(nowhere.sun.azimuth_elevation_deg, glm::dvec2(90, 0));
  EXPECT_EQ(parse(write_scene(nowhere, "/data")).sun.azimuth_elevation_deg, glm::dvec2(90, 0));
  const Scene stands =
      parse("{\"volumes\": [" + kVolume +
            "], \"camera\": {\"stand\": {\"lat_deg\": 0, \"lon_deg\": 90}}, " + sun + "}");
  ASSERT_TRUE(stands.sun.to_sun);
  EXPECT_NEAR(glm::length(*stands.sun.to_sun - glm::dvec3(-1, 0, 0)), 0, 1e-15);
}

TEST(SceneFile, names_below_the_folder_become_relative_and_far_ones_absolute) {
  Scene scene = parse("{\"volumes\": [" + kVolume + "]}");
  scene.volumes[0].files = {"/a/b/c/x.vdb", "/a/y.vdb", "/far/away/z.vdb"};
  const auto written = nlohmann::json::parse(write_scene(scene, "/a/b/c"));
  EXPECT_EQ(written["volumes"][0]["files"],
            (std::vector<std::string>{"x.vdb", "../../y.vdb", "/far/away/z.vdb"}));
}

// Walks grammar and schema together: the same fields, types, limits and words.
void compare_with_schema(const ObjectGrammar& grammar, const nlohmann::json& schema,
                         const nlohmann::json& all, std::set<std::string>& seen) {
  if (!seen.insert(std::string(grammar.name)).second) return;
  EXPECT_EQ(schema["additionalProperties"], false) << grammar.name;
  std::set<std::string> known, published;
  for (const auto& [name, _] : schema["properties"].items()) published.insert(name);
  for (const FieldGrammar& field : grammar.fields) known.emplace(field.name);
  EXPECT_EQ(known, published) << grammar.name;
  for (const FieldGrammar& field : grammar.fields) {
    const std::string path = std::string(grammar.name) + "." + std::string(field.name);
    const nlohmann::json property =
        schema["properties"].value(std::string(field.name), nlohmann::json::object());
    EXPECT_FALSE(property.value("description", "").empty()) << path;
    const auto limits = [&](const nlohmann::json& number) {
      const double huge = 1e300;
      EXPECT_EQ(number.value("minimum", -huge), std::max(field.low, -huge)) << path;
      EXPECT_EQ(number.value("maximum", huge), std::min(field.high, huge)) << path;
    };
    switch (field.kind) {
      case FieldKind::kText:
        EXPECT_EQ(property["type"], "string") << path;
        break;
      case FieldKind::kChoice: {
        std::string words;
        for (const auto& word : property["enum"])
          words += (words.empty() ? "" : "|") + word.get<std::string>();
        EXPECT_EQ(words, field.choices) << path;
        break;
      }
      case FieldKind::kNumber:
        EXPECT_EQ(property["type"], "number") << path;
        limits(property);
        break;
      case FieldKind::kInteger:
        EXPECT_EQ(property["type"], "integer") << path;
        limits(property);
        break;
      case FieldKind::kVector:
        EXPECT_EQ(property["minItems"], 3) << path;
        EXPECT_EQ(property["maxItems"], 3) << path;
        limits(property["items"]);
        break;
      case FieldKind::kTextList:
        EXPECT_EQ(property["items"]["type"], "string") << path;
        break;
      case FieldKind::kParameters:
        EXPECT_EQ(property["type"], "object") << path;
        break;
      case FieldKind::kObjectOrNone:
        EXPECT_EQ(property["oneOf"][1]["const"], "none") << path;
        [[fallthrough]];
      case FieldKind::kObject:
      case FieldKind::kObjectList: {
        const std::string name(field.object->name);
        const auto& ref = field.kind == FieldKind::kObject         ? property
                          : field.kind == FieldKind::kObjectOrNone ? property["oneOf"][0]
                                                                   : property["items"];
        EXPECT_EQ(ref["$ref"], "#/$defs/" + name) << path;
        compare_with_schema(*field.object, all["$defs"][name], all, seen);
      }
    }
  }
}

TEST(SceneSchema, says_what_the_reader_obeys) {
  std::ifstream in(NEPHO_PROJECT_DIR "/docs/scene.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(in);
  std::set<std::string> seen;
  compare_with_schema(scene_grammar(), schema, schema, seen);
  seen.erase("scene");
  std::set<std::string> published;
  for (const auto& [name, _] : schema["$defs"].items()) published.insert(name);
  EXPECT_EQ(seen, published);
}

TEST(SceneSchema, sample_scenes_read) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(NEPHO_PROJECT_DIR "/data-samples/scenes")) {
    EXPECT_NO_THROW(read_scene_file(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST(NearestName, finds_slips_and_forgotten_units_and_leaves_strangers_alone) {
  const std::vector<std::string> known{"elevation_deg", "azimuth_deg", "fov_deg", "files"};
  EXPECT_EQ(nearest_name("elevation", known), "elevation_deg");
  EXPECT_EQ(nearest_name("azimut_deg", known), "azimuth_deg");
  EXPECT_EQ(nearest_name("file", known), "files");
  EXPECT_EQ(nearest_name("quite_another", known), "");
}

}  // namespace
}  // namespace nepho
