#include "reference/ray_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bricks/box_chart.h"
#include "optics/phase_table.h"
#include "physics/physics_cpp.h"
#include "reference/trace.h"
#include "tree/source_verbs.h"

namespace nepho {
namespace {

constexpr double kDark = 16;     // light of 1e-7 is none
constexpr double kDarkSky = 40;  // as light_sky.comp: the sky is dark to 4e-4

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

// A direction across `up`, whichever: the renderer's choice.
glm::dvec3 across(const glm::dvec3& up) {
  const glm::dvec3 other =
      std::abs(up.x) < 0.6 ? glm::dvec3{1.0, 0.0, 0.0} : glm::dvec3{0.0, 1.0, 0.0};
  return glm::normalize(glm::cross(up, other));
}

// No extinction of the chart is higher over the planet, in scaled space.
double top_m(const Chart& chart, const PlanetModel& planet) {
  if (const auto* shell = dynamic_cast<const ShellChart*>(&chart))
    return shell->bottom_m() + shell->thickness_m();
  const auto& box = dynamic_cast<const BoxChart&>(chart);
  if (box.periodic().x || box.periodic().y) return std::numeric_limits<double>::infinity();
  double top_m = -kNoDistance_m;
  for (int c = 0; c < 8; ++c)
    top_m = std::max(top_m,
                     planet.place(box.ecef_m({0, glm::dvec3(c & 1, c >> 1 & 1, c >> 2)})).height_m);
  return top_m;
}

}  // namespace

std::array<glm::dvec3, 3> sky_axes(const glm::dvec3& up) {
  const glm::dvec3 east = across(up);
  return {up, east, glm::cross(up, east)};
}

CameraRays::CameraRays(const Camera& camera, int width, int height)
    : eye_m_(camera.eye_m),
      forward_(glm::normalize(camera.target_m - camera.eye_m)),
      width_(width),
      height_(height) {
  glm::dvec3 right = glm::cross(forward_, camera.up);
  right = glm::length(right) > 1e-9 ? glm::normalize(right) : across(forward_);
  const double half = std::tan(camera.vertical_fov_rad / 2);
  right_ = half * width / height * right;
  up_ = half * glm::cross(right, forward_);
}

Ray CameraRays::ray(int x, int y) const {
  const double u = (2.0 * x + 1) / width_ - 1, v = 1 - (2.0 * y + 1) / height_;
  return {eye_m_, glm::normalize(forward_ + u * right_ + v * up_)};
}

Ray camera_ray(const Camera& camera, int width, int height, int x, int y) {
  return CameraRays(camera, width, height).ray(x, y);
}

RayMarch::RayMarch(const LevelSet& levels, const RenderRequest& request, MarchSettings settings,
                   std::shared_ptr<const PlanetModel> planet)
    : levels_(levels),
      request_(request),
      settings_(std::move(settings)),
      planet_(std::move(planet)) {
  if (request.planet && !planet_) planet_ = std::make_shared<const PlanetModel>(request, nullptr);
  const Sky& sky = request.sky;
  sky_lights_ = planet_ ? planet_->has_air()
                        : luminance(sky.zenith_W_per_m2_sr_nm + sky.horizon_W_per_m2_sr_nm +
                                    sky.below_W_per_m2_sr_nm) > 0;
  octaves_ = request.settings.light == nepho::Light::kOctaves ? request.settings.octaves : 1;
  sky_axes_ = sky_axes(glm::normalize(sky.up));
  if (planet_)
    ground_.set(request.planet->body);
  else
    for (std::size_t v = 0; v < levels.size(); ++v) ground_.add(*levels.info(v).chart);
  for (const RenderVolume& volume : request.volumes) {
    Look& look = looks_.emplace_back();
    look.phase_table = phase_table(volume.phase);
    look.asymmetry = phase_bulk(volume.phase).asymmetry[1];
    if (!has_ice(volume.source->info())) continue;
    look.ice_phase_table = phase_table(volume.ice_phase);
    look.ice_asymmetry = phase_bulk(volume.ice_phase).asymmetry[1];
  }
  for (std::size_t v = 0; planet_ && v < levels.size(); ++v)
    cloud_top_m_ = std::max(cloud_top_m_, top_m(*levels.info(v).chart, *planet_));
}

double RayMarch::optical_depth(const Ray& ray, double t_max_m, double most) const {
  t_max_m = std::min(t_max_m, ground_.distance_m(ray));
  double tau = 0;
  for (std::size_t v = 0; v < levels_.size(); ++v) {
    VolumeWalk walk(levels_, v, ray, t_max_m, true);
    const double before = tau;
    while (tau < most && walk.next()) {
      const double length_m = walk.t1_m() - walk.t0_m();
      if (walk.kind() == NodeKind::kEmpty || !(length_m > 0)) continue;
      if (walk.kind() == NodeKind::kConstant) {
        tau += length_m * walk.extinction_per_m(walk.t0_m());
        continue;
      }
      const int steps = walk.sub_steps(length_m);
      const double h = length_m / steps;
      double k0 = walk.extinction_per_m(walk.t0_m());
      for (int s = 0; s < steps; ++s) {
        const double t = walk.t0_m() + s * h;
        const double k1 = walk.extinction_per_m(s + 1 == steps ? walk.t1_m() : t + h);
        tau += f64::simpson_optical_depth(k0, walk.extinction_per_m(t + h / 2), k1, h);
        k0 = k1;
      }
    }
    if (walk.endless() && tau > before) return std::numeric_limits<double>::infinity();
  }
  return tau;
}

double RayMarch::visibility(const glm::dvec3& point_m, const glm::dvec3& direction) const {
  const double tau = optical_depth({point_m, direction}, kNoDistance_m, kDarkSky);
  return request_.settings.light == nepho::Light::kSingle ? std::exp(-tau)
                                                          : f64::sky_visibility(tau);
}

double RayMarch::sun_passed(const glm::dvec3& point_m) const {
  return std::exp(-optical_depth({point_m, planet_->to_sun()}, kNoDistance_m, kDark));
}

RayMarch::Light RayMarch::unshadowed(const glm::dvec3& point_m) const {
  Light light;
  if (planet_) {
    const PlanetModel::Place place = planet_->place(point_m);
    light.sun_W_per_m2_nm = planet_->sun_W_per_m2_nm(place);
    light.sky = planet_->sky_light(place);
  } else {
    light.sun_W_per_m2_nm = request_.sun.irradiance_W_per_m2_nm;
    light.sky.up = request_.sky.zenith_W_per_m2_sr_nm;
    light.sky.side = request_.sky.horizon_W_per_m2_sr_nm;
    light.sky.down = request_.sky.below_W_per_m2_sr_nm;
    light.sun_part = ground_.sun_part(point_m, glm::normalize(request_.sun.to_sun));
  }
  return light;
}

RayMarch::Light RayMarch::light_at(const glm::dvec3& point_m) const {
  Light light = unshadowed(point_m);
  if (settings_.lights) return light;
  if (luminance(light.sun_W_per_m2_nm) > 0)
    light.tau_sun = optical_depth({point_m, glm::normalize(request_.sun.to_sun)});
  if (!sky_lights_) return light;
  const auto& [up, east, north] =
      planet_ ? planet_sky_axes(point_m, planet_->z_scale()) : sky_axes_;
  light.visible_up = visibility(point_m, up);
  light.visible_side = (visibility(point_m, east) + visibility(point_m, -east) +
                        visibility(point_m, north) + visibility(point_m, -north)) /
                       4;
  light.visible_down = visibility(point_m, -up);
  return light;
}

MarchResult RayMarch::trace(const Ray& ray) const {
  // From far away a world position keeps few digits of a cell: begin at the first chart.
  double entry_m = kNoDistance_m;
  for (std::size_t v = 0; v < levels_.size(); ++v) {
    const ChartRay::Start start = chart_ray(levels_.info(v), ray)->start(kNoDistance_m);
    if (start.end_m > start.t_m) entry_m = std::min(entry_m, start.t_m);
  }
  if (planet_) {
    const PlanetModel::Interval air = planet_->in_air(ray);
    if (air.end_m > air.begin_m) entry_m = std::min(entry_m, air.begin_m);
  }
  if (entry_m >= kNoDistance_m) entry_m = 0;
  return Trace(*this, {ray.origin_m + entry_m * ray.direction, ray.direction}, entry_m).run();
}

}  // namespace nepho
