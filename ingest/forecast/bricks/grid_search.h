#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "forecast/forecast.h"
#include "geo/place.h"

namespace nepho::forecast {

// Inverts a HorizontalGrid: which cell holds a latitude and longitude. From the nearest of some
// cells, downhill from cell to cell, then Newton's method on the unit sphere of (lat, lon); poles
// and the end of the longitudes are no special places. Position to 1e-6 of a cell. About 5 us. Of
// polygons: the one of the eight nearest centres' that holds it, at (cell + 0.5, 0.5).
class GridSearch {
 public:
  explicit GridSearch(std::shared_ptr<const HorizontalGrid> grid);

  struct Found {
    glm::dvec2 at{0.0};    // x in [0, nx), y in [0, ny]; the nearest point of the grid
    double off_cells = 0;  // how far from the asked one, in cells; 0 within the grid
  };
  Found find(glm::dvec2 lat_lon_deg) const;
  // From a place nearby.
  Found find(glm::dvec2 lat_lon_deg, glm::dvec2 start) const;

  const HorizontalGrid& grid() const { return *grid_; }
  double cell_rad() const { return cell_rad_; }  // typical
  glm::dvec2 middle() const { return middle_; }  // or the nearest place on the planet

 private:
  struct PolygonCells;
  glm::dvec3 direction(glm::dvec2 at) const;
  glm::dvec2 inside(glm::dvec2 at) const;
  glm::dvec2 walk(const glm::dvec3& wanted, glm::dvec2 start, int step) const;
  Found polish(const glm::dvec3& wanted, glm::dvec2 at) const;
  Found near_pole(const glm::dvec3& wanted, Found found) const;

  struct Seed {
    glm::dvec2 at;
    glm::dvec3 direction;
  };
  std::shared_ptr<const HorizontalGrid> grid_;
  double cell_rad_ = 0;
  glm::dvec2 middle_{0.0};
  int step_ = 1;
  std::vector<Seed> seeds_;
  std::shared_ptr<const PolygonCells> cells_;  // of a grid of polygons
};

using nepho::lat_lon_deg_of;
using nepho::unit_vector;

}  // namespace nepho::forecast
