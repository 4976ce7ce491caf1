#include "forecast/bricks/domain_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forecast/bricks/cell_overlap.h"
#include "geo/place.h"

namespace nepho::forecast {
namespace {

constexpr double kSide_deg = 1;  // longest wall between two corners

double angle_deg(glm::dvec2 a, glm::dvec2 b) {
  const Ellipsoid ball = Ellipsoid::sphere(1);
  const glm::dvec3 u = scaled_direction(ball, a, 0), v = scaled_direction(ball, b, 0);
  return 2 * std::asin(std::min(1.0, glm::length(u - v) / 2)) * 180 / std::numbers::pi;
}

// Into how many parts walls are cut.
int parts_of_walls(const HorizontalGrid& grid) {
  double longest_deg = 0;
  const int step_x = std::max(1, grid.nx() / 16), step_y = std::max(1, grid.ny() / 16);
  for (int j = 0; j < grid.ny(); j += step_y)
    for (int i = 0; i < grid.nx(); i += step_x) {
      const glm::dvec2 here = grid.lat_lon_deg(i, j);
      for (const glm::dvec2& next : {grid.lat_lon_deg(i + 1, j), grid.lat_lon_deg(i, j + 1)})
        if (!std::isnan(here.x) && !std::isnan(next.x))
          longest_deg = std::max(longest_deg, angle_deg(here, next));
    }
  return std::clamp(int(std::ceil(longest_deg / kSide_deg)), 1, 30);
}

// Of triangles into 4^halvings of great circles.
int halvings_of(const CellPolygons& polygons) {
  double longest_deg = 0;
  for (std::size_t cell = 0; cell + 1 < polygons.first.size(); ++cell)
    for (std::uint32_t at = polygons.first[cell] + 1; at < polygons.first[cell + 1]; ++at)
      longest_deg =
          std::max(longest_deg, angle_deg(polygons.corner_deg[at - 1], polygons.corner_deg[at]));
  return std::clamp(int(std::ceil(std::log2(longest_deg / kSide_deg))), 0, 5);
}

}  // namespace

DomainCells::DomainCells(const Ellipsoid& body, const HorizontalGrid& grid, double height_m)
    : body_(body),
      grid_(grid),
      height_m_(height_m),
      parts_(grid.polygons() ? halvings_of(*grid.polygons()) : parts_of_walls(grid)) {}

void DomainCells::for_each_part(std::size_t cell, const Use& use) const {
  if (const CellPolygons* polygons = grid_.polygons()) {
    const auto corner = [&](std::uint32_t at) { return unit_vector(polygons->corner_deg[at]); };
    const std::uint32_t begin = polygons->first[cell], end = polygons->first[cell + 1];
    for (std::uint32_t at = begin + 2; at < end; ++at)
      add_triangle(corner(begin), corner(at - 1), corner(at), parts_, use);
    return;
  }
  const auto nx = std::size_t(grid_.nx());
  const auto x = double(cell % nx), y = double(cell / nx);
  const auto corner = [&](int a, int b) {
    return scaled_direction(
        body_, grid_.lat_lon_deg(x + double(a) / parts_, y + double(b) / parts_), height_m_);
  };
  for (int b = 0; b < parts_; ++b)
    for (int a = 0; a < parts_; ++a)
      use({corner(a, b), corner(a + 1, b), corner(a + 1, b + 1), corner(a, b + 1)});
}

// Walls that two cells share are cut alike.
void DomainCells::add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               int more, const Use& use) const {
  if (more > 0) {
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                     ca = glm::normalize(c + a);
    add_triangle(a, ab, ca, more - 1, use);
    add_triangle(ab, b, bc, more - 1, use);
    add_triangle(ca, bc, c, more - 1, use);
    add_triangle(ab, bc, ca, more - 1, use);
    return;
  }
  const auto scaled = [&](const glm::dvec3& u) {
    return scaled_direction(body_, lat_lon_deg_of(u), height_m_);
  };
  use({scaled(a), scaled(b), scaled(c), scaled(c)});
}

}  // namespace nepho::forecast
