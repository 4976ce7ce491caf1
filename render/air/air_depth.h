#pragma once

#include <vector>

#include "scene/scene.h"

namespace nepho {

// air_optical_depth for many rays: what depends on the air alone is made once. Thread-safe.
class AirDepth {
 public:
  AirDepth(const Air& air, double radius_m);
  glm::dvec3 operator()(double height_m, double mu, double length_m) const;

 private:
  Air air_;
  double radius_m_;
  std::vector<double> cuts_m_;
};

}  // namespace nepho
