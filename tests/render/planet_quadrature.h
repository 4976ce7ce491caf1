#pragma once

#include <functional>
#include <optional>

#include "air/air_lookup.h"
#include "physics/physics_cpp.h"
#include "planet_scenes.h"

namespace nepho::test {

// The same equations along one ray, in double, with thousands of steps; no cloud but shadows.
class Quadrature {
 public:
  explicit Quadrature(const RenderRequest& request)
      : request_(request),
        air_(*request.planet->air),
        tables_(make_air_tables(air_, kRadius_m, request.planet->ground.water_albedo)),
        lookup_(air_, kRadius_m, tables_) {}

  // Part of the sun's beam that reaches a place.
  std::function<double(glm::dvec3)> lit = [](glm::dvec3) { return 1.0; };
  int steps = 3000;

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    const glm::dvec3 eye = request_.camera.eye_m;
    const double r = glm::length(eye), mu = glm::dot(eye, direction) / r,
                 top = kRadius_m + air_.top_m;
    const auto roots = [&](double sphere, double& near, double& far) {
      const double discriminant = r * r * mu * mu - (r - sphere) * (r + sphere);
      if (discriminant < 0) return false;
      near = -r * mu - std::sqrt(discriminant);
      far = -r * mu + std::sqrt(discriminant);
      return far > 0;
    };
    double begin = 0, end = 0, ground = 0, behind = 0;
    if (!roots(top, begin, end)) return night();
    begin = std::max(begin, 0.0);
    const bool hits = roots(kRadius_m, ground, behind) && ground > 0;
    if (hits) end = ground;
    const glm::dvec3 to_sun = request_.sun.to_sun;
    const double one_minus_cos = 1 - glm::dot(to_sun, direction);
    const double rayleigh = f64::rayleigh_phase(one_minus_cos);
    const double aerosol = f64::cornette_shanks_phase(one_minus_cos, air_.aerosol_asymmetry);
    glm::dvec3 sum(0.0), depth(0.0);
    for (int i = 0; i < steps; ++i) {
      // Dense at both ends.
      const auto at = [&](double u) { return begin + (end - begin) * u * u * (3 - 2 * u); };
      const double t0 = at(double(i) / steps), t1 = at(double(i + 1) / steps), t = (t0 + t1) / 2;
      const glm::dvec3 p = eye + t * direction;
      const double h = glm::length(p) - kRadius_m, m = glm::dot(p, direction) / glm::length(p);
      const double mu_sun = glm::dot(p, to_sun) / glm::length(p);
      const AirDensity density = air_density(air_, h);
      const AirLight light = lookup_.light(h, mu_sun);
      const glm::dvec3 sun = lit(p) * sun_in_air(h, mu_sun);
      const glm::dvec3 step = (t1 - t0) * density.extinction_per_m;
      for (int c = 0; c < 3; ++c) {
        const double e0 = request_.sun.irradiance_W_per_m2_nm[c];
        sum[c] +=
            std::exp(-depth[c] - step[c] / 2) * (t1 - t0) *
            f64::air_emission(density.rayleigh_per_m[c], density.aerosol_per_m[c], sun[c], rayleigh,
                              aerosol, e0 * light.multiple[c], e0 * light.multiple_p2[c], m);
      }
      depth += step;
    }
    return sum + glm::exp(-depth) * (hits ? sea(eye + end * direction, direction) : night());
  }

 private:
  glm::dvec3 night() const { return f64::night_sky * request_.sun.irradiance_W_per_m2_nm; }

  glm::dvec3 sun_in_air(double height_m, double mu_sun) const {
    const double part = f64::sun_above_horizon(kRadius_m, height_m, mu_sun);
    if (part <= 0) return glm::dvec3(0.0);
    const double h = std::max(height_m, 0.0);
    const double horizon = -std::sqrt(h * (2 * kRadius_m + h)) / (kRadius_m + h);
    const glm::dvec3 depth = lookup_.depth(height_m, std::max(mu_sun, horizon));
    return part * request_.sun.irradiance_W_per_m2_nm * glm::exp(-depth);
  }

  glm::dvec3 sea(const glm::dvec3& p, const glm::dvec3& direction) const {
    const glm::dvec3 up = glm::normalize(p), to_sun = request_.sun.to_sun;
    const glm::dvec3 half_way = glm::normalize(to_sun - direction);
    const double mu_sun = glm::dot(up, to_sun);
    const SkyLight sky = lookup_.sky(0, mu_sun);
    const glm::dvec3 sun = lit(p) * sun_in_air(0, mu_sun);
    const double waves = f64::water_slope_variance(request_.planet->ground.wind_m_per_s);
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) {
      const double e0 = request_.sun.irradiance_W_per_m2_nm[c];
      result[c] = f64::water_radiance(
          request_.planet->ground.water_albedo[c], sun[c], std::max(-glm::dot(up, direction), 1e-5),
          std::max(mu_sun, 0.0), glm::dot(up, half_way), glm::dot(half_way, to_sun), waves,
          e0 * sky.up[c], e0 * sky.low[c]);
    }
    return result;
  }

  const RenderRequest& request_;
  const Air air_;
  AirTables tables_;
  AirLookup lookup_;
};

// Most of what is seen is air in the shadow of a deck, against the dark ground behind. The shadow
// is known in closed form. Stays where it is made: its parts point at each other.
struct ShadedDeck {
  static constexpr double kExtinction_per_m = 0.05;
  Slab slab{8000, 9000, 20e3, kExtinction_per_m};
  RenderRequest request;
  std::optional<Quadrature> truth, unshaded;

  ShadedDeck(int width, int height) : request(planet_request({&slab.source})) {
    request.settings.width = width;
    request.settings.height = height;
    request.sun.to_sun = sun_at(50, 120);
    look(request, 2, 9, 6);
    truth.emplace(request);
    unshaded.emplace(request);
    truth->steps = 20000;
    truth->lit = [this](const glm::dvec3& p) {
      return std::exp(-kExtinction_per_m * slab.shade_m(p, request.sun.to_sun));
    };
  }
  ShadedDeck(const ShadedDeck&) = delete;
  ShadedDeck& operator=(const ShadedDeck&) = delete;
};

}  // namespace nepho::test
