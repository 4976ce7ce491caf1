#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "air/air_lookup.h"
#include "reference/surface.h"

namespace nepho {

// What a request's planet does to light, in double, by the equations of render/physics and the
// tables of render/air (which both marches share): air, sky light, ground, and what lies beyond.
// Clouds are the caller's. Heights and zenith angles are those of scaled space. Thread-safe.
class PlanetModel {
 public:
  struct Place {
    double height_m, mu_sun;
  };
  struct Interval {
    double begin_m, end_m;  // empty if end <= begin
  };
  using CloudDepth = std::function<double(const Ray&)>;

  // request.planet is set; the sources of its volumes outlive this. `tables`: those of its air, or
  // null: made here, 0.2 CPU s.
  PlanetModel(const RenderRequest& request, std::shared_ptr<const AirTables> tables);

  bool has_air() const { return air_.has_value(); }
  const Air& air() const { return *air_; }
  const PlanetSurface& surface() const { return surface_; }
  const glm::dvec3& to_sun() const { return to_sun_; }
  double radius_m() const { return radius_m_; }
  double z_scale() const { return z_scale_; }

  Place place(const glm::dvec3& point_m) const;
  // Cosine of a ray's zenith angle.
  double mu(const glm::dvec3& point_m, const glm::dvec3& direction) const;
  // Metres of scaled space per metre along a direction.
  double stretch(const glm::dvec3& direction) const {
    return glm::length(glm::dvec3{1, 1, z_scale_} * direction);
  }
  // Where a ray is in the air; nowhere without one.
  Interval in_air(const Ray& ray) const;
  // The lowest that the way from here to the sun comes to, m of height.
  double lowest_towards_sun_m(const Place& place) const;

  // Irradiance across the sun's beam, through the air and over the horizon, without clouds.
  glm::dvec3 sun_W_per_m2_nm(const Place& place) const;
  // What the tables say, times the sun's irradiance. Zero without air.
  AirLight air_light(const Place& place) const;
  SkyLight sky_light(const Place& place) const;

  // Radiance of the ground towards the eye, where the ray meets it at t_m.
  glm::dvec3 ground_W_per_m2_sr_nm(const Ray& ray, double t_m, const CloudDepth& depth) const;
  // From beyond the air: the night sky, and the sun's disc as a pixel sees it.
  glm::dvec3 beyond_W_per_m2_sr_nm(const glm::dvec3& direction) const;
  bool sees_sun(const glm::dvec3& direction) const;  // some of the disc, in a pixel

 private:
  double sun_disc(const glm::dvec3& direction) const;
  bool hill_hides_sun(const glm::dvec3& point_m, const PlanetSurface::Spot& spot) const;

  std::optional<Air> air_;
  GroundLook look_;
  double radius_m_, z_scale_, pixel_rad_, slope_variance_, cloud_asymmetry_ = 0.85;
  glm::dvec3 to_sun_, to_sun_scaled_, irradiance_;
  std::shared_ptr<const AirTables> tables_;
  std::optional<AirLookup> lookup_;
  PlanetSurface surface_;
};

// Up of a place, and two level directions: those in which the renderer asks for sky light there.
std::array<glm::dvec3, 3> planet_sky_axes(const glm::dvec3& point_m, double z_scale);

}  // namespace nepho
