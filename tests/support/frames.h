#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace nepho::test {

// Columns east, north, up at a geodetic place. Written out here, apart from ingest/geo, so that
// tests of formats need neither.
inline glm::dmat3 east_north_up(double latitude_rad, double longitude_rad) {
  const double sp = std::sin(latitude_rad), cp = std::cos(latitude_rad);
  const double sl = std::sin(longitude_rad), cl = std::cos(longitude_rad);
  return {{-sl, cl, 0}, {-sp * cl, -sp * sl, cp}, {cp * cl, cp * sl, sp}};
}

// Edge vectors of a box of these sizes along the columns of a frame.
inline glm::dmat3 scaled_columns(const glm::dmat3& frame, glm::dvec3 size_m) {
  return {frame[0] * size_m.x, frame[1] * size_m.y, frame[2] * size_m.z};
}

}  // namespace nepho::test
