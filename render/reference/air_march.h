#pragma once

#include <functional>
#include <vector>

#include "reference/planet_model.h"

namespace nepho {

// Clear air along one view ray: extinction, and light scattered towards the eye.
struct AirKnot {
  glm::dvec3 extinction_per_m{0.0};
  glm::dvec3 sunlit{0.0}, other{0.0};  // W m-3 sr-1 nm-1: of the sun's own light, and all other
};

class AirMarch {
 public:
  // Part of the sun's beam that clouds let through to a point.
  using Lit = std::function<double(const glm::dvec3& point_m)>;

  // `eye_m`: the eye's distance from the ray's origin; shadows below `shadows_m` of height are
  // looked for at every tenth of the distance to it, and every 250 m next to it. Intervals are
  // halved while two halves differ from the whole by more than `tolerance` of what the ray has
  // collected.
  AirMarch(const PlanetModel& planet, const Ray& ray, double eye_m, double shadows_m, Lit lit,
           double tolerance);

  AirKnot knot(double t_m) const;
  glm::dvec3 extinction_per_m(double t_m) const;
  // Air alone between two distances.
  void add(double begin_m, double end_m, glm::dvec3& radiance, glm::dvec3& transmittance) const;

 private:
  struct Node {
    double t_m;
    AirKnot knot;
    PlanetModel::Place place;
    double lit = 1;
    glm::dvec3 emission() const { return lit * knot.sunlit + knot.other; }
  };
  struct Panel {
    glm::dvec3 radiance, transmittance;
  };
  struct Sum;
  Node node(double t_m) const;
  static Panel panel(const Node& a, const Node& m, const Node& b);
  std::vector<double> cuts(double begin_m, double end_m) const;
  void refine(const Node& a, const Node& m, const Node& b, int halvings, Sum& sum) const;

  const PlanetModel& planet_;
  Ray ray_;
  double eye_m_, shadows_m_, tolerance_, rayleigh_ = 0, aerosol_ = 0;
  PlanetModel::Interval inside_;
  Lit lit_;
};

}  // namespace nepho
