#include <nlohmann/json.hpp>

#include "scene/scene_file.h"
#include "scene/utc.h"

namespace nepho {
namespace {

// Ordered, so that a person finds what matters first; its numbers read back to the same bits.
using Json = nlohmann::ordered_json;

Json vector(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json write_place(const GeodeticPlace& place) {
  return {{"lat_deg", place.latitude_deg},
          {"lon_deg", place.longitude_deg},
          {"height_m", place.height_m},
          {"heading_deg", place.heading_deg}};
}

std::string write_file_name(const std::string& file, const std::filesystem::path& folder) {
  const std::filesystem::path absolute = std::filesystem::absolute(file).lexically_normal();
  const std::filesystem::path relative =
      absolute.lexically_relative(std::filesystem::absolute(folder).lexically_normal());
  int ups = 0;
  for (const std::filesystem::path& part : relative) ups += part == "..";
  return relative.empty() || ups > 2 ? absolute.string() : relative.string();
}

// A name that ends in its SI unit, and a number in it (parameter.h).
Json write_parameter(const SourceParameter& parameter) {
  if (parameter.is_text) return parameter.text;
  return parameter.number;
}

Json write_phase(const Phase& phase) {
  if (phase.kind == PhaseKind::kHenyeyGreenstein)
    return {{"kind", "henyey_greenstein"}, {"asymmetry", phase.asymmetry}};
  return {{"kind", phase.kind == PhaseKind::kMie ? "mie" : "hg_draine"},
          {"effective_radius_m", phase.effective_radius_m}};
}

Json write_volume(const VolumeSpec& volume, const std::filesystem::path& folder) {
  Json out{{"name", volume.name}, {"source", volume.source}};
  for (const std::string& file : volume.files)
    out["files"].push_back(write_file_name(file, folder));
  for (const SourceParameter& parameter : volume.parameters)
    out["parameters"][parameter.name] = write_parameter(parameter);
  if (volume.place) out["place"] = write_place(*volume.place);
  if (volume.phase) out["phase"] = write_phase(*volume.phase);
  if (volume.co_albedo) out["co_albedo"] = vector(*volume.co_albedo);
  if (volume.time_s) out["time_s"] = *volume.time_s;
  if (volume.utc_ns) out["utc"] = utc_text(*volume.utc_ns);
  if (!volume.time_choice.empty()) out["time"] = volume.time_choice;
  return out;
}

Json write_camera(const CameraSpec& camera) {
  Json out = Json::object();
  if (camera.eye_m) out["look_from_ecef_m"] = vector(*camera.eye_m);
  if (camera.target_m) out["look_at_ecef_m"] = vector(*camera.target_m);
  if (camera.up) out["up_ecef"] = vector(*camera.up);
  if (camera.vertical_fov_rad) out["fov_rad"] = *camera.vertical_fov_rad;
  if (camera.stand) {
    Json& stand = out["stand"];
    stand = {{"lat_deg", camera.stand->latitude_deg},
             {"lon_deg", camera.stand->longitude_deg},
             {"eye_height_m", camera.stand->eye_height_m}};
    if (camera.stand->azimuth_deg) stand["azimuth_deg"] = *camera.stand->azimuth_deg;
    if (camera.stand->elevation_deg) stand["elevation_deg"] = *camera.stand->elevation_deg;
  }
  if (camera.view == View::kOblique) out["view"] = "oblique";
  if (camera.view == View::kGlobe) out["view"] = "globe";
  if (camera.view == View::kGround) out["view"] = "ground";
  return out;
}

Json write_sun(const SunSpec& sun) {
  Json out = Json::object();
  if (sun.to_sun) out["to_sun_ecef"] = vector(*sun.to_sun);
  if (sun.utc_ns) out["utc"] = utc_text(*sun.utc_ns);
  if (sun.azimuth_elevation_deg) {
    out["azimuth_deg"] = sun.azimuth_elevation_deg->x;
    out["elevation_deg"] = sun.azimuth_elevation_deg->y;
  }
  if (sun.irradiance_W_per_m2_nm)
    out["irradiance_W_per_m2_nm"] = vector(*sun.irradiance_W_per_m2_nm);
  return out;
}

Json write_air(const Air& air) {
  return {{"rayleigh_per_m", vector(air.rayleigh_per_m)},
          {"rayleigh_scale_m", air.rayleigh_scale_m},
          {"aerosol_extinction_per_m", vector(air.aerosol_extinction_per_m)},
          {"aerosol_albedo", air.aerosol_albedo},
          {"aerosol_asymmetry", air.aerosol_asymmetry},
          {"aerosol_scale_m", air.aerosol_scale_m},
          {"ozone_per_m", vector(air.ozone_per_m)},
          {"ozone_low_m", air.ozone_low_m},
          {"ozone_peak_m", air.ozone_peak_m},
          {"ozone_high_m", air.ozone_high_m},
          {"top_m", air.top_m}};
}

Json write_planet(const Planet& planet) {
  Json out{{"equatorial_m", planet.body.equatorial_m}, {"polar_m", planet.body.polar_m}};
  out["air"] = planet.air ? write_air(*planet.air) : Json("none");
  out["ground"] = {{"land_albedo", vector(planet.ground.land_albedo)},
                   {"water_albedo", vector(planet.ground.water_albedo)},
                   {"wind_m_per_s", planet.ground.wind_m_per_s}};
  return out;
}

Json write_render(const RenderSettings& settings) {
  Json out{{"budget_mib", settings.budget_mib}};
  if (settings.step_voxels)
    out["step_voxels"] = *settings.step_voxels;
  else
    out["tolerance"] = settings.tolerance;
  if (settings.fetch) out["fetch"] = *settings.fetch == Fetch::kFilter ? "filter" : "texels8";
  out["light"] = settings.light == Light::kSingle ? "single" : "octaves";
  out["octaves"] = settings.octaves;
  out["pixels"] = settings.pixels == WhichPixels::kAll ? "all" : "adaptive";
  out["pixels_per_voxel"] = settings.pixels_per_voxel;
  out["max_level"] = settings.max_level;
  out["seed"] = settings.seed;
  out["probe_pixels"] = settings.probe_pixels;
  out["probe_paths"] = settings.probe_paths;
  if (settings.engine == Engine::kMarch) return out;
  out["engine"] = "reference";
  Json& paths = out["paths"];
  paths = {{"levels", settings.paths.levels == PathLevels::kFinest ? "finest" : "resident"},
           {"host_mib", settings.paths.host_mib},
           {"exact_orders", settings.paths.exact_orders}};
  if (settings.paths.samples) paths["spp"] = settings.paths.samples;
  if (settings.paths.noise > 0) paths["noise"] = settings.paths.noise;
  return out;
}

}  // namespace

std::string write_scene(const Scene& scene, const std::filesystem::path& folder) {
  Json out;
  if (!scene.name.empty()) out["name"] = scene.name;
  if (scene.place) out["place"] = write_place(*scene.place);
  for (const VolumeSpec& volume : scene.volumes)
    out["volumes"].push_back(write_volume(volume, folder));
  out["camera"] = write_camera(scene.camera);
  out["sun"] = write_sun(scene.sun);
  if (scene.sky)
    out["sky"] = {{"zenith_W_per_m2_sr_nm", vector(scene.sky->zenith_W_per_m2_sr_nm)},
                  {"horizon_W_per_m2_sr_nm", vector(scene.sky->horizon_W_per_m2_sr_nm)},
                  {"below_W_per_m2_sr_nm", vector(scene.sky->below_W_per_m2_sr_nm)},
                  {"up_ecef", vector(scene.sky->up)}};
  if (scene.no_planet)
    out["planet"] = "none";
  else if (scene.planet)
    out["planet"] = write_planet(*scene.planet);
  if (scene.terrain) out["terrain"] = write_file_name(scene.terrain->file, folder);
  out["image"] = {{"width", scene.render.width}, {"height", scene.render.height}};
  out["render"] = write_render(scene.render);
  if (scene.target)
    for (const char* chosen : {"tolerance", "step_voxels", "budget_mib"})
      out["render"].erase(chosen);
  if (scene.target.error) out["render"]["target_error"] = *scene.target.error;
  if (scene.target.frame_ms) out["render"]["target_ms"] = *scene.target.frame_ms;
  if (scene.exposure_ev) out["exposure_ev"] = *scene.exposure_ev;
  out["tone_map"] = scene.tone_map == ToneMap::kNone ? "none" : "aces";
  if (scene.dither) out["dither"] = "ordered";
  return out.dump(-1, ' ', true,
                  Json::error_handler_t::replace);  // ASCII: PNG text chunks are Latin-1
}

}  // namespace nepho
