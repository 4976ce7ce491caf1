#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace nepho {

struct SunPosition {
  glm::dvec3 to_sun{0, 0, 1};  // unit, Earth-fixed: x to 0 N 0 E, z to the north pole
  double distance_au = 1;
};

// The sun's apparent place seen from the Earth's centre: VSOP87, nutation and sidereal time by
// libnova (Meeus, Astronomical Algorithms, 2nd ed., ch. 12, 22, 25), aberration by the constant
// 20.49552". Good to 0.006 degrees from 1950 to 2100, nearly all of it from UTC standing for UT1
// (0.9 s turn the Earth by 0.0038 degrees) and from the sun's parallax, 0.0024 degrees, which is
// left out: one direction serves a whole scene. About 30 us.
SunPosition sun_position(std::int64_t utc_ns);

}  // namespace nepho
