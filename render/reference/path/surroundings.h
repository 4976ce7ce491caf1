#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "reference/chart_ray.h"
#include "reference/path/random.h"
#include "reference/surface.h"
#include "renderer.h"

namespace nepho {

// What is around the clouds, for a path tracer: the sun's disc, the sky, the ground.
class Surroundings {
 public:
  // Throws Error for what is not there yet: air.
  Surroundings(const RenderRequest& request, double sun_radius_rad);

  // A direction to the sun: of its disc, evenly; of the beam, the one.
  glm::dvec3 to_sun(Random& random) const;
  const glm::dvec3& sun_centre() const { return to_sun_; }
  bool beam() const { return !(sun_radius_rad_ > 0); }
  // Density of to_sun(), 1/sr; 0 outside the disc, and for a beam.
  double sun_density(const glm::dvec3& direction) const;
  glm::dvec3 sun_W_per_m2_nm() const { return irradiance_; }
  // Of the disc, seen in one of its directions.
  glm::dvec3 disc_W_per_m2_sr_nm(const glm::dvec3& direction) const;

  // Where a ray meets the ground, or kNoDistance_m where that is beyond `within_m`; `from_it`:
  // other than where it starts.
  double ground_m(const Ray& ray, bool from_it, double within_m) const;
  // Whether it does.
  bool ground_hides(const Ray& ray, bool from_it = false) const;
  // Where the ground is met at the latest, if it is at all: what stands on it may be met before.
  double sea_m(const Ray& ray) const;
  // Whether it scatters; otherwise `below` is seen there.
  bool ground_scatters() const { return surface_.has_value(); }
  // What is seen without anything in front; the sun's disc is not in it.
  glm::dvec3 background_W_per_m2_sr_nm(const glm::dvec3& direction, bool ground) const;
  // Whether the eye sees the disc itself: over a planet.
  bool shows_sun() const { return surface_.has_value(); }

  // The ground at a point, as a scatterer of light.
  struct Spot {
    glm::dvec3 up, normal;
    glm::dvec3 land{0.0}, body{0.0};  // albedos
    double water = 0;                 // part
  };
  Spot spot(const glm::dvec3& point_m) const;
  // Reflectance distribution times the cosine to the light, per sr: by colour.
  glm::dvec3 reflect(const Spot& spot, const glm::dvec3& to_eye, const glm::dvec3& to_light) const;
  // A direction for the path to go on, and its density (1/sr).
  struct Way {
    glm::dvec3 direction;
    double density;
  };
  Way sample(const Spot& spot, const glm::dvec3& to_eye, Random& random) const;
  double density(const Spot& spot, const glm::dvec3& to_eye, const glm::dvec3& direction) const;

 private:
  Ground ground_;  // without a planet
  std::optional<PlanetSurface> surface_;
  GroundLook look_;
  double slope_variance_ = 0;
  Sky sky_;
  glm::dvec3 up_, to_sun_, irradiance_;
  glm::dvec3 beyond_{0.0};  // over a planet with air: the night sky
  double sun_radius_rad_, one_minus_cos_radius_, solid_angle_sr_ = 0;
};

}  // namespace nepho
