#pragma once

#include <array>
#include <vector>

#include "reference/chart_ray.h"
#include "reference/level_set.h"
#include "renderer.h"

namespace nepho {

// The renderer's transport and light model in double precision on the CPU, without its
// approximations: cell-exact optical depth (lattice.md 5: Simpson per cell, exact in a box; the
// sub-step rule in a shell), and every light sample by its own march to the sun and the sky.
//
// Per volume with extinction k and albedo w, source per unit of optical depth
//   S = w (E0 sum_n a^n p_n(theta) exp(-b^n tau_sun) + sky_source(visible up, side, down))
// through all volumes, p_0 the table's phase function, p_n = HG(g c^n); together sum k S / sum k.
// A step of optical depth x adds T x (S0 e0(x) + (S1 - S0) w1(x)), and is halved while the
// estimated error of the linear source, T (1 - e^-x) |dS| |d ln S| / 8, is above `source_tolerance`
// of the pixel's radiance. The ground is the ellipsoid under a shell: it hides the sun,
// and is `below` to the eye.
struct MarchSettings {
  double source_tolerance = 1e-4;
  double least_transmittance = 1e-6;  // the ray ends there
};

struct MarchResult {
  glm::dvec3 radiance_W_per_m2_sr_nm{0.0};
  glm::dvec3 scattered_W_per_m2_sr_nm{0.0};  // the part that is not background
  double optical_depth = 0;                  // as far as the ray went
};

// Unit rows: up, and two level directions, as the renderer's. Sky light comes from +-each.
std::array<glm::dvec3, 3> sky_axes(const glm::dvec3& up);

// Through the middle of a pixel; row 0 is at the top.
Ray camera_ray(const Camera& camera, int width, int height, int x, int y);

// Thread-safe; `levels` outlives it and holds the request's volumes.
class RayMarch {
 public:
  RayMarch(const LevelSet& levels, const RenderRequest& request, MarchSettings settings = {});

  // Through all volumes, to t_max, the ground or the end of all charts; infinite along a level ray
  // in a periodic layer.
  double optical_depth(const Ray& ray, double t_max_m = kNoDistance_m) const;
  MarchResult trace(const Ray& ray) const;

 private:
  struct Light {
    double tau_sun = 0, sun_part = 1, visible_up = 1, visible_side = 1, visible_down = 1;
  };
  struct Lamp;  // what is constant along one ray
  class Trace;

  Light light_at(const glm::dvec3& point_m) const;
  double visibility(const glm::dvec3& point_m, const glm::dvec3& direction) const;

  const LevelSet& levels_;
  const RenderRequest request_;
  MarchSettings settings_;
  Ground ground_;
  bool sky_lights_ = false;
  int octaves_ = 1;
  std::array<glm::dvec3, 3> sky_axes_;
  std::vector<std::vector<float>> phase_tables_;
  std::vector<double> asymmetry_;
};

}  // namespace nepho
