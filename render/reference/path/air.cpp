#include "reference/path/air.h"

#include <algorithm>
#include <cmath>

#include "air/air_lookup.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

// Tops of layers over which no profile changes by much more than e.
constexpr double kTops_m[] = {1e3, 2e3, 4e3, 7e3, 11e3, 16e3, 22e3, 30e3, 40e3, 55e3, 75e3};

}  // namespace

PathAir::PathAir(const Air& air, const Ellipsoid& body)
    : air_(air), radius_m_(body.equatorial_m), z_scale_(body.equatorial_m / body.polar_m) {
  for (const double top_m : kTops_m)
    if (top_m < air.top_m) layers_.push_back({top_m, glm::dvec3{0.0}});
  layers_.push_back({air.top_m, glm::dvec3{0.0}});
  double low_m = 0;
  for (Layer& layer : layers_) {
    // Geodetic heights are lower than scaled ones, by the flattening at most.
    const AirDensity low = air_density(air_, low_m * std::min(1.0, 1 / z_scale_));
    layer.most_per_m = low.rayleigh_per_m + low.aerosol_per_m / air.aerosol_albedo +
                       (layer.top_m * std::max(1.0, 1 / z_scale_) > air.ozone_low_m &&
                                low_m * std::min(1.0, 1 / z_scale_) < air.ozone_high_m
                            ? air.ozone_per_m
                            : glm::dvec3{0.0});
    low_m = layer.top_m;
  }
}

double PathAir::height_m(const Ray& ray, double t_m) const {
  const glm::dvec3 p = glm::dvec3{1, 1, z_scale_} * (ray.origin_m + t_m * ray.direction);
  const double r_m = glm::length(p);
  const double height_m =
      f64::geodetic_height(r_m - radius_m_, radius_m_, radius_m_ / z_scale_, p.z / r_m);
  return std::clamp(height_m, 0.0, air_.top_m);
}

template <class Visit>
void PathAir::follow(const Ray& ray, double t_max_m, int wavelength, Visit&& visit) const {
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 p = scale * ray.origin_m, d = scale * ray.direction;
  const double a = glm::dot(d, d), closest_m = -glm::dot(p, d) / a;
  const double miss_m = glm::length(p + closest_m * d);
  // Half the chord within a height, in distance along the ray; negative where it is missed.
  const auto half_m = [&](double height_m) {
    const double r_m = radius_m_ + height_m;
    return r_m > miss_m ? std::sqrt((r_m - miss_m) * (r_m + miss_m) / a) : -1.0;
  };
  const auto pass = [&](const Layer& layer, double t0_m, double t1_m) {
    t0_m = std::max(t0_m, 0.0), t1_m = std::min(t1_m, t_max_m);
    return !(t1_m > t0_m) || visit(t0_m, t1_m, layer.most_per_m[wavelength]);
  };
  double outer_m = half_m(layers_.back().top_m);
  if (outer_m < 0) return;
  std::array<double, std::size(kTops_m) + 2> halves{};  // of the layers' bottoms
  std::size_t lowest = layers_.size();
  for (std::size_t i = layers_.size(); i-- > 0;) {
    halves[i] = std::max(half_m(i == 0 ? 0 : layers_[i - 1].top_m), 0.0);
    if (!pass(layers_[i], closest_m - outer_m, closest_m - halves[i])) return;
    outer_m = halves[i];
    lowest = i;
    if (outer_m == 0) break;
  }
  // Under the ground there is none; what is above it on the other side is still the ray's.
  for (std::size_t i = lowest; i < layers_.size(); ++i) {
    const double end_m = half_m(layers_[i].top_m);
    if (!pass(layers_[i], closest_m + halves[i], closest_m + end_m)) return;
  }
}

PathAir::Collision PathAir::collide(const Ray& ray, double t_max_m, int wavelength,
                                    Random& random) const {
  Collision found;
  Trials trials(random);
  follow(ray, t_max_m, wavelength, [&](double t_m, double t1_m, double most_per_m) {
    while (trials.next(t_m, t1_m, most_per_m)) {
      const AirDensity density = air_density(air_, height_m(ray, t_m));
      double which = random.uniform() * most_per_m;
      if (which >= density.extinction_per_m[wavelength]) continue;
      found.t_m = t_m;
      found.event = Event::kAbsorbed;
      if (which < density.rayleigh_per_m[wavelength])
        found.event = Event::kRayleigh;
      else if (which < density.rayleigh_per_m[wavelength] + density.aerosol_per_m[wavelength])
        found.event = Event::kAerosol;
      return false;
    }
    return true;
  });
  return found;
}

double PathAir::transmittance(const Ray& ray, double t_max_m, int wavelength,
                              Random& random) const {
  double passed = 1;
  Trials trials(random);
  follow(ray, t_max_m, wavelength, [&](double t_m, double t1_m, double most_per_m) {
    while (trials.next(t_m, t1_m, most_per_m)) {
      passed *= 1 - air_density(air_, height_m(ray, t_m)).extinction_per_m[wavelength] / most_per_m;
      if (!(passed > 1e-9)) return false;
    }
    return true;
  });
  return std::max(passed, 0.0);
}

}  // namespace nepho
