#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "common/cloud_map.h"
#include "common/planet_ground.h"
#include "scene/scene.h"

namespace nepho {

// Cameras for a planet's weather, worked out from where its clouds are. Pure functions of a map of
// columns, the ground and the sun; none reads a voxel.

struct Lens {
  double vertical_fov_rad = 0.75, aspect = 16.0 / 9;
};
inline constexpr double kObliqueFov_rad = 0.75, kGlobeFov_rad = 0.6, kStandingFov_rad = 0.95;

struct PlanetView {
  Camera camera;
  glm::dvec3 centre_m{0.0};  // what it is a view of, on the ground: there the sun's angles are told
};

// How much of the part around the cloudiest place an oblique view shows, to either side.
double oblique_part_m(const CloudMap& map, const Ellipsoid& body);

// Down on the clouds around a direction, the horizon in the picture's upper fifth: at least 1.3
// times as high as they reach, and so far that the part fills the middle. Of all headings one with
// much cloud, and with the sun to the side or behind the shoulder. Clear of the terrain.
PlanetView oblique_view(const CloudMap& map, const glm::dvec3& direction,
                        const PlanetGround& ground, const Lens& lens,
                        const std::optional<glm::dvec3>& to_sun);

// The whole body with black around it; north is up. Of all sides the one with the most sunlit cloud
// and the sun not straight behind.
PlanetView globe_view(const CloudMap& map, const PlanetGround& ground, const Lens& lens,
                      const std::optional<glm::dvec3>& to_sun);

// From the ground. What `stand` leaves open: towards the most cloud in sight, the horizon in the
// picture's lower fifth or lower, where the cloud stands high.
PlanetView standing_view(const Stand& stand, const CloudMap& near, const PlanetGround& ground,
                         const Lens& lens, const std::optional<glm::dvec3>& to_sun);
// A place to stand some way off from the cloud around a direction, with the least cloud overhead.
Stand place_to_stand(const CloudMap& map, const glm::dvec3& direction, const PlanetGround& ground);

// Azimuth and elevation of the sun at a place, both in degrees.
glm::dvec2 sun_angles_deg(const LocalAxes& axes, const glm::dvec3& to_sun);
// 35 degrees high, 100 degrees to the left of where the camera looks.
glm::dvec3 sun_to_the_side(const Camera& camera, const LocalAxes& axes);

}  // namespace nepho
