#include "reference/path/surroundings.h"

#include <algorithm>
#include <cmath>

#include "physics/physics_cpp.h"
#include "reference/path/sampling.h"

namespace nepho {
namespace {

constexpr double kMirrored = 0.5;  // of the paths that leave water

double cosine(const glm::dvec3& a, const glm::dvec3& b) {
  return std::clamp(glm::dot(a, b), 0.0, 1.0);
}

}  // namespace

Surroundings::Surroundings(const RenderRequest& request, double sun_radius_rad)
    : sky_(request.sky),
      up_(glm::normalize(request.sky.up)),
      to_sun_(glm::normalize(request.sun.to_sun)),
      irradiance_(request.sun.irradiance_W_per_m2_nm),
      sun_radius_rad_(sun_radius_rad) {
  const double half_sine = std::sin(0.5 * sun_radius_rad);
  one_minus_cos_radius_ = 2 * half_sine * half_sine;
  solid_angle_sr_ = 2 * f64::pi * one_minus_cos_radius_;
  if (!request.planet) {
    for (const RenderVolume& volume : request.volumes) ground_.add(*volume.source->info().chart);
    return;
  }
  look_ = request.planet->ground;
  slope_variance_ = f64::water_slope_variance(look_.wind_m_per_s);
  if (request.planet->air) beyond_ = f64::night_sky * irradiance_;
  surface_.emplace(request.planet->body, surface_of(request));
  sky_ = {};
}

glm::dvec3 Surroundings::to_sun(Random& random) const {
  if (beam()) return to_sun_;
  const double down = one_minus_cos_radius_ * random.uniform();
  return turned(to_sun_, {down, std::sqrt(down * (2 - down))}, random);
}

double Surroundings::sun_density(const glm::dvec3& direction) const {
  if (beam() || one_minus_cos(direction, to_sun_) > one_minus_cos_radius_) return 0;
  return 1 / solid_angle_sr_;
}

glm::dvec3 Surroundings::disc_W_per_m2_sr_nm(const glm::dvec3& direction) const {
  return sun_density(direction) * irradiance_;
}

double Surroundings::ground_m(const Ray& ray, bool from_it, double within_m) const {
  if (surface_) return surface_->distance_m(ray, from_it, within_m);
  const double ground_m = ground_.distance_m(ray);
  return ground_m <= within_m ? ground_m : kNoDistance_m;
}

bool Surroundings::ground_hides(const Ray& ray, bool from_it) const {
  return surface_ ? surface_->hides(ray, from_it) : ground_.distance_m(ray) < kNoDistance_m;
}

double Surroundings::sea_m(const Ray& ray) const {
  return surface_ ? surface_->sea_m(ray) : ground_.distance_m(ray);
}

glm::dvec3 Surroundings::background_W_per_m2_sr_nm(const glm::dvec3& direction, bool ground) const {
  if (surface_) return ground ? glm::dvec3{0.0} : beyond_;
  if (ground) return sky_.below_W_per_m2_sr_nm;
  glm::dvec3 radiance;
  for (int c = 0; c < 3; ++c)
    radiance[c] = f64::sky_radiance(glm::dot(direction, up_), sky_.zenith_W_per_m2_sr_nm[c],
                                    sky_.horizon_W_per_m2_sr_nm[c], sky_.below_W_per_m2_sr_nm[c]);
  return radiance;
}

Surroundings::Spot Surroundings::spot(const glm::dvec3& point_m) const {
  const PlanetSurface::Spot from = surface_->spot(point_m);
  Spot spot;
  spot.up = from.up;
  spot.normal = from.normal;
  spot.land = look_.land_albedo;
  spot.body = look_.water_albedo;
  spot.water = from.water;
  return spot;
}

glm::dvec3 Surroundings::reflect(const Spot& spot, const glm::dvec3& to_eye,
                                 const glm::dvec3& to_light) const {
  const double cos_light = glm::dot(spot.normal, to_light);
  if (!(cos_light > 0)) return glm::dvec3{0.0};
  const glm::dvec3 land = spot.land * (cos_light / f64::pi);
  if (!(spot.water > 0)) return land;
  const double mu = std::max(cosine(spot.up, to_eye), 1e-5), mu_light = cosine(spot.up, to_light);
  const glm::dvec3 half_way = glm::normalize(to_eye + to_light);
  const double passes = (1 - f64::water_mean_fresnel(mu, slope_variance_)) *
                        (1 - f64::water_mean_fresnel(mu_light, slope_variance_));
  const double glint = f64::water_glint(mu, mu_light, cosine(spot.up, half_way),
                                        cosine(half_way, to_light), slope_variance_);
  const glm::dvec3 water = spot.body * (passes * mu_light / f64::pi) + glint;
  return land + spot.water * (water - land);
}

Surroundings::Way Surroundings::sample(const Spot& spot, const glm::dvec3& to_eye,
                                       Random& random) const {
  Way way;
  if (random.uniform() < kMirrored * spot.water) {
    // A wave by its slope, and the mirror image in it.
    const double slope2 = slope_variance_ * random.depth(), cos_tilt = 1 / std::sqrt(1 + slope2);
    const double down = slope2 * cos_tilt * cos_tilt / (1 + cos_tilt);  // 1 - cos
    const glm::dvec3 wave = turned(spot.up, {down, std::sqrt(slope2) * cos_tilt}, random);
    way.direction = glm::normalize(2 * glm::dot(wave, to_eye) * wave - to_eye);
  } else {
    const double u = random.uniform();  // sin^2 of the angle from the normal
    const double cos_normal = std::sqrt(1 - u);
    way.direction = turned(spot.normal, {u / (1 + cos_normal), std::sqrt(u)}, random);
  }
  way.density = density(spot, to_eye, way.direction);
  return way;
}

double Surroundings::density(const Spot& spot, const glm::dvec3& to_eye,
                             const glm::dvec3& direction) const {
  const double mirrored = kMirrored * spot.water;
  double density = (1 - mirrored) * cosine(spot.normal, direction) / f64::pi;
  const glm::dvec3 half_way = glm::normalize(to_eye + direction);
  const double tilt = glm::dot(spot.up, half_way), turn = glm::dot(half_way, to_eye);
  if (mirrored > 0 && tilt > 1e-3 && turn > 0)
    density += mirrored * f64::water_slope_density(tilt, slope_variance_) /
               (4 * tilt * tilt * tilt * turn);
  return density;
}

}  // namespace nepho
