#pragma once

#include <array>
#include <vector>

#include "bricks/shell_chart.h"
#include "reference/chart_ray.h"
#include "reference/path/random.h"
#include "scene/scene.h"

namespace nepho {

// Clear air over a planet, for null-collision tracking at one wavelength (0, 1, 2: 650, 550, 450
// nm): the profiles themselves, no table. Bounds of extinction are those of layers of height, which
// a ray meets at most twice each. Heights are those of scaled space, made geodetic, as everywhere.
class PathAir {
 public:
  PathAir(const Air& air, const Ellipsoid& body);

  enum class Event : std::uint8_t { kNone, kRayleigh, kAerosol, kAbsorbed };
  struct Collision {
    double t_m = kNoDistance_m;
    Event event = Event::kNone;
  };
  Collision collide(const Ray& ray, double t_max_m, int wavelength, Random& random) const;
  // An unbiased estimate, in [0, 1].
  double transmittance(const Ray& ray, double t_max_m, int wavelength, Random& random) const;
  double aerosol_asymmetry() const { return air_.aerosol_asymmetry; }

 private:
  struct Layer {
    double top_m = 0;
    glm::dvec3 most_per_m{0.0};
  };
  double height_m(const Ray& ray, double t_m) const;
  // visit(t0_m, t1_m, bound) in the order of the ray; returns whether to go on.
  template <class Visit>
  void follow(const Ray& ray, double t_max_m, int wavelength, Visit&& visit) const;

  Air air_;
  double radius_m_, z_scale_;
  std::vector<Layer> layers_;  // from the ground up
};

}  // namespace nepho
