#pragma once

#include "rayleigh_slab.h"
#include "truth_support.h"

namespace nepho::test {

// Radiance of a slab (add_slab) in the sun, by paths from the eye. `view` names the angles.
enum class Seen { kFromAbove, kFromBelow };

inline Estimate slab_radiance(const PathTracer& tracer, const SlabRow& view, Seen seen,
                              int colour = 1) {
  const Ray ray = seen == Seen::kFromAbove ? Ray{{50, 50, kSlab_m + 1}, view.from_above()}
                                           : Ray{{50, 50, -1}, view.from_below()};
  const auto path = [&](Random& random) {
    return std::array{tracer.sample(ray, random).radiance_W_per_m2_sr_nm[colour]};
  };
  return measure_to<1>(1, path)[0];
}

// A beam of 1 W/m2 across itself, or a disc.
inline void add_sun(Medium& medium, const glm::dvec3& to_sun, double radius_rad = 0) {
  medium.request.sun = {.to_sun = to_sun, .irradiance_W_per_m2_nm = glm::dvec3{1.0}};
  medium.settings.sun_radius_rad = radius_rad;
}

}  // namespace nepho::test
