#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace nepho {

// The ground under a source's clouds, where its data have one: heights and water on a grid of two
// angles about an axis of its own, so that no pole and no date line is inside a region.
//
// A direction u is that of scaled space (ShellChart: z stretched by a/b, then normalised). With the
// columns of `axes` = (centre, east, north), orthonormal:
//   x = atan2(u . east, u . centre), y = asin(u . north)            rad
// Node (i, j) lies at low_rad + (i, j) * step_rad; values are interpolated bilinearly between
// nodes. `around`: x goes all the way round, nx * step_rad.x = 2 pi, and column nx is column 0.
// Outside the grid: height 0, water.
struct SurfaceMap {
  glm::dmat3 axes{1.0};
  glm::dvec2 low_rad{0.0}, step_rad{0.0};
  int nx = 0, ny = 0;
  bool around = false;
  std::vector<float> height_m;  // nx * ny, x fastest; over the ellipsoid, as the chart's height
  std::vector<float> water;     // nx * ny; part of the surface, 0 land .. 1 water
};

}  // namespace nepho
