#pragma once

#include <optional>
#include <vector>

#include "reference/path/air.h"
#include "reference/path/medium.h"
#include "reference/path/sampling.h"
#include "reference/path/surroundings.h"
#include "renderer.h"

namespace nepho {

// The truth that pictures are compared with: the radiative transfer equation by Monte Carlo, in
// double, over the bricks of a forest, with the scene's own phase functions, albedos, sun, sky and
// ground. No bounce is too many: paths end by absorption (roulette with the true albedo) or where
// they leave. What is left out: polarisation, refraction, the change of wavelength.
//
// From the eye: null collisions (medium.h); at each scattering the sun's disc by next-event
// estimation and by the phase function, weighed by the power heuristic (Veach and Guibas 1995,
// doi:10.1145/218380.218498); the sky by the phase function alone. Droplets have a forward peak of
// 570 per sr, and a path that came to run towards the sun by chance would be a spike: some
// scatterings send out a second path that starts in the peak around the sun, and both are weighed
// by the sum of their densities, so that whatever runs there is one of many, and light (after the
// directional importance sampling of Buras and Mayer 2011, doi:10.1016/j.jqsrt.2010.10.005). Where
// phase functions depend on the wavelength, the three share a path as one mixture of densities
// (hero wavelengths; Wilkie et al. 2014, doi:10.1111/cgf.12419), bounded by 3; in air each path has
// one wavelength.
struct PathSettings {
  // Of the sun's disc. 0: a beam, for tests against plane-parallel truth.
  double sun_radius_rad = 0.004675;
  // "Smoothed late orders": scatterings of a path that keep a tabled phase function, later ones are
  // Henyey-Greenstein's of the same asymmetry; -1: all keep it, which is the equation. Less noise;
  // but a Mie slab of optical depth 8 is 10 % too bright at 60 degrees with 2.
  int exact_orders = -1;
};

struct PathSample {
  glm::dvec3 radiance_W_per_m2_sr_nm{0.0};
  int scatterings = 0;
};

class PathTracer {
 public:
  // `forest` and the request's sources outlive this. Throws Error where the scene has what it
  // cannot trace.
  PathTracer(const Forest& forest, const RenderRequest& request, PathSettings settings = {});

  // One path along a ray from the eye.
  PathSample sample(const Ray& ray, Random& random) const;

  // For histories that begin at a light: the direction after a collision, at one wavelength.
  const PathMedium& medium() const { return medium_; }
  glm::dvec3 scattered(const PathMedium::Collision& collision, const glm::dvec3& direction,
                       int wavelength, Random& random) const;
  double co_albedo(const PathMedium::Collision& collision, int wavelength) const {
    return co_albedos_[std::size_t(collision.volume)][wavelength];
  }

 private:
  struct Path;
  double passed(const Path& path, const Ray& ray) const;
  // The next scattering, at which the path then stands; null: none, the path is out of the clouds
  // and the air, before the ground at ground_m, or absorbed.
  const PhaseSampler* next_scattering(Path& path, double& ground_m) const;
  const PhaseSampler& phase(const PathMedium::Collision& collision) const;
  const PhaseSampler& smooth_phase(const PathMedium::Collision& collision) const;
  void light_at_collision(Path& path, const PhaseSampler& phase) const;
  void follow(Path& path) const;
  bool branches(const Path& path) const;
  void scatter(Path& path, const PhaseSampler& phase) const;
  void turn(Path& path, const PhaseSampler& phase, const glm::dvec3& direction,
            double one_minus_cos) const;
  bool meet_ground(Path& path, double ground_m) const;
  void leave(Path& path, bool ground) const;

  PathMedium medium_;
  std::optional<PathAir> air_;
  PhaseSampler molecules_ = PhaseSampler::rayleigh();
  PhaseSampler aerosol_ = PhaseSampler::cornette_shanks(0);
  Surroundings around_;
  std::vector<PhaseSampler> phases_, ice_phases_, smooth_phases_, smooth_ice_phases_;
  const PhaseSampler* peak_ = nullptr;  // of the first volume that has one, if the sun shines
  int exact_orders_;
  std::vector<glm::dvec3> co_albedos_;
  bool grey_ = true;  // no phase function depends on the wavelength
};

}  // namespace nepho
