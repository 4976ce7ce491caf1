#include "reference/planet_model.h"

#include <algorithm>
#include <cmath>

#include "optics/phase_table.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr double kSunRadius_rad = 0.004675;
constexpr double kOffGround_m = 0.05;  // where the ground's own rays begin

}  // namespace

PlanetModel::PlanetModel(const RenderRequest& request, std::shared_ptr<const AirTables> tables)
    : air_(request.planet->air),
      look_(request.planet->ground),
      radius_m_(request.planet->body.equatorial_m),
      z_scale_(radius_m_ / request.planet->body.polar_m),
      pixel_rad_(2 * std::tan(0.5 * request.camera.vertical_fov_rad) / request.settings.height),
      slope_variance_(f64::water_slope_variance(look_.wind_m_per_s)),
      to_sun_(glm::normalize(request.sun.to_sun)),
      to_sun_scaled_(glm::normalize(glm::dvec3{1, 1, z_scale_} * to_sun_)),
      irradiance_(request.sun.irradiance_W_per_m2_nm),
      tables_(std::move(tables)),
      surface_(request.planet->body, surface_of(request)) {
  if (!request.volumes.empty())
    cloud_asymmetry_ = phase_bulk(request.volumes[0].phase).asymmetry[1];
  if (!air_) return;
  if (!tables_)
    tables_ = std::make_shared<const AirTables>(
        make_air_tables(*air_, radius_m_, mean_ground_albedo(request)));
  lookup_.emplace(*air_, radius_m_, *tables_);
}

PlanetModel::Place PlanetModel::place(const glm::dvec3& point_m) const {
  const glm::dvec3 p = glm::dvec3{1, 1, z_scale_} * point_m;
  const double r_m = glm::length(p);
  const double polar_m = radius_m_ / z_scale_;
  return {f64::geodetic_height(r_m - radius_m_, radius_m_, polar_m, p.z / r_m),
          glm::dot(p, to_sun_scaled_) / r_m};
}

double PlanetModel::mu(const glm::dvec3& point_m, const glm::dvec3& direction) const {
  const glm::dvec3 scale{1, 1, z_scale_};
  return glm::dot(glm::normalize(scale * point_m), glm::normalize(scale * direction));
}

PlanetModel::Interval PlanetModel::in_air(const Ray& ray) const {
  if (!air_) return {0, 0};
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 p = scale * ray.origin_m, d = scale * ray.direction;
  // About the point next to the centre: what is left of a far eye's distance is exact there.
  const double a = glm::dot(d, d), closest_m = -glm::dot(p, d) / a;
  const double miss_m = glm::length(p + closest_m * d), top_m = radius_m_ + air_->top_m;
  if (miss_m >= top_m) return {0, 0};
  const double half_m = std::sqrt((top_m - miss_m) * (top_m + miss_m) / a);
  return {std::max(closest_m - half_m, 0.0), closest_m + half_m};
}

double PlanetModel::lowest_towards_sun_m(const Place& place) const {
  if (place.mu_sun >= 0) return place.height_m;
  const double level = std::sqrt(std::max(0.0, (1 - place.mu_sun) * (1 + place.mu_sun)));
  return (radius_m_ + place.height_m) * level - radius_m_;
}

glm::dvec3 PlanetModel::sun_W_per_m2_nm(const Place& place) const {
  const double part = f64::sun_above_horizon(radius_m_, place.height_m, place.mu_sun);
  if (!(part > 0)) return glm::dvec3{0.0};
  if (!air_ || place.height_m > air_->top_m) return part * irradiance_;
  // What is seen of a disc whose middle is below the horizon is at the horizon.
  const double h_m = std::max(place.height_m, 0.0);
  const double horizon = -std::sqrt(h_m * (2 * radius_m_ + h_m)) / (radius_m_ + h_m);
  return part * irradiance_ * glm::exp(-lookup_->depth(h_m, std::max(place.mu_sun, horizon)));
}

AirLight PlanetModel::air_light(const Place& place) const {
  if (!air_) return {};
  const AirLight light = lookup_->light(place.height_m, place.mu_sun);
  return {irradiance_ * light.multiple, irradiance_ * light.multiple_p2};
}

SkyLight PlanetModel::sky_light(const Place& place) const {
  if (!air_) return {};
  const SkyLight sky = lookup_->sky(place.height_m, place.mu_sun);
  return {irradiance_ * sky.up, irradiance_ * sky.side, irradiance_ * sky.down,
          irradiance_ * sky.low};
}

bool PlanetModel::hill_hides_sun(const glm::dvec3& point_m, const PlanetSurface::Spot& spot) const {
  const glm::dvec3 start_m =
      point_m + kOffGround_m * spot.up + 0.02 * surface_.cell_m() * spot.normal;
  return surface_.hides({start_m, to_sun_});
}

glm::dvec3 PlanetModel::ground_W_per_m2_sr_nm(const Ray& ray, double t_m,
                                              const CloudDepth& depth) const {
  const glm::dvec3 point_m = ray.origin_m + t_m * ray.direction, to_eye = -ray.direction;
  const PlanetSurface::Spot spot = surface_.spot(point_m);
  const Place place{spot.height_m, this->place(point_m).mu_sun};
  const glm::dvec3 sun = sun_W_per_m2_nm(place);
  const bool day = sun.r + sun.g + sun.b > 0;
  const glm::dvec3 start_m = point_m + kOffGround_m * spot.up;
  const double tau_above = depth({start_m, spot.up}), tau_sun = day ? depth({start_m, to_sun_}) : 0;
  double cos_sun = glm::dot(spot.normal, to_sun_);
  if (surface_.terrain() && day && cos_sun > 0 && hill_hides_sun(point_m, spot)) cos_sun = -1;

  const double g = cloud_asymmetry_, mu_sun = std::max(glm::dot(spot.up, to_sun_), 0.0);
  const double sky_part = f64::cloud_daylight(2 * tau_above, tau_above, 0.5, g);
#if defined(NEPHO_MUTANT_REFERENCE_NO_GROUND_SHADOW)
  const double direct = 1;
#else
  const double direct = std::exp(-tau_sun);
#endif
  const double scattered =
      std::max(f64::cloud_daylight(tau_sun, tau_above, mu_sun, g) - direct, 0.0);
  const SkyLight sky = sky_light(place);
  const glm::dvec3 under = scattered * mu_sun / f64::pi * sun, up = sky_part * sky.up + under,
                   low = sky_part * sky.low + under;
  const glm::dvec3 half_way = glm::normalize(to_eye + to_sun_);
  const double mu = std::max(glm::dot(spot.up, to_eye), 1e-5);
  glm::dvec3 radiance;
  for (int c = 0; c < 3; ++c) {
    const double land =
        f64::land_radiance(look_.land_albedo[c], direct * sun[c], cos_sun, up[c], low[c]);
    const double water =
        f64::water_radiance(look_.water_albedo[c], direct * sun[c], mu, std::max(cos_sun, 0.0),
                            glm::dot(spot.up, half_way), glm::dot(half_way, to_sun_),
                            slope_variance_, up[c], low[c]) +
        f64::water_mirror_excess(mu, slope_variance_, up[c], low[c], sky.up[c], sky.low[c]);
    radiance[c] = land + spot.water * (water - land);
  }
  return radiance;
}

double PlanetModel::sun_disc(const glm::dvec3& direction) const {
  const glm::dvec3 apart = to_sun_ - direction;
  const double angle = 2 * std::asin(std::min(0.5 * glm::length(apart), 1.0));
  const double width = std::max(pixel_rad_, 1e-5);
  const double part = std::clamp((kSunRadius_rad - angle) / width + 0.5, 0.0, 1.0);
  const double solid_angle = f64::pi * kSunRadius_rad * kSunRadius_rad;
  // A pixel wider than the disc holds no more light than the disc.
  return part * std::min(1.0, solid_angle / (width * width)) / solid_angle;
}

glm::dvec3 PlanetModel::beyond_W_per_m2_sr_nm(const glm::dvec3& direction) const {
  return (sun_disc(direction) + (air_ ? f64::night_sky : 0)) * irradiance_;
}

bool PlanetModel::sees_sun(const glm::dvec3& direction) const {
  // A chord is no longer than its arc: most pixels are told by it.
  const glm::dvec3 apart = to_sun_ - direction;
  const double most = kSunRadius_rad + std::max(pixel_rad_, 1e-5);
  if (glm::dot(apart, apart) > most * most) return false;
  return sun_disc(direction) > 0;
}

std::array<glm::dvec3, 3> planet_sky_axes(const glm::dvec3& point_m, double z_scale) {
  const glm::dvec3 scale{1, 1, z_scale};
  const glm::dvec3 up =
      glm::normalize(glm::normalize(scale * scale * point_m) + glm::dvec3{0.0011, 0.0007, 0.0013});
  const glm::dvec3 east = glm::normalize(std::abs(up.x) < 0.6 ? glm::dvec3{0, up.z, -up.y}
                                                              : glm::dvec3{-up.z, 0, up.x});
  return {up, east, glm::cross(up, east)};
}

}  // namespace nepho
