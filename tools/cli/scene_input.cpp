#include "cli/scene_input.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <initializer_list>

#include "cli/values.h"
#include "core/error.h"
#include "geo/place.h"
#include "scene/parameter.h"
#include "scene/scene_file.h"
#include "scene/utc.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

// "2005-..." is a date; no number has a minus there.
bool is_date(const std::string& text) {
  return text.size() > 4 && text[4] == '-' && std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::isdigit(static_cast<unsigned char>(text[3]));
}

std::string first_bytes(const std::string& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return "";  // a pattern, or a pipe
  std::ifstream in(file, std::ios::binary);
  std::string bytes(8, '\0');
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(std::size_t(in.gcount()));
  return bytes;
}

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

// "x,y,z" in the scene's local metres, or "geo:LAT,LON,HEIGHT" over its planet's ellipsoid.
glm::dvec3 point_value(const std::string& option, const std::string& text, const Scene& scene) {
  constexpr const char* shape = "x,y,z in metres, or geo:LAT,LON,HEIGHT";
  const bool geodetic = text.starts_with("geo:");
  const std::vector<double> v = list_value(option, geodetic ? text.substr(4) : text, 3, shape);
  if (!geodetic) return to_ecef(scene_frame(scene), {v[0], v[1], v[2]});
  return ecef_m(scene.planet ? scene.planet->body : Ellipsoid::wgs84(), {v[0], v[1], v[2]});
}

// "LAT,LON" or "LAT,LON,HEIGHT".
Stand stand_value(const std::string& text) {
  constexpr const char* shape = "LAT,LON or LAT,LON,HEIGHT in degrees and metres above the ground";
  const bool has_height = std::count(text.begin(), text.end(), ',') == 2;
  const std::vector<double> v = list_value("--at", text, has_height ? 3 : 2, shape);
  if (std::abs(v[0]) > 90 || std::abs(v[1]) > 360)
    throw Error({"bad value", "--at", "latitude to 90 and longitude to 360 degrees",
                 "'" + text + "'", "latitude comes first"});
  Stand stand;
  stand.latitude_deg = v[0];
  stand.longitude_deg = v[1];
  if (!has_height) return stand;
  if (!(v[2] >= 0.01 && v[2] <= 1e5))
    throw Error({"bad value", "--at", "a height from 0.01 to 100000 m above the ground",
                 "'" + text + "'", ""});
  stand.eye_height_m = v[2];
  return stand;
}

View view_value(const std::string& text) {
  const std::string word = choice_value("--view", text, "camera", "view");
  return word == "oblique"  ? View::kOblique
         : word == "globe"  ? View::kGlobe
         : word == "ground" ? View::kGround
                            : View::kAuto;
}

// What the scene says of eye, target and stand gives way to the option that says something else.
void apply_stand(Scene& scene, const RenderOptions& o) {
  CameraSpec& camera = scene.camera;
  const auto clear = [&] {
    const auto fov_rad = camera.vertical_fov_rad;
    camera = {};
    camera.vertical_fov_rad = fov_rad;
  };
  if (o.at) {
    clear();
    camera.stand = stand_value(*o.at);
  }
  if (o.view) {
    clear();
    camera.view = view_value(*o.view);
  }
  for (const auto& [option, value] :
       {std::pair{"--heading", &o.heading_deg}, std::pair{"--pitch", &o.pitch_deg}})
    if (*value && !camera.stand)
      throw Error({"nothing to apply it to", option, "--at, or a scene with a stand", "none", ""});
  const auto angle = [](const char* option, const std::string& text, double most) {
    const double value = number_value(option, text);
    if (std::abs(value) > most)
      throw Error({"bad value", option, "to " + std::to_string(int(most)) + " degrees",
                   "'" + text + "'", ""});
    return value;
  };
  if (o.heading_deg) camera.stand->azimuth_deg = angle("--heading", *o.heading_deg, 360);
  if (o.pitch_deg) camera.stand->elevation_deg = angle("--pitch", *o.pitch_deg, 90);
}

void apply_camera(Scene& scene, const RenderOptions& o) {
  if (o.look_from || o.look_at) {  // worked out for another view
    scene.camera.up.reset();
    scene.camera.stand.reset();
    scene.camera.view = View::kAuto;
  }
  apply_stand(scene, o);
  if (o.look_from) scene.camera.eye_m = point_value("--look-from", *o.look_from, scene);
  if (o.look_at) scene.camera.target_m = point_value("--look-at", *o.look_at, scene);
  if (o.fov_deg)
    scene.camera.vertical_fov_rad =
        glm::radians(number_value("--fov", *o.fov_deg, "camera", "fov_deg"));
  if (scene.camera.eye_m && scene.camera.eye_m == scene.camera.target_m)
    throw Error({"camera looks nowhere", "--look-from", "a point apart from --look-at", "", ""});
}

// "AZIMUTH,ELEVATION", or a date.
void apply_sun(Scene& scene, const std::string& text) {
  SunSpec& sun = scene.sun;
  sun.to_sun.reset();
  sun.azimuth_elevation_deg.reset();
  sun.utc_ns.reset();
  if (is_date(text)) {
    sun.utc_ns = utc_ns_value(text, "--sun");
    return;
  }
  const std::vector<double> v = list_value(
      "--sun", text, 2, "AZIMUTH,ELEVATION in degrees, or a date such as 2005-08-28T15:00Z");
  if (std::abs(v[0]) > 360 || std::abs(v[1]) > 90)
    throw Error(
        {"bad value", "--sun", "azimuth to 360 and elevation to 90 degrees", "'" + text + "'", ""});
  // Without a place the angles wait for the one that the camera looks at.
  if (has_frame(scene))
    sun.to_sun = sun_direction(scene_frame(scene), glm::radians(v[0]), glm::radians(v[1]));
  else
    sun.azimuth_elevation_deg = {v[0], v[1]};
}

void apply_planet(Scene& scene, const RenderOptions& o) {
  if (!o.no_planet) return;
  scene.planet.reset();
  scene.no_planet = true;
}

void apply_light(Scene& scene, const RenderOptions& o) {
  if (o.sun) apply_sun(scene, *o.sun);
  if (o.exposure_ev)
    scene.exposure_ev = number_value("--exposure", *o.exposure_ev, "scene", "exposure_ev");
  if (o.tone_map) scene.tone_map = tone_map_value(*o.tone_map);
  if (o.dither) scene.dither = true;
}

// Files of forecasts are times and domains of one: `grib` and `netcdf` together are a `forecast`.
std::vector<VolumeSpec> one_forecast(std::vector<VolumeSpec> data) {
  const auto is_forecast = [](const VolumeSpec& volume) {
    return volume.source == "netcdf" || volume.source == "grib";
  };
  const auto first = std::ranges::find_if(data, is_forecast);  // `data` does not grow: it stays
  if (first == data.end()) return data;
  for (auto other = first + 1; other != data.end();) {
    if (!is_forecast(*other)) {
      ++other;
      continue;
    }
    if (other->source != first->source) first->source = "forecast";
    first->files.insert(first->files.end(), other->files.begin(), other->files.end());
    other = data.erase(other);
  }
  return data;
}

// A grid file of another format than the data's needs the module that reads both.
void read_grid_with_data(Scene& scene, const std::string& grid) {
  const bool is_grib = first_bytes(grid).starts_with("GRIB");
  for (VolumeSpec& volume : scene.volumes)
    if (volume.source == (is_grib ? "netcdf" : "grib")) volume.source = "forecast";
}

// For every volume with files, in place of what it has of this name.
void lay_over(Scene& scene, const SourceParameter& parameter) {
  bool used = false;
  for (VolumeSpec& volume : scene.volumes) {
    if (volume.files.empty()) continue;
    used = true;
    auto& all = volume.parameters;
    std::erase_if(all, [&](const SourceParameter& p) { return p.name == parameter.name; });
    all.push_back(parameter);
  }
  if (!used)
    throw Error({"nothing to apply it to", parameter.where, "a volume with files", "none", ""});
}

void apply_quality(Scene& scene, const RenderOptions& o) {
  RenderSettings& settings = scene.render;
  if (o.size) {
    const glm::ivec2 size = size_value("--size", *o.size);
    settings.width = size.x;
    settings.height = size.y;
  }
  if (o.budget_mib)
    settings.budget_mib = number_value("--budget-mib", *o.budget_mib, "render", "budget_mib");
  // What is given outranks a scene's target, and the other way round.
  if (o.budget_mib || o.step_voxels || o.tolerance || o.target_error || o.target_ms)
    scene.target = {};
  if (o.target_error)
    scene.target.error = share_value("--target-error", *o.target_error, "render", "target_error");
  if (o.target_ms)
    scene.target.frame_ms = number_value("--target-ms", *o.target_ms, "render", "target_ms");
  if (scene.target) settings.step_voxels.reset();
  if (o.step_voxels)
    settings.step_voxels = number_value("--step", *o.step_voxels, "render", "step_voxels");
  if (o.tolerance) {
    settings.step_voxels.reset();
    settings.tolerance = number_value("--tolerance", *o.tolerance, "render", "tolerance");
  }
  if (o.fetch)
    settings.fetch = choice_value("--fetch", *o.fetch, "render", "fetch") == "filter"
                         ? Fetch::kFilter
                         : Fetch::kTexels8;
  if (o.light)
    settings.light = choice_value("--light", *o.light, "render", "light") == "single"
                         ? Light::kSingle
                         : Light::kOctaves;
  if (o.pixels)
    settings.pixels = choice_value("--pixels", *o.pixels, "render", "pixels") == "all"
                          ? WhichPixels::kAll
                          : WhichPixels::kAdaptive;
  if (o.max_level)
    settings.max_level = integer_value("--max-level", *o.max_level, "render", "max_level");
  if (o.seed) settings.seed = std::uint64_t(number_value("--seed", *o.seed, "render", "seed"));
  if (o.probe_pixels)
    settings.probe_pixels =
        integer_value("--probe-pixels", *o.probe_pixels, "render", "probe_pixels");
}

using GivenOption = std::pair<const char*, const std::optional<std::string>*>;

// What would have no effect is no option of this picture.
void refuse_given(std::initializer_list<GivenOption> options, const char* expected,
                  const char* found) {
  for (const auto& [option, value] : options)
    if (*value) throw Error({"nothing to apply it to", option, expected, found, ""});
}

void apply_paths(Scene& scene, const RenderOptions& o) {
  PathGoals& paths = scene.render.paths;
  if (o.engine)
    scene.render.engine = choice_value("--engine", *o.engine, "render", "engine") == "march"
                              ? Engine::kMarch
                              : Engine::kReference;
  if (scene.render.engine == Engine::kMarch)
    return refuse_given({{"--spp", &o.spp},
                         {"--noise", &o.noise},
                         {"--levels", &o.levels},
                         {"--host-mib", &o.host_mib},
                         {"--exact-orders", &o.exact_orders}},
                        "--engine reference", "the march");
  refuse_given({{"--step", &o.step_voxels},
                {"--fetch", &o.fetch},
                {"--light", &o.light},
                {"--pixels", &o.pixels},
                {"--target-error", &o.target_error},
                {"--target-ms", &o.target_ms},
                {"--probe-pixels", &o.probe_pixels}},
               "--engine march", "the reference");
  scene.target = {};
  // One goal on the command line replaces both of a scene.
  if (o.spp || o.noise) paths.samples = 0, paths.noise = 0;
  if (o.spp) paths.samples = integer_value("--spp", *o.spp, "paths", "spp");
  if (o.noise) paths.noise = share_value("--noise", *o.noise, "paths", "noise");
  if (o.levels)
    paths.levels = choice_value("--levels", *o.levels, "paths", "levels") == "finest"
                       ? PathLevels::kFinest
                       : PathLevels::kResident;
  if (o.exact_orders)
    paths.exact_orders = integer_value("--exact-orders", *o.exact_orders, "paths", "exact_orders");
  if (paths.levels == PathLevels::kFinest)
    refuse_given({{"--budget-mib", &o.budget_mib}, {"--tolerance", &o.tolerance}},
                 "--levels resident", "the finest bricks");
  else
    refuse_given({{"--host-mib", &o.host_mib}}, "--levels finest", "resident bricks");
  if (o.host_mib) paths.host_mib = number_value("--host-mib", *o.host_mib, "paths", "host_mib");
}

}  // namespace

InputKind input_kind(const std::string& input) {
  if (input.find('#') == std::string::npos) {
    std::error_code failure;
    const fs::file_status status = fs::status(input, failure);
    if (!fs::exists(status)) throw Error({"no such file", input, "", "", ""});
    if (fs::is_directory(status)) throw Error({"cannot read", input, "a file", "a directory", ""});
  }
  if (ending_of(input) == ".json") return InputKind::kScene;
  return is_picture_name(input) ? InputKind::kPicture : InputKind::kData;
}

Scene scene_in_picture(const fs::path& path, const PictureFiles& pictures) {
  const Metadata metadata = pictures.read_metadata(path);
  const auto found = metadata.find("nephoscope:scene");
  if (found == metadata.end())
    throw Error({"no scene in this picture", path.string(), "metadata nephoscope:scene", "none",
                 "only pictures that nephoscope wrote can be drawn again"});
  return parse_scene(found->second, path.string() + " (nephoscope:scene)",
                     fs::absolute(path).parent_path());
}

VolumeSpec data_volume(const std::string& file) {
  VolumeSpec volume;
  volume.files = {fs::absolute(file).lexically_normal().string()};
  volume.name = fs::path(file).stem().string();
  const std::string bytes = first_bytes(file);
  // Models name their files as they like: wrfout_d01_2005-08-28_00:00:00.
  const bool classic = bytes.starts_with("CDF") && bytes.size() > 3 &&
                       (bytes[3] == 1 || bytes[3] == 2 || bytes[3] == 5);
  if (classic || bytes.starts_with("\x89HDF")) {
    volume.source = "netcdf";
    return volume;
  }
  if (bytes.starts_with("GRIB")) {
    volume.source = "grib";
    return volume;
  }
  if (bytes.starts_with(std::string("II*\0", 4)) || bytes.starts_with(std::string("MM\0*", 4)))
    throw Error({"a raster is no cloud field", file, "NetCDF, GRIB or VDB", "TIFF", ""});
  const std::string ending = ending_of(file);
  if (ending.empty())
    throw Error({"unknown kind of file", file,
                 "NetCDF or GRIB, or a name with an ending, such as .vdb", "none", ""});
  volume.source = ending.substr(1);
  return volume;
}

void set_time(Scene& scene, const std::optional<std::string>& value) {
  if (!value) return;
  const bool any =
      std::ranges::any_of(scene.volumes, [](const auto& v) { return !v.files.empty(); });
  for (VolumeSpec& volume : scene.volumes) {
    if (any && volume.files.empty()) continue;
    volume.time_s.reset();
    volume.utc_ns.reset();
    if (is_date(*value))
      volume.utc_ns = utc_ns_value(*value, "--time");
    else
      volume.time_s = number_value("--time", *value);
    volume.where = "--time";
  }
}

void set_force(Scene& scene, bool force) {
  if (force) lay_over(scene, {"force", "", 1, "", false, "--force"});
}

void set_region(Scene& scene, const std::optional<std::string>& value) {
  if (!value) return;
  list_value("--region", *value, 4, "SOUTH,WEST,NORTH,EAST in degrees");
  lay_over(scene, {"region", "", 0, *value, true, "--region"});
}

void set_parameter(Scene& scene, const char* parameter, const std::string& option,
                   const std::optional<std::string>& value) {
  if (value) lay_over(scene, make_parameter(parameter, *value, option));
  if (value && option == "--grid") read_grid_with_data(scene, *value);
}

Scene scene_from(const RenderOptions& o, const PictureFiles& pictures) {
  Scene scene;
  std::vector<VolumeSpec> data;
  bool scene_read = false;
  for (const std::string& input : o.inputs) {
    const InputKind kind = input_kind(input);
    if (kind == InputKind::kData) {
      data.push_back(data_volume(input));
      continue;
    }
    if (scene_read) throw Error({"more than one scene", input, "one scene or picture", "", ""});
    scene_read = true;
    scene = kind == InputKind::kScene ? read_scene_file(input) : scene_in_picture(input, pictures);
  }
  data = one_forecast(std::move(data));
  scene.volumes.insert(scene.volumes.end(), data.begin(), data.end());
  set_parameter(scene, "grid", "--grid", o.grid);
  set_parameter(scene, "names", "--names", o.names);
  set_parameter(scene, "up", "--up", o.up);
  set_parameter(scene, "metres_per_unit", "--metres-per-unit", o.metres_per_unit);
  set_parameter(scene, "density_scale", "--density-scale", o.density_scale);
  set_parameter(scene, "frame", "--frame", o.frame);
  set_parameter(scene, "fps", "--fps", o.fps);
  set_time(scene, o.time);
  set_force(scene, o.force);
  set_region(scene, o.region);
  apply_quality(scene, o);
  apply_paths(scene, o);
  apply_planet(scene, o);
  apply_camera(scene, o);
  apply_light(scene, o);
  return scene;
}

}  // namespace nepho
