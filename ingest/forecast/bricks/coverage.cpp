#include "forecast/bricks/coverage.h"

#include <algorithm>
#include <cmath>

#include "forecast/bricks/cell_overlap.h"

namespace nepho::forecast {

std::span<const std::pair<std::uint64_t, std::uint32_t>> Coverage::Domain::at(
    std::uint64_t square) const {
  const auto begin = std::ranges::lower_bound(of_square, std::pair{square, std::uint32_t{0}});
  auto end = begin;
  while (end != of_square.end() && end->first == square) ++end;
  return {begin, end};
}

void Coverage::add(const HorizontalGrid& grid, double height_m,
                   const std::vector<char>& without_data) {
  Domain domain;
  const DomainCells cells(chart_.body(), grid, height_m);
  const auto on_face = [&](int root, FacePolygon polygon) {
    const double area = polygon.area();
    if (area == 0) return;
    if (area < 0) std::reverse(polygon.point.begin(), polygon.point.begin() + polygon.size);
    glm::dvec2 low = polygon.corner(0), high = low;
    for (int at = 1; at < polygon.size; ++at) {
      low = glm::min(low, polygon.corner(at));
      high = glm::max(high, polygon.corner(at));
    }
    low = glm::max(glm::floor(low), 0.0);
    high = glm::min(high, double(cells_[0]));
    for (double i = low.x; i < high.x; ++i)
      for (double j = low.y; j < high.y; ++j)
        domain.of_square.emplace_back(key(root, std::uint32_t(i), std::uint32_t(j)),
                                      std::uint32_t(domain.cells.size()));
    domain.cells.push_back(polygon);
  };
  const std::size_t count = std::size_t(grid.nx()) * std::size_t(grid.ny());
  for (std::size_t cell = 0; cell < count; ++cell) {
#ifndef NEPHO_MUTANT_HOLES
    if (!without_data.empty() && without_data[cell]) continue;
#endif
    cells.for_each_part(cell, [&](const std::array<glm::dvec3, 4>& corners) {
      for_each_face(chart_, cells_, corners, on_face);
    });
  }
  std::ranges::sort(domain.of_square);
  domain.cells.shrink_to_fit();
  domains_.push_back(std::move(domain));
}

}  // namespace nepho::forecast
