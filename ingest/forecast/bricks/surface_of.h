#pragma once

#include <functional>
#include <memory>

#include "bricks/surface_map.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// A forecast's ground as a SurfaceMap: on a grid about as fine as the model's, in a frame centred
// on the domain of its first time and turned to its rows (a globe: longitude and parametric
// latitude), bilinear between the model's cell centres. A nest that moves leaves one map of all its
// places. Null where the data have no ground.
struct GroundMap {
  std::shared_ptr<const SurfaceMap> map;
  bool has_water = true;  // false: no mask, so that sea is where the ground is at or below 0.5 m
};
GroundMap ground_map(const Forecast& forecast);
// The same of one grid whose inverse is known: `cell_of` takes latitude and longitude (deg) to x in
// [0, nx], y in [0, ny], or to what is not in there. Thread-safe. NaN heights stay, and nodes
// outside the grid have `outside_m`.
std::shared_ptr<const SurfaceMap> ground_map(
    std::shared_ptr<const HorizontalGrid> grid, ForecastGround ground,
    std::function<glm::dvec2(glm::dvec2 lat_lon_deg)> cell_of, float outside_m = 0);

}  // namespace nepho::forecast
