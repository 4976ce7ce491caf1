#pragma once

#include <array>
#include <memory>
#include <vector>

#include "air/air_lookup.h"
#include "reference/chart_ray.h"
#include "reference/level_set.h"
#include "renderer.h"
#include "tree/light_tiles.h"

namespace nepho {

class PlanetModel;

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
// and is `below` to the eye. What of a volume is ice has a phase function of its own, weighted by
// its part of k.
//
// With a planet, air stands between and before the clouds (air_march.h), whose shadow on it is
// marched from each place; E0 is what the air leaves of the sun, the sky's light that of the air's
// tables, `up` the place's own; the ground shines as its own marches light it (planet_model.h).
struct MarchSettings {
  double source_tolerance = 1e-4;
  double least_transmittance = 1e-6;  // the ray ends there
  // Light of a picture's own tiles rather than marched from each place: what is left of the
  // difference is how the view ray is integrated. The levels are then the cut that these are of.
  std::shared_ptr<const LightTiles> lights = nullptr;
  // Every piece (a cell) is halved as often, whatever the estimate says of its ends: a source that
  // is the same at both and another between them is not seen by it.
  int least_halvings = 0;
};

struct MarchResult {
  glm::dvec3 radiance_W_per_m2_sr_nm{0.0};
  glm::dvec3 scattered_W_per_m2_sr_nm{0.0};  // the clouds' part
  double optical_depth = 0;                  // of clouds, as far as the ray went
};

// Unit rows: up, and two level directions, as the renderer's. Sky light comes from +-each.
std::array<glm::dvec3, 3> sky_axes(const glm::dvec3& up);

// The rays of a picture's pixels; row 0 is at the top.
class CameraRays {
 public:
  CameraRays(const Camera& camera, int width, int height);
  Ray ray(int x, int y) const;

 private:
  glm::dvec3 eye_m_, forward_, right_{0.0}, up_{0.0};
  int width_, height_;
};
// Through the middle of a pixel; row 0 is at the top.
Ray camera_ray(const Camera& camera, int width, int height, int x, int y);

// Thread-safe; `levels` outlives it and holds the request's volumes. `planet`: the request's, for
// marches that share it; null: made here.
class RayMarch {
 public:
  static constexpr double kOpaque = 1e4;

  RayMarch(const LevelSet& levels, const RenderRequest& request, MarchSettings settings = {},
           std::shared_ptr<const PlanetModel> planet = nullptr);

  // Through all volumes, to t_max, the ground (the ellipsoid), the end of all charts, or where it
  // is above `most`; infinite along a level ray in a periodic layer.
  double optical_depth(const Ray& ray, double t_max_m = kNoDistance_m, double most = kOpaque) const;
  MarchResult trace(const Ray& ray) const;

 private:
  struct Light {
    double tau_sun = 0, sun_part = 1, visible_up = 1, visible_side = 1, visible_down = 1;
    glm::dvec3 sun_W_per_m2_nm{0.0};  // across its beam, without clouds
    SkyLight sky;                     // W m-2 sr-1 nm-1
  };
  struct Look {                                       // of a volume
    std::vector<float> phase_table, ice_phase_table;  // the second empty: it tells no ice apart
    double asymmetry = 0, ice_asymmetry = 0;
  };
  class Trace;

  Light unshadowed(const glm::dvec3& point_m) const;
  Light light_at(const glm::dvec3& point_m) const;
  double visibility(const glm::dvec3& point_m, const glm::dvec3& direction) const;
  double sun_passed(const glm::dvec3& point_m) const;  // what clouds let through of its beam

  const LevelSet& levels_;
  const RenderRequest request_;
  MarchSettings settings_;
  Ground ground_;
  bool sky_lights_ = false;
  int octaves_ = 1;
  std::array<glm::dvec3, 3> sky_axes_;
  std::vector<Look> looks_;
  std::shared_ptr<const PlanetModel> planet_;  // null: none
  double cloud_top_m_ = -kNoDistance_m;
};

}  // namespace nepho
