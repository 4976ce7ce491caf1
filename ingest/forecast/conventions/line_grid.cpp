#include "forecast/conventions/line_grid.h"

#include <cmath>
#include <glm/glm.hpp>

#include "core/error.h"
#include "forecast/conventions/horizontal.h"
#include "geo/place.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

constexpr const char* kLoneRow =
    "The grid is one row of cells without bounds: they are drawn as wide as they are long.";
constexpr const char* kLoneCell = "The grid is one cell without bounds: it is drawn 10 km wide.";

void set_width(std::vector<double>& edges, double width) {
  const double middle = 0.5 * (edges.front() + edges.back());
  edges = {middle - 0.5 * width, middle + 0.5 * width};
}

// Typical.
double step_of(const std::vector<double>& edges) {
  return std::abs(edges.back() - edges.front()) / double(edges.size() - 1);
}

}  // namespace

void widen_lone(AxisWalls& x, AxisWalls& y, double x_m, double y_m,
                std::vector<std::string>& assumptions) {
  if (x.known && y.known) return;
#ifndef NEPHO_MUTANT_UNIT_CELL
  if (!x.known && !y.known) {
    set_width(x.edges, kLoneCell_m / x_m);
    set_width(y.edges, kLoneCell_m / y_m);
  } else if (!x.known) {
    set_width(x.edges, step_of(y.edges) * y_m / x_m);
  } else {
    set_width(y.edges, step_of(x.edges) * x_m / y_m);
  }
#endif
  assumptions.push_back(x.known || y.known ? kLoneRow : kLoneCell);
}

std::unique_ptr<HorizontalGrid> line_grid(int nx, int ny, const std::vector<double>& latitude_deg,
                                          const std::vector<double>& longitude_deg,
                                          const std::string& where,
                                          std::vector<std::string>& assumptions) {
  std::vector<glm::dvec3> centre;
  for (std::size_t n = 0; n < latitude_deg.size(); ++n) {
    centre.push_back(unit_vector({latitude_deg[n], longitude_deg[n]}));
    if (std::isnan(centre.back().x))
      throw Error({"the coordinates of the grid are not usable", where,
                   "places of all cells of one row", "a missing value", ""});
  }
  const std::size_t count = centre.size();
  // Walls across the row half way between centres, and where the row would go on.
  std::vector<glm::dvec3> wall, along;
  for (std::size_t n = 0; n <= count; ++n) {
    if (count == 1) {
      const glm::dvec3 north = {-centre[0].z * centre[0].x, -centre[0].z * centre[0].y,
                                1 - centre[0].z * centre[0].z};
      const glm::dvec3 east = glm::cross(glm::normalize(north), centre[0]);
      along.push_back(east * (kLoneCell_m / constants::kWgs84Equatorial_m));
      wall.push_back(centre[0] + (double(n) - 0.5) * along[0]);
      continue;
    }
    const std::size_t a = n == 0 ? 0 : std::min(n - 1, count - 2);
    along.push_back(centre[a + 1] - centre[a]);
    wall.push_back(centre[a] + (double(n) - double(a) - 0.5) * along.back());
  }
  std::vector<double> lat, lon;
  const auto add = [&](const glm::dvec3& u) {
    const glm::dvec2 place = lat_lon_deg_of(glm::normalize(u));
    lat.push_back(place.x);
    lon.push_back(place.y);
  };
  const auto corner = [&](std::size_t n, double side) {
    add(wall[n] + side * 0.5 * glm::cross(wall[n], along[n]));
  };
  if (ny == 1) {
    for (const double side : {-1.0, 1.0})
      for (std::size_t n = 0; n <= count; ++n) corner(n, side);
  } else {
    for (std::size_t n = 0; n <= count; ++n)
      for (const double side : {1.0, -1.0}) corner(n, side);
  }
  assumptions.push_back(count == 1 ? kLoneCell : kLoneRow);
  return corners_grid(nx, ny, std::move(lat), std::move(lon), where);
}

}  // namespace nepho::forecast
