#include "forecast/conventions/voronoi.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geo/nearest_places.h"
#include "geo/place.h"

namespace nepho::forecast {
namespace {

constexpr std::size_t kNeighbours = 24;
// Half sides, of the third neighbour's distance: of a square that holds the cells of hexagons and
// of triangles (whose corners are as far as it), and of one that closes a cell at the rim.
constexpr double kWidest = 2, kRim = 0.6;

std::vector<glm::dvec2> square(double half) {
  return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
}

// What of a polygon lies where dot(p, normal) <= limit.
std::vector<glm::dvec2> cut(const std::vector<glm::dvec2>& polygon, glm::dvec2 normal,
                            double limit) {
  std::vector<glm::dvec2> part;
  for (std::size_t at = 0; at < polygon.size(); ++at) {
    const glm::dvec2 &p = polygon[at], &q = polygon[(at + 1) % polygon.size()];
    const double dp = glm::dot(p, normal) - limit, dq = glm::dot(q, normal) - limit;
    if (dp <= 0) part.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) part.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  return part;
}

std::vector<glm::dvec2> cell_of(const NearestPlaces& places, std::uint32_t n) {
  const glm::dvec3& up = places[n];
  const glm::dvec3 any = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 east = glm::normalize(glm::cross(any, up)), north = glm::cross(up, east);
  const std::vector<std::uint32_t> near = places.nearest(up, kNeighbours + 1);
  const auto distance = [&](std::size_t k) { return glm::length(places[near[k]] - up); };
  const double third = near.size() > 3 ? distance(3) : near.size() > 1 ? distance(1) : 0.01;
  const auto within = [&](double half) {
    std::vector<glm::dvec2> cell = square(half);
    for (const std::uint32_t other : near) {
      if (other == n) continue;
      // Points p = up + x east + y north with dot(p, other) <= dot(p, up) = 1.
      const glm::dvec3& u = places[other];
      const glm::dvec2 normal = {glm::dot(u, east), glm::dot(u, north)};
      if (glm::dot(normal, normal) > 0) cell = cut(cell, normal, 1 - glm::dot(u, up));
    }
    return cell;
  };
  std::vector<glm::dvec2> cell = within(kWidest * third);
  const auto touches = [&](glm::dvec2 p) {
    return std::max(std::abs(p.x), std::abs(p.y)) > 0.999 * kWidest * third;
  };
  if (std::ranges::any_of(cell, touches)) cell = within(kRim * third);
  std::vector<glm::dvec2> corners;
  for (const glm::dvec2& p : cell) corners.push_back(lat_lon_deg_of(up + p.x * east + p.y * north));
  return corners;
}

}  // namespace

CellPolygons voronoi_cells(const std::vector<glm::dvec2>& centre_deg) {
  std::vector<glm::dvec3> units;
  for (const glm::dvec2& centre : centre_deg) units.push_back(unit_vector(centre));
  const NearestPlaces places(std::move(units));
  std::vector<std::vector<glm::dvec2>> cells(centre_deg.size());
  tbb::parallel_for(std::size_t{0}, cells.size(),
                    [&](std::size_t n) { cells[n] = cell_of(places, std::uint32_t(n)); });
  CellPolygons polygons;
  polygons.first.push_back(0);
  for (const auto& cell : cells) {
    polygons.corner_deg.insert(polygons.corner_deg.end(), cell.begin(), cell.end());
    polygons.first.push_back(std::uint32_t(polygons.corner_deg.size()));
  }
  return polygons;
}

}  // namespace nepho::forecast
