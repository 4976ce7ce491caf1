#include "scene/scene_file.h"

#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <sstream>

#include "core/error.h"
#include "geo/place.h"
#include "scene/object_reader.h"
#include "scene/parameter.h"
#include "scene/utc.h"

namespace nepho {
namespace {

constexpr std::uintmax_t kLargestSceneFile = 16u << 20;

GeodeticPlace read_place(const ObjectReader& in) {
  in.require("lat_deg");
  in.require("lon_deg");
  return {*in.number("lat_deg"), *in.number("lon_deg"), in.number("height_m").value_or(0),
          in.number("heading_deg").value_or(0)};
}

GeodeticPlace read_point(const ObjectReader& in) {
  in.require("lat_deg");
  in.require("lon_deg");
  in.require("height_m");
  return {*in.number("lat_deg"), *in.number("lon_deg"), *in.number("height_m"), 0};
}

glm::dvec3 origin(const Placement& frame) {
  return {frame.origin_ecef_m[0], frame.origin_ecef_m[1], frame.origin_ecef_m[2]};
}

glm::dvec3 read_direction(const ObjectReader& in, std::string_view field) {
  const glm::dvec3 v = *in.vector(field);
  const double length = glm::length(v);
  if (!(length > 0) || !std::isfinite(length))
    throw Error({"not a direction", in.where(field), "a vector of some length", "", ""});
  // Written ones have length 1 already: dividing again would change their last bit.
  return std::abs(length - 1) < 1e-12 ? v : v / length;
}

Phase read_phase(const ObjectReader& in) {
  in.require("kind");
  Phase phase;
  const std::string kind = *in.text("kind");
  phase.kind = kind == "mie"         ? PhaseKind::kMie
               : kind == "hg_draine" ? PhaseKind::kHgDraine
                                     : PhaseKind::kHenyeyGreenstein;
  const bool droplets = phase.kind != PhaseKind::kHenyeyGreenstein;
  const std::string_view foreign = droplets ? "asymmetry" : "effective_radius_m";
  if (in.has(foreign))
    throw Error({"does not belong to this phase function", in.where(foreign), "", "", ""});
  phase.effective_radius_m = in.number("effective_radius_m").value_or(phase.effective_radius_m);
  phase.asymmetry = in.number("asymmetry").value_or(phase.asymmetry);
  return phase;
}

VolumeSpec read_volume(const ObjectReader& in, const std::filesystem::path& folder,
                       const std::string& source_name) {
  VolumeSpec volume;
  in.require("source");
  volume.where = in.where();
  volume.source = *in.text("source");
  for (const std::string& file : in.texts("files"))
    volume.files.push_back((folder / file).lexically_normal().string());
  if (const JsonValue* parameters = in.raw("parameters"))
    for (const JsonValue::Member& member : parameters->members)
      volume.parameters.push_back(make_parameter(
          member.key, member.value,
          at_position(source_name, member.value.at) + " (parameters." + member.key + ")"));
  if (const auto place = in.object("place")) volume.place = read_place(*place);
  if (const auto phase = in.object("phase")) volume.phase = read_phase(*phase);
  volume.co_albedo = in.vector("co_albedo");
  in.at_most_one({"time_s", "utc", "time"});
  volume.time_choice = in.text("time").value_or("");
  volume.time_s = in.number("time_s");
  if (const auto utc = in.text("utc")) volume.utc_ns = utc_ns_value(*utc, in.where("utc"));
  volume.name = in.text("name").value_or(
      volume.files.empty() ? volume.source
                           : std::filesystem::path(volume.files.front()).stem().string());
  return volume;
}

// Eye or target, in whichever of the three ways it is given.
std::optional<glm::dvec3> read_spot(const ObjectReader& in, const std::string& name,
                                    const Placement& frame, const Ellipsoid& body) {
  in.at_most_one({name + "_m", name, name + "_ecef_m"});
  if (const auto local_m = in.vector(name + "_m")) return to_ecef(frame, *local_m);
  if (const auto point = in.object(name)) {
    const GeodeticPlace place = read_point(*point);
    return ecef_m(body, {place.latitude_deg, place.longitude_deg, place.height_m});
  }
  return in.vector(name + "_ecef_m");
}

Stand read_stand(const ObjectReader& in) {
  in.require("lat_deg");
  in.require("lon_deg");
  Stand stand;
  stand.latitude_deg = *in.number("lat_deg");
  stand.longitude_deg = *in.number("lon_deg");
  stand.eye_height_m = in.number("eye_height_m").value_or(stand.eye_height_m);
  stand.azimuth_deg = in.number("azimuth_deg");
  stand.elevation_deg = in.number("elevation_deg");
  return stand;
}

View read_view(const ObjectReader& in) {
  const std::string word = in.text("view").value_or("auto");
  return word == "oblique"  ? View::kOblique
         : word == "globe"  ? View::kGlobe
         : word == "ground" ? View::kGround
                            : View::kAuto;
}

CameraSpec read_camera(const ObjectReader& in, const Placement& frame, const Ellipsoid& body) {
  CameraSpec camera;
  camera.eye_m = read_spot(in, "look_from", frame, body);
  camera.target_m = read_spot(in, "look_at", frame, body);
  if (camera.eye_m && camera.target_m && *camera.eye_m == *camera.target_m)
    throw Error(
        {"camera looks nowhere", in.where(), "look_from apart from look_at", "the same point", ""});
  for (const char* point :
       {"look_from_m", "look_from", "look_from_ecef_m", "look_at_m", "look_at", "look_at_ecef_m"})
    in.at_most_one({point, "stand", "view"});
  if (const auto stand = in.object("stand")) camera.stand = read_stand(*stand);
  camera.view = read_view(in);
  if (in.has("up_ecef")) camera.up = read_direction(in, "up_ecef");
  in.at_most_one({"fov_deg", "fov_rad"});
  camera.vertical_fov_rad = in.number("fov_rad");
  if (const auto fov_deg = in.number("fov_deg")) camera.vertical_fov_rad = glm::radians(*fov_deg);
  return camera;
}

SunSpec read_sun(const ObjectReader& in, const Placement* frame) {
  SunSpec sun;
  in.at_most_one({"azimuth_deg", "to_sun_ecef", "utc"});
  in.at_most_one({"elevation_deg", "to_sun_ecef", "utc"});
  in.all_or_none({"azimuth_deg", "elevation_deg"});
  if (in.has("to_sun_ecef")) sun.to_sun = read_direction(in, "to_sun_ecef");
  if (const auto utc = in.text("utc")) sun.utc_ns = utc_ns_value(*utc, in.where("utc"));
  if (in.has("azimuth_deg"))
    sun.azimuth_elevation_deg = {*in.number("azimuth_deg"), *in.number("elevation_deg")};
  // A scene that is nowhere yet: where the camera will look, its angles are laid out.
  if (frame && sun.azimuth_elevation_deg) {
    const glm::dvec2 angles_rad = glm::radians(*sun.azimuth_elevation_deg);
    sun.to_sun = sun_direction(*frame, angles_rad.x, angles_rad.y);
    sun.azimuth_elevation_deg.reset();
  }
  sun.irradiance_W_per_m2_nm = in.vector("irradiance_W_per_m2_nm");
  return sun;
}

Sky read_sky(const ObjectReader& in, const Placement& frame) {
  Sky sky;
  sky.up = in.has("up_ecef") ? read_direction(in, "up_ecef") : axis(frame, 2);
  for (const std::string_view field :
       {"zenith_W_per_m2_sr_nm", "horizon_W_per_m2_sr_nm", "below_W_per_m2_sr_nm"})
    in.require(field);
  sky.zenith_W_per_m2_sr_nm = *in.vector("zenith_W_per_m2_sr_nm");
  sky.horizon_W_per_m2_sr_nm = *in.vector("horizon_W_per_m2_sr_nm");
  sky.below_W_per_m2_sr_nm = *in.vector("below_W_per_m2_sr_nm");
  return sky;
}

Air read_air(const ObjectReader& in) {
  Air air;
  const auto take = [&](const char* field, double& value) {
    value = in.number(field).value_or(value);
  };
  air.rayleigh_per_m = in.vector("rayleigh_per_m").value_or(air.rayleigh_per_m);
  take("rayleigh_scale_m", air.rayleigh_scale_m);
  air.aerosol_extinction_per_m =
      in.vector("aerosol_extinction_per_m").value_or(air.aerosol_extinction_per_m);
  take("aerosol_albedo", air.aerosol_albedo);
  take("aerosol_asymmetry", air.aerosol_asymmetry);
  take("aerosol_scale_m", air.aerosol_scale_m);
  air.ozone_per_m = in.vector("ozone_per_m").value_or(air.ozone_per_m);
  take("ozone_low_m", air.ozone_low_m);
  take("ozone_peak_m", air.ozone_peak_m);
  take("ozone_high_m", air.ozone_high_m);
  take("top_m", air.top_m);
  if (!(air.ozone_low_m < air.ozone_peak_m && air.ozone_peak_m < air.ozone_high_m))
    throw Error({"not a tent", in.where(), "ozone_low_m < ozone_peak_m < ozone_high_m",
                 std::to_string(air.ozone_low_m) + ", " + std::to_string(air.ozone_peak_m) + ", " +
                     std::to_string(air.ozone_high_m),
                 ""});
  return air;
}

Planet read_planet(const ObjectReader& in) {
  Planet planet;
  in.at_most_one({"radius_m", "equatorial_m"});
  in.at_most_one({"radius_m", "polar_m"});
  in.all_or_none({"equatorial_m", "polar_m"});
  if (const auto radius_m = in.number("radius_m")) planet.body = Ellipsoid::sphere(*radius_m);
  if (in.has("polar_m")) planet.body = {*in.number("equatorial_m"), *in.number("polar_m")};
  if (std::abs(planet.body.polar_m / planet.body.equatorial_m - 1) > 0.1)
    throw Error({"not a planet's shape", in.where("polar_m"), "within 10 % of equatorial_m",
                 std::to_string(planet.body.polar_m), ""});
  if (in.is_none("air")) planet.air.reset();
  if (const auto air = in.object("air")) planet.air = read_air(*air);
  if (const auto ground = in.object("ground")) {
    GroundLook& look = planet.ground;
    look.land_albedo = ground->vector("land_albedo").value_or(look.land_albedo);
    look.water_albedo = ground->vector("water_albedo").value_or(look.water_albedo);
    look.wind_m_per_s = ground->number("wind_m_per_s").value_or(look.wind_m_per_s);
  }
  return planet;
}

void read_render(const ObjectReader& in, RenderSettings& settings) {
  in.at_most_one({"step_voxels", "tolerance"});
  settings.budget_mib = in.number("budget_mib").value_or(settings.budget_mib);
  settings.step_voxels = in.number("step_voxels");
  settings.tolerance = in.number("tolerance").value_or(settings.tolerance);
  if (const auto fetch = in.text("fetch"))
    settings.fetch = *fetch == "filter" ? Fetch::kFilter : Fetch::kTexels8;
  if (const auto light = in.text("light"))
    settings.light = *light == "single" ? Light::kSingle : Light::kOctaves;
  if (const auto pixels = in.text("pixels"))
    settings.pixels = *pixels == "all" ? WhichPixels::kAll : WhichPixels::kAdaptive;
  settings.octaves = in.integer("octaves").value_or(settings.octaves);
  settings.pixels_per_voxel = in.number("pixels_per_voxel").value_or(settings.pixels_per_voxel);
  settings.max_level = in.integer("max_level").value_or(settings.max_level);
  settings.seed = std::uint64_t(in.number("seed").value_or(double(settings.seed)));
  settings.probe_pixels = in.integer("probe_pixels").value_or(settings.probe_pixels);
  settings.probe_paths = in.integer("probe_paths").value_or(settings.probe_paths);
  if (const auto engine = in.text("engine"))
    settings.engine = *engine == "march" ? Engine::kMarch : Engine::kReference;
  if (const auto paths = in.object("paths")) {
    settings.paths.samples = paths->integer("spp").value_or(0);
    settings.paths.noise = paths->number("noise").value_or(0);
    if (const auto levels = paths->text("levels"))
      settings.paths.levels = *levels == "finest" ? PathLevels::kFinest : PathLevels::kResident;
    settings.paths.host_mib = paths->number("host_mib").value_or(settings.paths.host_mib);
    settings.paths.exact_orders =
        paths->integer("exact_orders").value_or(settings.paths.exact_orders);
  }
}

PictureTarget read_target(const ObjectReader& in) {
  for (const std::string_view target : {"target_error", "target_ms"})
    for (const std::string_view chosen : {"tolerance", "step_voxels", "budget_mib"})
      in.at_most_one({target, chosen});
  in.at_most_one({"target_error", "target_ms"});
  PictureTarget target{in.number("target_error"), in.number("target_ms")};
  if (target && in.text("engine").value_or("march") == "reference")
    throw Error({"nothing to choose", in.where("engine"), "the march with a target",
                 "the reference", "the reference's goals are \"paths\": spp, noise"});
  return target;
}

// Where the camera looks, for scenes on a globe that give no place of their own.
std::optional<GeodeticPlace> camera_point(const ObjectReader& in) {
  if (const auto camera = in.object("camera"))
    for (const std::string_view field : {"look_at", "look_from", "stand"})
      if (const auto point = camera->object(field)) {
        point->require("lat_deg");
        point->require("lon_deg");
        return GeodeticPlace{*point->number("lat_deg"), *point->number("lon_deg"), 0, 0};
      }
  return std::nullopt;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& source_name,
                  const std::filesystem::path& folder) {
  const JsonValue tree = parse_json(text, source_name);
  const ObjectReader in(tree, scene_grammar(), source_name);
  Scene scene;
  scene.name = in.text("name").value_or("");
  in.require("volumes");
  for (const ObjectReader& volume : in.objects("volumes"))
    scene.volumes.push_back(read_volume(volume, folder, source_name));
  if (scene.volumes.empty())
    throw Error({"nothing to draw", in.where("volumes"), "at least one volume", "none", ""});
  if (const auto place = in.object("place")) scene.place = read_place(*place);
  if (!scene.place && !scene.volumes.front().place) scene.place = camera_point(in);

  const Placement frame = scene_frame(scene);
  scene.no_planet = in.is_none("planet");
  if (!scene.no_planet) in.at_most_one({"sky", "planet"});
  if (const auto file = in.text("terrain"))
    scene.terrain = {(folder / *file).lexically_normal().string(), in.where("terrain")};
  if (const auto planet = in.object("planet")) scene.planet = read_planet(*planet);
  const Ellipsoid body = scene.planet ? scene.planet->body : Ellipsoid::wgs84();
  if (const auto camera = in.object("camera")) scene.camera = read_camera(*camera, frame, body);
  if (const auto sun = in.object("sun"))
    scene.sun = read_sun(*sun, has_frame(scene) ? &frame : nullptr);
  if (const auto sky = in.object("sky")) scene.sky = read_sky(*sky, frame);
  if (const auto image = in.object("image")) {
    scene.render.width = image->integer("width").value_or(scene.render.width);
    scene.render.height = image->integer("height").value_or(scene.render.height);
  }
  if (const auto render = in.object("render")) {
    read_render(*render, scene.render);
    scene.target = read_target(*render);
  }
  scene.exposure_ev = in.number("exposure_ev");
  if (const auto tone_map = in.text("tone_map"))
    scene.tone_map = *tone_map == "none" ? ToneMap::kNone : ToneMap::kAces;
  if (const auto dither = in.text("dither")) scene.dither = *dither == "ordered";
  return scene;
}

Scene read_scene_file(const std::filesystem::path& path) {
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
  std::ifstream in(path, std::ios::binary);
  if (failure || !in) {
    const bool folder = std::filesystem::is_directory(path);
    throw Error({folder ? "not a file" : "cannot read", path.string(), "a scene file",
                 folder    ? "a directory"
                 : failure ? failure.message()
                           : "no permission",
                 ""});
  }
  if (bytes > kLargestSceneFile)
    throw Error(
        {"not a scene", path.string(), "at most 16 MiB", std::to_string(bytes) + " bytes", ""});
  std::ostringstream text;
  text << in.rdbuf();
  return parse_scene(text.str(), path.string(), std::filesystem::absolute(path).parent_path());
}

bool has_frame(const Scene& scene) {
  return scene.place || (!scene.volumes.empty() && scene.volumes.front().place);
}

Placement scene_frame(const Scene& scene) {
  if (scene.place) return placement_of(*scene.place);
  if (!scene.volumes.empty() && scene.volumes.front().place)
    return placement_of(*scene.volumes.front().place);
  return {};
}

glm::dvec3 axis(const Placement& frame, int index) {
  const double* a = frame.axes + 3 * index;
  return {a[0], a[1], a[2]};
}

glm::dvec3 to_ecef(const Placement& frame, const glm::dvec3& local_m) {
  return origin(frame) + local_m.x * axis(frame, 0) + local_m.y * axis(frame, 1) +
         local_m.z * axis(frame, 2);
}

glm::dvec3 to_local(const Placement& frame, const glm::dvec3& ecef_m) {
  const glm::dvec3 from = ecef_m - origin(frame);
  return {glm::dot(from, axis(frame, 0)), glm::dot(from, axis(frame, 1)),
          glm::dot(from, axis(frame, 2))};
}

glm::dvec3 sun_direction(const Placement& frame, double azimuth_rad, double elevation_rad) {
  return std::cos(elevation_rad) *
             (std::sin(azimuth_rad) * axis(frame, 0) + std::cos(azimuth_rad) * axis(frame, 1)) +
         std::sin(elevation_rad) * axis(frame, 2);
}

}  // namespace nepho
