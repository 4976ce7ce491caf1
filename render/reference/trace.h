#pragma once

#include <optional>
#include <vector>

#include "reference/air_march.h"
#include "reference/ray_march.h"
#include "reference/walk.h"

namespace nepho {

// One view ray of a RayMarch under way.
class RayMarch::Trace {
 public:
  // The ray begins `eye_m` from the eye.
  Trace(const RayMarch& march, const Ray& ray, double eye_m);
  MarchResult run();

 private:
  struct End {  // of a step
    double t_m = -1;
    Light light;
    AirKnot air;
  };
  // Phase functions towards the eye times a^n, of one volume: octave by octave.
  using Octaves = std::vector<glm::dvec3>;

  Octaves octaves(const std::vector<float>& table, double asymmetry, double one_minus_cos) const;
  void march_clouds(double last_m);
  bool present(std::size_t v, double t_m) const;
  void add_interval(double t0_m, double t1_m);
  End end_at(double t_m) const;
  double total_extinction_per_m(double t_m) const;
  double step_depth(double t0_m, double t1_m) const;
  glm::dvec3 air_depth(const End& first, const End& last) const;
  void add_air(double t_m);
  void add_step(const End& first, const End& last, int halvings);
  void add_looked_up(const End& first, const End& last, const glm::dvec3& s0, const glm::dvec3& s1,
                     int halvings);
  bool too_curved(double s0, double s1, double weight, double most) const;
  glm::dvec3 source(const End& end) const;
  Light light_of(std::size_t volume, const End& end) const;
  glm::dvec3 phases(std::size_t volume, const End& end, double tau_sun) const;
  void add_background(bool ground);
  void add_planet(double ground_m);
  double passed() const;

  const RayMarch& march_;
  Ray ray_;
  std::vector<Octaves> scattering_, ice_scattering_;  // [volume]
  std::vector<VolumeWalk> walks_;
  std::vector<char> active_;
  std::vector<std::size_t> volumes_;  // those with something in this interval
  std::optional<AirMarch> air_;       // where the planet has some
  double air_to_m_ = 0;               // accounted for, in front of it
  End last_;
  glm::dvec3 transmittance_{1.0};
  MarchResult result_;
};

}  // namespace nepho
