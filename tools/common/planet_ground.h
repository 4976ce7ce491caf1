#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "bricks/shell_chart.h"
#include "bricks/surface_map.h"
#include "common/framing.h"

namespace nepho {

// Where a planet's surface is, for eyes that must not be below it.
struct PlanetGround {
  Ellipsoid body = Ellipsoid::wgs84();
  std::vector<std::shared_ptr<const SurfaceMap>>
      maps;  // the first that reaches a point rules there

  // Over the ellipsoid, below or above `ecef_m`; 0 outside all maps.
  double height_m(const glm::dvec3& ecef_m) const;
  // Whether there are data below or above `ecef_m`: no map says that there are none.
  bool known(const glm::dvec3& ecef_m) const;
  // The point of the ellipsoid under a direction from the centre, raised by `height_m`.
  glm::dvec3 point_m(const glm::dvec3& direction, double height_m) const;
  // East, north and the ellipsoid's normal; at a pole, east is +y.
  LocalAxes axes(const glm::dvec3& ecef_m) const;
};

// The four nodes around a direction of scaled space (SurfaceMap), and its place between them.
struct MapPlace {
  std::array<std::size_t, 4> node;
  std::array<double, 4> weight;
  // Bilinear; NaN where a node with weight has none.
  double value(const std::vector<float>& of) const {
    double sum = 0;
    for (std::size_t n = 0; n < 4; ++n)
      if (weight[n] > 0) sum += weight[n] * double(of[node[n]]);
    return sum;
  }
};
// Empty outside the grid.
std::optional<MapPlace> place_on(const SurfaceMap& map, const glm::dvec3& scaled);

// Height of the ground in a map's grid, by its bilinear rule; false outside the grid.
bool map_height_m(const SurfaceMap& map, const Ellipsoid& body, const glm::dvec3& ecef_m,
                  double& height_m);

}  // namespace nepho
