#include "common/planet_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>

#include "common/planet_view.h"
#include "core/error.h"
#include "geo/place.h"
#include "scene/scene_file.h"
#include "scene/utc.h"
#include "sun/sun_position.h"

namespace nepho {
namespace {

constexpr double kDay_rad = glm::radians(15.0);     // sun at least: for a time of our choice
constexpr double kNight_rad = glm::radians(3.0);    // sun below: for one that was asked for
constexpr double kRegion_rad = glm::radians(20.0);  // clouds within: a part of the planet
constexpr double kLowEye_m = 3000;  // below, the sun's angles are told at the eye, not the target
constexpr double kNearMap_m = 90e3;

std::string text(const char* pattern, auto... values) {
  char line[256];
  std::snprintf(line, sizeof line, pattern, values...);
  return line;
}

bool dated(const VolumeInfo& info) {
  return info.time_origin_ns != 0;
}

bool has_cloud(const BrickSource& source, double time_s) {
  for (int root = 0; root < source.info().chart->roots(); ++root)
    if (summary_of(source, {root, 0, 0u, 0u, 0u}, time_s).max_extinction_per_m > 0) return true;
  return false;
}

const ShellChart* shell_of(const BrickSource& source) {
  return dynamic_cast<const ShellChart*>(source.info().chart.get());
}

std::string geo_text(const Ellipsoid& body, const glm::dvec3& ecef_m) {
  const GeodeticPoint p = geodetic_point(body, ecef_m);
  return text("geo:%.6f,%.6f,%.1f", p.latitude_deg, p.longitude_deg, p.height_m);
}

// One scene being framed: what is fixed, and what is still open.
class Framing {
 public:
  Framing(OpenedScene& opened, const Ellipsoid& body) : opened_(opened), scene_(opened.scene) {
    ground_.body = body;
    if (opened.terrain) ground_.maps.push_back(opened.terrain);
    for (std::size_t v = 0; v < opened.sources.size(); ++v) {
      if (info(v).on_planet) weather_.push_back(v);
      if (info(v).surface && !opened.terrain) ground_.maps.push_back(info(v).surface);
    }
    if (weather_.empty())
      for (std::size_t v = 0; v < opened.sources.size(); ++v) weather_.push_back(v);
    lens_.aspect = double(scene_.render.width) / scene_.render.height;
  }

  PlanetShot run() {
    fix_times();
    choose_times();
    find_sun_before_camera();
    find_camera();
    find_sun_after_camera();
    check_eye();
    return {view_.camera, sun_distance_au_, sun_utc_ns_};
  }

 private:
  const VolumeInfo& info(std::size_t v) const { return opened_.sources[v]->info(); }
  double& time_s(std::size_t v) { return opened_.request.volumes[v].time_s; }
  VolumeSpec& spec(std::size_t v) { return scene_.volumes[v]; }

  void fix_times() {
    open_times_.assign(scene_.volumes.size(), false);
    for (std::size_t v = 0; v < scene_.volumes.size(); ++v) {
      if (const auto named_s = named_time(spec(v), *opened_.sources[v]))
        time_s(v) = *named_s;
      else
        open_times_[v] = true;
      if (open_times_[v]) time_s(v) = first_time_with_cloud(*opened_.sources[v]);
    }
    for (const std::size_t v : weather_)
      if (dated(info(v))) {
        lead_ = v;
        break;
      }
  }

  // The sun decides only where nothing else does.
  void choose_times() {
    const SunSpec& sun = scene_.sun;
    if (lead_ && open_times_[*lead_]) {
      if (sun.utc_ns) {
        for (const double t : info(*lead_).times_s)
          if (utc_of(info(*lead_), t) == *sun.utc_ns) time_s(*lead_) = t;
      } else if (!sun.to_sun && !sun.azimuth_elevation_deg) {
        choose_day(*lead_);
      }
      if (info(*lead_).times_s.size() > 1) {
        const std::string utc = utc_text(utc_of(info(*lead_), time_s(*lead_)));
        opened_.assumptions.push_back(info(*lead_).name + ": the first time with cloud" +
                                      (day_ ? ", by day" : "") + ", --time " + utc);
      }
    }
    // What else has the same date shows it.
    for (std::size_t v = 0; v < scene_.volumes.size(); ++v) {
      if (lead_ && v != *lead_ && open_times_[v] && dated(info(v)))
        for (const double t : info(v).times_s)
          if (utc_of(info(v), t) == utc_of(info(*lead_), time_s(*lead_))) time_s(v) = t;
      spec(v).utc_ns.reset();
      spec(v).time_choice.clear();
      spec(v).time_s = time_s(v);
    }
  }

  void choose_day(std::size_t lead) {
    const auto place = known_place();
    if (!place && is_globe()) return;  // there it is day somewhere
    const glm::dvec3 about =
        place ? *place
              : ground_.point_m(map().empty() ? middle_of_ground() : map().bulk().direction, 0);
    const glm::dvec3 up = ground_.axes(about).up;
    for (const double t : info(lead).times_s) {
      if (t < time_s(lead)) continue;
      const glm::dvec3 to_sun = sun_position(utc_of(info(lead), t)).to_sun;
      if (std::asin(glm::dot(to_sun, up)) < kDay_rad || !has_cloud(*opened_.sources[lead], t))
        continue;
      if (t != time_s(lead)) map_.reset();
      time_s(lead) = t;
      day_ = true;
      return;
    }
  }

  // Where the view is, if that does not hang on the clouds.
  std::optional<glm::dvec3> known_place() const {
    const CameraSpec& wish = scene_.camera;
    if (wish.stand)
      return ecef_m(ground_.body, {wish.stand->latitude_deg, wish.stand->longitude_deg, 0});
    if (wish.eye_m && wish.target_m) return place_told(*wish.eye_m, *wish.target_m);
    return wish.target_m;
  }
  glm::dvec3 place_told(const glm::dvec3& eye_m, const glm::dvec3& target_m) const {
    return geodetic_height_m(ground_.body, eye_m) < kLowEye_m ? eye_m : target_m;
  }

  const CloudMap& map() {
    if (!map_) map_ = map_within(std::nullopt);
    return *map_;
  }
  CloudMap map_within(const std::optional<Cap>& cap) {
    CloudMap result;
    for (const std::size_t v : weather_)
      append(result, cloud_map(*opened_.sources[v], time_s(v), ground_.body, cap));
    return result;
  }
  bool is_globe() {
    if (scene_.camera.view != View::kAuto) return scene_.camera.view == View::kGlobe;
    return map().empty() ? ground_.maps.empty() : map().extent().radius_rad > kRegion_rad;
  }
  // Where to look within the whole map: a first guess.
  glm::dvec3 varied_place(double part_m) {
    if (map().empty()) return middle_of_ground();
    const double width_m = std::max(part_m, map().cell_m);
    return most_varied(map(), width_m / ground_.body.equatorial_m, ground_);
  }
  // Whether the whole map tells such a part apart, and is little more.
  bool map_shows(double part_m) {
    const double body_m = ground_.body.equatorial_m;
    return map().empty() || (map().cell_m < std::max(part_m / 10, 1.5 * map().finest_cell_m) &&
                             map().extent().radius_rad * body_m < 6 * part_m);
  }
  // Finer columns around a place.
  CloudMap map_about(const glm::dvec3& place, double part_m) {
    const double radius_m = 3 * std::max(part_m, map().cell_m);
    const CloudMap finer = map_within(Cap{place, radius_m / ground_.body.equatorial_m});
    return finer.empty() ? map() : finer;
  }
  glm::dvec3 middle_of_ground() const {
    if (ground_.maps.empty()) return {1, 0, 0};
    const SurfaceMap& m = *ground_.maps.front();
    const glm::dvec2 a = m.low_rad + 0.5 * m.step_rad * glm::dvec2(m.nx - 1, m.ny - 1);
    return m.axes *
           glm::dvec3(std::cos(a.y) * std::cos(a.x), std::cos(a.y) * std::sin(a.x), std::sin(a.y));
  }

  void find_sun_before_camera() {
    SunSpec& sun = scene_.sun;
    std::optional<std::int64_t> utc_ns = sun.utc_ns;
    real_sun_ = !sun.to_sun && !sun.azimuth_elevation_deg && !utc_ns && lead_.has_value();
    if (real_sun_) utc_ns = utc_of(info(*lead_), time_s(*lead_));
    if (!utc_ns) return;
    const SunPosition position = sun_position(*utc_ns);
    sun.to_sun = position.to_sun;
    sun.utc_ns.reset();
    sun_distance_au_ = position.distance_au;
    sun_utc_ns_ = utc_ns;
    sun_utc_ = utc_text(*utc_ns);
  }

  void find_camera() {
    const CameraSpec& wish = scene_.camera;
    const bool globe = !wish.stand && !wish.eye_m && !wish.target_m && is_globe();
    const bool stands = wish.stand || wish.view == View::kGround;
    lens_.vertical_fov_rad = wish.vertical_fov_rad.value_or(globe    ? kGlobeFov_rad
                                                            : stands ? kStandingFov_rad
                                                                     : kObliqueFov_rad);
    if (wish.eye_m && wish.target_m)
      look(*wish.eye_m, *wish.target_m);
    else if (stands)
      stand();
    else if (globe)
      look_at_globe();
    else
      look_down();
    if (wish.up) view_.camera.up = *wish.up;
  }

  void look(const glm::dvec3& eye_m, const glm::dvec3& target_m) {
    Camera& camera = view_.camera;
    camera = {eye_m, target_m, {}, lens_.vertical_fov_rad};
    const LocalAxes axes = ground_.axes(eye_m);
    const glm::dvec3 forward = glm::normalize(target_m - eye_m);
    camera.up = glm::length(glm::cross(forward, axes.up)) > 1e-6 ? axes.up : axes.north;
    view_.centre_m = place_told(eye_m, target_m);
  }
  void stand() {
    const glm::dvec3* sun = scene_.sun.to_sun ? &*scene_.sun.to_sun : nullptr;
    const auto to_sun = sun ? std::optional(*sun) : std::nullopt;
    Stand stand = scene_.camera.stand ? *scene_.camera.stand : stand_by_clouds(to_sun);
    const glm::dvec3 here =
        glm::normalize(ecef_m(ground_.body, {stand.latitude_deg, stand.longitude_deg, 0}));
    const bool open = !stand.azimuth_deg || !stand.elevation_deg;
    const CloudMap near =
        open ? map_within(Cap{here, kNearMap_m / ground_.body.equatorial_m}) : CloudMap{};
    view_ = standing_view(stand, near, ground_, lens_, to_sun);
    if (!open) return;
    const LocalAxes axes = ground_.axes(view_.centre_m);
    const glm::dvec2 angles_deg =
        sun_angles_deg(axes, glm::normalize(view_.camera.target_m - view_.camera.eye_m));
    opened_.assumptions.push_back(
        text("view: from the ground, --at %.6f,%.6f,%g --heading %.2f --pitch %.2f --fov %.4g",
             stand.latitude_deg, stand.longitude_deg, stand.eye_height_m, angles_deg.x,
             angles_deg.y, glm::degrees(lens_.vertical_fov_rad)));
  }
  Stand stand_by_clouds(const std::optional<glm::dvec3>& to_sun) {
    const double part_m = standing_part_m(map(), ground_.body);
    const glm::dvec3 place = varied_place(part_m);
    return place_to_stand(map_shows(part_m) ? map() : map_about(place, part_m), place, ground_,
                          lens_, to_sun);
  }
  void look_at_globe() {
    view_ = globe_view(map(), ground_, lens_, scene_.sun.to_sun);
    state_view("the globe, from its sunlit side with the most structure");
  }
  void look_down() {
    const CameraSpec& wish = scene_.camera;
    const double part_m = oblique_part_m(map(), ground_.body);
    std::optional<glm::dvec3> target;
    if (wish.target_m) target = glm::normalize(*wish.target_m);
    if (map().empty()) target = target.value_or(middle_of_ground());
    const CloudMap near =
        map_shows(part_m) ? map() : map_about(target ? *target : varied_place(part_m), part_m);
    view_ = oblique_view(near, part_m, target, ground_, lens_, scene_.sun.to_sun);
    if (wish.target_m) view_.camera.target_m = *wish.target_m;
    if (wish.eye_m) look(*wish.eye_m, view_.camera.target_m);
    state_view(wish.target_m ? "oblique, on the given target"
               : wish.eye_m  ? "on the clouds"
                             : "oblique, where the clouds have most structure");
  }
  void state_view(const char* what) {
    opened_.assumptions.push_back(std::string("view: ") + what + ", --look-from " +
                                  geo_text(ground_.body, view_.camera.eye_m) + " --look-at " +
                                  geo_text(ground_.body, view_.camera.target_m) +
                                  text(" --fov %.4g", glm::degrees(lens_.vertical_fov_rad)));
  }

  void find_sun_after_camera() {
    SunSpec& sun = scene_.sun;
    const LocalAxes axes = ground_.axes(view_.centre_m);
    if (sun.azimuth_elevation_deg) {
      const glm::dvec2 a = glm::radians(*sun.azimuth_elevation_deg);
      sun.to_sun = std::cos(a.y) * (std::sin(a.x) * axes.east + std::cos(a.x) * axes.north) +
                   std::sin(a.y) * axes.up;
      sun.azimuth_elevation_deg.reset();
      return;
    }
    if (sun.to_sun && !real_sun_) return;
    if (!sun.to_sun) {
      put_sun(axes, "the data have no date");
      return;
    }
    const glm::dvec2 real_deg = sun_angles_deg(axes, *sun.to_sun);
    // A globe shows its day side; a time of our own choice was searched for day.
    if (glm::radians(real_deg.y) >= (open_times_[*lead_] && !day_ ? kDay_rad : kNight_rad)) {
      opened_.assumptions.push_back(
          text("sun: where it stood at %s, azimuth %.1f, %.1f degrees high", sun_utc_.c_str(),
               real_deg.x, real_deg.y));
      return;
    }
    sun_distance_au_ = 1;
    sun_utc_ns_.reset();
    put_sun(axes,
            text("%s there at the valid time, the sun %.0f degrees high; --sun %s for the real one",
                 real_deg.y < 0 ? "night" : "low sun", real_deg.y, sun_utc_.c_str()));
  }
  void put_sun(const LocalAxes& axes, const std::string& why) {
    scene_.sun.to_sun = sun_to_the_side(view_.camera, axes);
    const glm::dvec2 deg = sun_angles_deg(axes, *scene_.sun.to_sun);
    opened_.assumptions.push_back(
        text("sun: 35 degrees high to the side, --sun %.2f,%.2f (", deg.x, deg.y) + why + ")");
  }

  void check_eye() const {
    if (!scene_.planet) return;
    const glm::dvec3& eye_m = view_.camera.eye_m;
    const double ground_m = ground_.height_m(eye_m);
    const double eye_height_m = geodetic_height_m(ground_.body, eye_m);
    if (eye_height_m > ground_m - 0.5) return;
    throw Error({"the eye is below the ground", "camera", text("a height above %.1f m", ground_m),
                 text("%.1f m", eye_height_m), "--at stands on the ground"});
  }

  OpenedScene& opened_;
  Scene& scene_;
  PlanetGround ground_;
  Lens lens_;
  std::vector<std::size_t> weather_;
  std::vector<bool> open_times_;
  std::optional<std::size_t> lead_;  // the volume whose date the picture has
  std::optional<CloudMap> map_;      // at the times chosen so far
  bool day_ = false, real_sun_ = false;
  double sun_distance_au_ = 1;
  std::optional<std::int64_t> sun_utc_ns_;
  std::string sun_utc_;
  PlanetView view_;
};

}  // namespace

void resolve_planet(OpenedScene& opened) {
  Scene& scene = opened.scene;
  const ShellChart* weather = nullptr;
  bool any = scene.terrain.has_value();
  for (const auto& source : opened.sources) {
    if (!source->info().on_planet) continue;
    any = true;
    if (!weather) weather = shell_of(*source);
  }
  if (any && !scene.planet && !scene.sky && !scene.no_planet) {
    scene.planet = Planet{};
    if (weather) scene.planet->body = weather->body();
    opened.assumptions.push_back("planet: ground and air of the Earth, --no-planet for none");
  }
  if (!scene.planet || !weather) return;
  const Ellipsoid &a = scene.planet->body, &b = weather->body();
  if (std::abs(a.equatorial_m - b.equatorial_m) > 1 || std::abs(a.polar_m - b.polar_m) > 1)
    throw Error({"the planet is not the one that its weather lies on", "planet",
                 text("half axes %.1f and %.1f m", b.equatorial_m, b.polar_m),
                 text("%.1f and %.1f m", a.equatorial_m, a.polar_m), ""});
}

std::optional<Ellipsoid> body_of(const OpenedScene& opened) {
  if (opened.scene.planet) return opened.scene.planet->body;
  for (const auto& source : opened.sources)
    if (source->info().on_planet) {
      const ShellChart* shell = shell_of(*source);
      return shell ? shell->body() : Ellipsoid::wgs84();
    }
  return std::nullopt;
}

double white_in_the_sun(const OpenedScene& opened) {
  const Camera& camera = opened.request.camera;
  const Sun& sun = opened.request.sun;
  const bool low =
      geodetic_height_m(body_of(opened).value_or(Ellipsoid::wgs84()), camera.eye_m) < kLowEye_m;
  const double mu = glm::dot(glm::normalize(low ? camera.eye_m : camera.target_m), sun.to_sun);
  if (mu <= -0.1) return 0;
  const double through_air = std::exp(-0.2 / (std::max(mu, 0.0) + 0.05));
  const double luminance = glm::dot(sun.irradiance_W_per_m2_nm, {0.2126, 0.7152, 0.0722});
  return luminance * through_air * (0.5 + 0.5 * std::max(mu, 0.0)) / glm::pi<double>();
}

PlanetShot frame_on_planet(OpenedScene& opened, const Ellipsoid& body) {
  return Framing(opened, body).run();
}

}  // namespace nepho
