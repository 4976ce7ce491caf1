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

// How much of the clouds an oblique view shows, to either side of its target: as much as makes a
// cell of the data six pixels wide in a picture of 640 (and three times their height at least), but
// no more than there is.
double oblique_part_m(const CloudMap& map, const Ellipsoid& body);

// Down on the clouds, from above them all, the horizon in the picture's upper fifth: the lower the
// flatter the clouds are for the part that is shown. Of all places (or at `target` alone, a
// direction) and headings with the sun to the side, the one whose coarse picture has most structure
// (cloud_raster.h). Clear of the terrain. `map` should tell `part_m` apart in ten columns.
PlanetView oblique_view(const CloudMap& map, double part_m, const std::optional<glm::dvec3>& target,
                        const PlanetGround& ground, const Lens& lens,
                        const std::optional<glm::dvec3>& to_sun);

// The whole body with black around it; north is up. Of all sides the one with the most structure in
// sunlight, and the sun not straight behind.
PlanetView globe_view(const CloudMap& map, const PlanetGround& ground, const Lens& lens,
                      const std::optional<glm::dvec3>& to_sun);

// From the ground. What `stand` leaves open: towards the most cloud in sight, the horizon in the
// picture's lower fifth or lower, where the cloud stands high.
PlanetView standing_view(const Stand& stand, const CloudMap& near, const PlanetGround& ground,
                         const Lens& lens, const std::optional<glm::dvec3>& to_sun);
// How far around a stand clouds are in sight, and tall enough.
double standing_part_m(const CloudMap& map, const Ellipsoid& body);
// A place to stand not farther than that from a direction, with open sky overhead and, the sun to
// the side, the sky ahead that has most structure.
Stand place_to_stand(const CloudMap& map, const glm::dvec3& about, const PlanetGround& ground,
                     const Lens& lens, const std::optional<glm::dvec3>& to_sun);

// Azimuth and elevation of the sun at a place, both in degrees.
glm::dvec2 sun_angles_deg(const LocalAxes& axes, const glm::dvec3& to_sun);
// 35 degrees high, 100 degrees to the left of where the camera looks.
glm::dvec3 sun_to_the_side(const Camera& camera, const LocalAxes& axes);

}  // namespace nepho
