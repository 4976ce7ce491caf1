#pragma once

#include <functional>
#include <optional>

#include "bricks/shell_chart.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// The cells of one grid as quadrilaterals in scaled space: long walls are cut, all cells' alike, so
// that neighbours share every corner; polygons are triangles about their first corner.
class DomainCells {
 public:
  // Corners stand at `height_m` over the ellipsoid. `grid` and `body` outlive this.
  DomainCells(const Ellipsoid& body, const HorizontalGrid& grid, double height_m);

  using Use = std::function<void(const std::array<glm::dvec3, 4>& corners)>;
  // Calls `use` for each part of a cell, in an order that depends on the cell alone.
  void for_each_part(std::size_t cell, const Use& use) const;

 private:
  void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int more,
                    const Use& use) const;

  const Ellipsoid& body_;
  const HorizontalGrid& grid_;
  double height_m_;
  int parts_;  // a wall, or halvings of a triangle's
};

}  // namespace nepho::forecast
