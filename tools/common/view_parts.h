#pragma once

#include <glm/glm.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "common/cloud_map.h"
#include "common/planet_view.h"

namespace nepho {

// What the automatic views of a planet's weather share.

inline constexpr double kSideOfSun_rad = glm::radians(100.0);  // from where one looks: best light
double half_width_rad(const Lens& lens);
// Of who stands: the horizon in the picture's lower fifth.
double standing_pitch_rad(const Lens& lens);
// 0 .. pi.
double turn_between(double a_rad, double b_rad);
glm::dvec3 heading_of(const LocalAxes& axes, double azimuth_rad);
double azimuth_rad(const LocalAxes& axes, const glm::dvec3& direction);

// 1 with the sun to the side, where shadows show form: 40 to 120 degrees from where one looks.
// 0 elsewhere; 1 where there is no sun yet, or it stands so high that no side is better.
bool lit_from_the_side(const LocalAxes& axes, double heading_rad,
                       const std::optional<glm::dvec3>& to_sun);
// Within that, best a little behind the shoulder: 0.25 to 1.25.
double lit_well(const LocalAxes& axes, double heading_rad, const std::optional<glm::dvec3>& to_sun);

// Of the clouds within `radius_m` of a direction. Without any: 500 m and 1000 m.
struct CloudLayer {
  double top_m = 1000, middle_m = 500;
};
CloudLayer layer_near(const CloudMap& map, const glm::dvec3& direction, double radius_m,
                      const Ellipsoid& body);

}  // namespace nepho
