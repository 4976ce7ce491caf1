#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.h"

namespace nepho {

// Clear air over a planet as tables in the manner of Hillaire 2020 (doi:10.1111/cgf.14050), made on
// the CPU in double once per picture; shaders read them as float textures, the reference as
// doubles. The planet is a sphere of radius a here (scaled space); height = altitude over the
// ellipsoid. mu = cosine of the zenith angle. All are rgb, x fastest, per unit of irradiance of a
// sun outside the air; coordinates of a texel from (height, mu) and back: physics/air.glsl.

struct AirTable {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

struct AirTables {
  // 256 x 208: optical depth from (mu, height) to the top, which interpolates better than its
  // exponential; meaningless below the horizon. air_depth_coordinates.
  AirTable depth;
  // The others: 253 x 32, by (mu of the sun, height). air_light_coordinates.
  // Mean radiance over all directions of light that air or ground has scattered, and half the mean
  // of it times P2(mu): the source of the next orders, all of them together (air_emission). The
  // first alone, as Hillaire has it, is 4.5 % off in Rayleigh slabs; both are 1.3 % off.
  AirTable multiple, multiple_p2;
  // Mean radiance of air and sunlit ground, without clouds, over the directions within 45 degrees
  // of up, between, and within 45 degrees of down (what sky_source of physics/sky.glsl takes as
  // zenith, horizon, below); sky_low: the upper half of sky_side (ground.glsl).
  AirTable sky_up, sky_side, sky_down, sky_low;
};

// `ground_albedo`: of what lies under most of the view. About 0.17 CPU s.
AirTables make_air_tables(const Air& air, double radius_m, const glm::dvec3& ground_albedo);

// The same quantities without tables, by quadrature in double: for tests and the reference march.
// Optical depth, r g b, along a straight ray in a spherical planet's air: from `height_m` with
// zenith cosine mu, over `length_m` (or to the top of the air); transmittance within 1e-6.
glm::dvec3 air_optical_depth(const Air& air, double radius_m, double height_m, double mu,
                             double length_m);

}  // namespace nepho
