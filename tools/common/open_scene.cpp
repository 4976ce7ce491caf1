#include "common/open_scene.h"

#include <algorithm>
#include <cmath>

#include "bricks/box_chart.h"
#include "common/framing.h"
#include "common/planet_scene.h"
#include "common/terrain.h"
#include "core/error.h"
#include "optics/phase_table.h"
#include "scene/scene_file.h"
#include "sun/sun_position.h"

namespace nepho {
namespace {

// A clear day at sea level, sun 40 degrees high: what is left of 1.6, 1.85, 2.0 W m-2 nm-1 at 650,
// 550, 450 nm behind the air, and the blue that the air made of the rest. Rounded: a background to
// look at, until the atmosphere is computed.
constexpr glm::dvec3 kSunIrradiance_W_per_m2_nm{1.42, 1.50, 1.45};
// Outside the air, at 1 au: ASTM G173-03 (2003), extraterrestrial, at 650, 550, 450 nm.
constexpr glm::dvec3 kSunOutside_W_per_m2_nm{1.52143, 1.8504, 2.03474};
constexpr glm::dvec3 kZenith_W_per_m2_sr_nm{0.018, 0.040, 0.092};
constexpr glm::dvec3 kHorizon_W_per_m2_sr_nm{0.078, 0.108, 0.150};
constexpr glm::dvec3 kBelow_W_per_m2_sr_nm{0.032, 0.038, 0.044};

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string listed(const std::vector<double>& times_s) {
  std::string text;
  for (std::size_t i = 0; i < times_s.size() && i < 8; ++i)
    text += (i ? ", " : "") + std::to_string(times_s[i]);
  return text + (times_s.size() > 8 ? ", ... s" : " s");
}

// A planet's up is its own at each place; a box stands in the scene's frame.
LocalAxes axes_at(const OpenedScene& opened, const Placement& frame, const glm::dvec3& ecef_m) {
  const bool globe = std::any_of(opened.sources.begin(), opened.sources.end(), [](const auto& s) {
    return s->info().chart->kind() == ChartKind::kShell;
  });
  LocalAxes axes{axis(frame, 0), axis(frame, 1), axis(frame, 2)};
  if (!globe || opened.scene.place || glm::length(ecef_m) < 1e5) return axes;
  axes.up = glm::normalize(ecef_m);
  const glm::dvec3 pole{0, 0, 1};
  const glm::dvec3 east = glm::cross(pole, axes.up);
  axes.east = glm::length(east) > 1e-9 ? glm::normalize(east) : glm::dvec3(0, 1, 0);
  axes.north = glm::cross(axes.up, axes.east);
  return axes;
}

glm::dvec3 rough_middle(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : points) sum += p / double(points.size());
  return sum;
}

// A layer that goes on beyond its box: seen from the side, the eye would be inside.
bool endless(const BrickSource& source) {
  const Chart& chart = *source.info().chart;
  if (chart.kind() != ChartKind::kBox) return false;
  const Periodic periodic = static_cast<const BoxChart&>(chart).periodic();
  return periodic.x || periodic.y;
}

Camera find_camera(const OpenedScene& opened, const Placement& frame) {
  const CameraSpec& wish = opened.scene.camera;
  std::vector<glm::dvec3> points;
  if (!wish.eye_m || !wish.target_m)
    for (std::size_t v = 0; v < opened.sources.size(); ++v) {
      const auto more = occupied_points(*opened.sources[v], opened.request.volumes[v].time_s);
      points.insert(points.end(), more.begin(), more.end());
    }
  if ((!wish.eye_m || !wish.target_m) && points.empty()) {
    // An empty frame is legal data: it is drawn from where the whole box would be seen.
    for (const auto& source : opened.sources)
      for (int corner = 0; corner < 8; ++corner)
        points.push_back(source->info().chart->ecef_m(
            {0, glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2)}));
  }
  const glm::dvec3 about = wish.target_m ? *wish.target_m
                           : wish.eye_m  ? *wish.eye_m
                                         : rough_middle(points);
  const RenderSettings& settings = opened.scene.render;
  return frame_camera(
      points, axes_at(opened, frame, about), wish, double(settings.width) / settings.height,
      std::ranges::any_of(opened.sources, [](const auto& s) { return endless(*s); }));
}

// For clouds that are on no planet.
void find_sun(OpenedScene& opened, const Placement& frame, const Camera& camera) {
  SunSpec& sun = opened.scene.sun;
  if (sun.azimuth_elevation_deg) {
    const glm::dvec2 angles_rad = glm::radians(*sun.azimuth_elevation_deg);
    sun.to_sun = sun_direction(frame, angles_rad.x, angles_rad.y);
    sun.azimuth_elevation_deg.reset();
  }
  if (sun.utc_ns) {
    sun.to_sun = sun_position(*sun.utc_ns).to_sun;
    sun.utc_ns.reset();
  }
  if (sun.to_sun) return;
  const glm::dvec3 about = glm::length(camera.target_m) > 1e5 ? camera.target_m : camera.eye_m;
  sun.to_sun = sun_over_left_shoulder(camera, axes_at(opened, frame, about).up);
  opened.assumptions.push_back("sun: 40 degrees high, behind the camera's left shoulder");
}

void find_sky(OpenedScene& opened, const Placement& frame, const Camera& camera) {
  Scene& scene = opened.scene;
  if (scene.planet || scene.sky) return;
  const glm::dvec3 about = glm::length(camera.target_m) > 1e5 ? camera.target_m : camera.eye_m;
  scene.sky = Sky{axes_at(opened, frame, about).up, kZenith_W_per_m2_sr_nm, kHorizon_W_per_m2_sr_nm,
                  kBelow_W_per_m2_sr_nm};
  opened.assumptions.push_back("sky: a clear day's gradient");
}

// A place to stand, a view of a planet and a date are nothing to clouds that are nowhere.
void refuse_planets_wishes(const Scene& scene) {
  const auto refuse = [](const char* what, const char* where) {
    throw Error(
        {what, where, "a volume that is weather of a planet, or a scene with one", "none", ""});
  };
  if (scene.camera.stand) refuse("no ground to stand on", "camera.stand (--at)");
  if (scene.camera.view != View::kAuto) refuse("no planet to view", "camera.view (--view)");
  if (scene.sun.utc_ns && !has_frame(scene))
    refuse("no planet under the sun of a date", "sun.utc (--sun)");
}

// Times and camera of clouds that are on no planet.
Camera frame_freely(OpenedScene& opened, const Placement& frame) {
  refuse_planets_wishes(opened.scene);
  for (std::size_t v = 0; v < opened.sources.size(); ++v) {
    VolumeSpec& volume = opened.scene.volumes[v];
    const BrickSource& source = *opened.sources[v];
    const VolumeInfo& info = source.info();
    const std::optional<double> named_s = named_time(volume, source);
    const double time_s = named_s ? *named_s : first_time_with_cloud(source);
    if (named_s) volume.time_s = named_s;
    volume.utc_ns.reset();
    volume.time_choice.clear();
    if (time_s != info.times_s.front() && !named_s)
      opened.assumptions.push_back(info.name + ": the first time that is not empty, " +
                                   number_text(time_s) + " s");
    opened.request.volumes[v].time_s = time_s;
  }
  const CameraSpec& wish = opened.scene.camera;
  const bool framed = !wish.eye_m || !wish.target_m;
  const Camera camera = find_camera(opened, frame);
  if (framed) {
    const glm::dvec3 eye = to_local(frame, camera.eye_m), target = to_local(frame, camera.target_m);
    const auto point = [](const glm::dvec3& p) {
      return number_text(p.x) + "," + number_text(p.y) + "," + number_text(p.z);
    };
    opened.assumptions.push_back("camera: frames the cloud, --look-from " + point(eye) +
                                 " --look-at " + point(target));
  }
  find_sun(opened, frame, camera);
  return camera;
}

// A source knows its parameters by their names in SI; the user reads those that he wrote.
void name_as_written(std::string& text, const SourceParameter& parameter) {
  const std::string name = "'" + parameter.name + "'", written = "'" + parameter.written + "'";
  if (parameter.written.empty()) return;
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += written.size())
    text.replace(at, name.size(), written);
}

[[noreturn]] void rethrow_with_place(const Error& error, const VolumeSpec& volume) {
  Error::Parts parts = error.parts();
  std::string where = volume.where;
  for (const SourceParameter& parameter : volume.parameters) {
    const std::string name = "'" + parameter.name + "'";
    if (parts.where.find(name) == std::string::npos && parts.found.find(name) == std::string::npos)
      continue;
    where = parameter.where;
    name_as_written(parts.where, parameter);
    name_as_written(parts.found, parameter);
  }
  if (!where.empty()) parts.where = where + (parts.where.empty() ? "" : ": ") + parts.where;
  throw Error(parts);
}

}  // namespace

std::unique_ptr<BrickSource> open_volume(const SourceHost& host, const VolumeSpec& volume) {
  try {
    return host.open(volume);
  } catch (const Error& error) {
    rethrow_with_place(error, volume);
  }
}

double time_of(const VolumeSpec& volume, const VolumeInfo& info) {
  if (info.times_s.empty())
    throw Error({"no time at all", "volume '" + info.name + "'", "", "", ""});
  if (!volume.time_s) return info.times_s.front();
  const auto found = std::find(info.times_s.begin(), info.times_s.end(), *volume.time_s);
  if (found == info.times_s.end())
    throw Error({"no such time", volume.where.empty() ? "volume '" + info.name + "'" : volume.where,
                 "one of " + listed(info.times_s), std::to_string(*volume.time_s) + " s", ""});
  return *found;
}

double first_time_with_cloud(const BrickSource& source) {
  const VolumeInfo& info = source.info();
  for (const double time_s : info.times_s)
    for (int root = 0; root < info.chart->roots(); ++root)
      if (summary_of(source, {root, 0, 0u, 0u, 0u}, time_s).max_extinction_per_m > 0) return time_s;
  return time_of({}, info);
}

// What the fit costs: light that has been scattered often knows of (1 - asymmetry) x depth only.
std::string fit_note(const Phase& fit) {
  constexpr double kLeastOfMie_m = 4e-6;  // of the table
  const Phase mie{PhaseKind::kMie, std::max(fit.effective_radius_m, kLeastOfMie_m), 0};
  const double g = phase_bulk(fit).asymmetry[1], exact = phase_bulk(mie).asymmetry[1];
  return "phase hg_draine: a fit to droplets of asymmetry " + number_text(g) + ", Mie's is " +
         number_text(exact) + ": light after many scatterings sees " +
         number_text(100 * (1 - (1 - g) / (1 - exact))) + " % less cloud; no fogbow, no glory";
}

OpenedScene open_scene(const SourceHost& host, Scene scene) {
  OpenedScene opened;
  opened.scene = std::move(scene);
  for (const VolumeSpec& volume : opened.scene.volumes) {
    opened.sources.push_back(open_volume(host, volume));
    const VolumeInfo& info = opened.sources.back()->info();
    opened.request.volumes.push_back({opened.sources.back().get(), 0.0,
                                      volume.phase.value_or(info.phase), info.ice_phase,
                                      volume.co_albedo.value_or(info.co_albedo)});
    for (const std::string& text : info.assumptions)
      opened.assumptions.push_back(info.name + ": " + text);
    if (opened.request.volumes.back().phase.kind == PhaseKind::kHgDraine)
      opened.assumptions.push_back(info.name + ": " +
                                   fit_note(opened.request.volumes.back().phase));
  }
  const Placement frame = scene_frame(opened.scene);
  resolve_planet(opened);
  open_terrain(host, opened);
  Camera camera;
  glm::dvec3 irradiance = kSunIrradiance_W_per_m2_nm;
  if (const auto body = body_of(opened)) {
    const PlanetShot shot = frame_on_planet(opened, *body);
    camera = shot.camera;
    opened.sun_utc_ns = shot.sun_utc_ns;
    // Above the air, and the farther the fainter.
    if (opened.scene.planet && !opened.scene.sun.irradiance_W_per_m2_nm)
      opened.sun_distance_au = shot.sun_distance_au;
    if (opened.scene.planet)
      irradiance = kSunOutside_W_per_m2_nm / (shot.sun_distance_au * shot.sun_distance_au);
  } else {
    camera = frame_freely(opened, frame);
  }
  SunSpec& sun = opened.scene.sun;
  if (!sun.irradiance_W_per_m2_nm) sun.irradiance_W_per_m2_nm = irradiance;
  find_sky(opened, frame, camera);
  opened.scene.camera = {};
  opened.scene.camera.eye_m = camera.eye_m;
  opened.scene.camera.target_m = camera.target_m;
  opened.scene.camera.up = camera.up;
  opened.scene.camera.vertical_fov_rad = camera.vertical_fov_rad;
  opened.request.camera = camera;
  opened.request.sun = {*sun.to_sun, *sun.irradiance_W_per_m2_nm};
  opened.request.planet = opened.scene.planet;
  if (opened.scene.sky) opened.request.sky = *opened.scene.sky;
  opened.request.settings = opened.scene.render;
  return opened;
}

}  // namespace nepho
