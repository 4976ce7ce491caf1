#include "forecast/grids/cell_size.h"

#include <algorithm>
#include <cmath>

#include "geo/place.h"

namespace nepho::forecast {
namespace {

// Solid angle of a cell (sr), of flat triangles between its corners.
double area_of(const CellPolygons& cells, std::size_t cell) {
  glm::dvec3 sum(0.0);
  const std::uint32_t begin = cells.first[cell], end = cells.first[cell + 1];
  for (std::uint32_t at = begin; at < end; ++at)
    sum += glm::cross(unit_vector(cells.corner_deg[at]),
                      unit_vector(cells.corner_deg[at + 1 < end ? at + 1 : begin]));
  return glm::length(sum) / 2;
}

}  // namespace

double polygon_width_rad(const CellPolygons& cells, std::size_t cell) {
  return std::sqrt(area_of(cells, cell));
}

std::vector<CellSize> some_cells(const HorizontalGrid& grid) {
  const double radius_m = Ellipsoid::wgs84().equatorial_m;
  std::vector<CellSize> sizes;
  if (const CellPolygons* polygons = grid.polygons()) {
    const std::size_t cells = polygons->first.size() - 1;
    // Cells without corners are of no size: all are looked at where none of some has any.
    for (std::size_t step = std::max<std::size_t>(1, cells / 1024); sizes.empty() && step > 0;
         step = step > 1 ? 1 : 0)
      for (std::size_t cell = 0; cell < cells; cell += step)
        if (const double width_m = radius_m * polygon_width_rad(*polygons, cell); width_m > 0)
          sizes.push_back({width_m, width_m * width_m});
    return sizes;
  }
  const int step_x = std::max(1, grid.nx() / 32), step_y = std::max(1, grid.ny() / 32);
  for (int j = 0; j < grid.ny(); j += step_y)
    for (int i = 0; i < grid.nx(); i += step_x) {
      const auto at = [&](double x, double y) { return unit_vector(grid.lat_lon_deg(x, y)); };
      const double x_m = radius_m * glm::length(at(i + 1, j + 0.5) - at(i, j + 0.5));
      const double y_m = radius_m * glm::length(at(i + 0.5, j + 1) - at(i + 0.5, j));
      if (!std::isnan(x_m * y_m)) sizes.push_back({std::min(x_m, y_m), x_m * y_m});
    }
  return sizes;
}

double cell_width_m(const HorizontalGrid& grid) {
  std::vector<CellSize> sizes = some_cells(grid);
  std::ranges::sort(sizes, {}, &CellSize::width_m);
  double total = 0, below = 0;
  for (const CellSize& size : sizes) total += size.area_m2;
  for (const CellSize& size : sizes)
    if ((below += size.area_m2) >= total / 2) return size.width_m;
  return sizes.back().width_m;
}

}  // namespace nepho::forecast
