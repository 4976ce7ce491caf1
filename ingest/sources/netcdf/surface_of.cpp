#include "sources/netcdf/surface_of.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bricks/shell_chart.h"
#include "sources/netcdf/cell_overlap.h"

namespace nepho::netcdf {
namespace {

using std::numbers::pi;
constexpr int kMostNodes = 4096;  // an axis

glm::dvec2 angles(const glm::dmat3& axes, const glm::dvec3& u) {
  return {std::atan2(glm::dot(u, axes[1]), glm::dot(u, axes[0])),
          std::asin(std::clamp(glm::dot(u, axes[2]), -1.0, 1.0))};
}

glm::dvec3 direction(const glm::dmat3& axes, glm::dvec2 at) {
  return axes * glm::dvec3(std::cos(at.y) * std::cos(at.x), std::cos(at.y) * std::sin(at.x),
                           std::sin(at.y));
}

// Geodetic place of the ellipsoid's point in a scaled direction.
glm::dvec2 place_deg(const Ellipsoid& body, const glm::dvec3& scaled) {
  return lat_lon_deg_of({scaled.x, scaled.y, scaled.z * (body.equatorial_m / body.polar_m)});
}

// The frame, and the grid's extent in it, from points along the domain's edge.
void frame_region(SurfaceMap& map, const HorizontalGrid& grid, const Ellipsoid& body) {
  const double nx = grid.nx(), ny = grid.ny();
  const auto at = [&](double x, double y) {
    return scaled_direction(body, grid.lat_lon_deg(x, y), 0);
  };
  const glm::dvec3 centre = at(nx / 2, ny / 2);
  const glm::dvec3 along = at(nx / 2 + std::min(0.5, nx / 4), ny / 2) - centre;
  const glm::dvec3 east = glm::normalize(along - glm::dot(along, centre) * centre);
  map.axes = {centre, east, glm::cross(centre, east)};
  glm::dvec2 low(1e9), high(-1e9);
  constexpr int kPoints = 64;
  for (int n = 0; n <= kPoints; ++n) {
    const double t = double(n) / kPoints;
    for (const glm::dvec3& u : {at(t * nx, 0), at(t * nx, ny), at(0, t * ny), at(nx, t * ny)}) {
      low = glm::min(low, angles(map.axes, u));
      high = glm::max(high, angles(map.axes, u));
    }
  }
  map.low_rad = low;
  map.step_rad = high - low;
}

}  // namespace

std::shared_ptr<const SurfaceMap> surface_of(const GridSearch& search,
                                             const ForecastGround& ground) {
  const HorizontalGrid& grid = search.grid();
  const auto cells = std::size_t(grid.nx()) * std::size_t(grid.ny());
  if (ground.height_m.size() != cells && ground.water.size() != cells) return nullptr;
  const Ellipsoid body = Ellipsoid::wgs84();
  auto map = std::make_shared<SurfaceMap>();
  map->around = grid.around();
  if (map->around) {
    map->low_rad = {-pi, -pi / 2};
    map->step_rad = {2 * pi, pi};
  } else {
    frame_region(*map, grid, body);
  }
  const auto count = [&](double extent_rad) {
    return std::clamp(int(std::ceil(extent_rad / search.cell_rad())), 1, kMostNodes - 1);
  };
  map->nx = count(map->step_rad.x) + (map->around ? 0 : 1);
  map->ny = count(map->step_rad.y) + 1;
  map->step_rad /= glm::dvec2(map->around ? map->nx : map->nx - 1, map->ny - 1);
  const auto nodes = std::size_t(map->nx) * std::size_t(map->ny);
  map->height_m.assign(nodes, 0.0f);
  map->water.assign(nodes, 1.0f);

  const auto wrapped = [&](int i) {
    return grid.around() ? (i + grid.nx()) % grid.nx() : std::clamp(i, 0, grid.nx() - 1);
  };
  const auto interpolated = [&](const std::vector<float>& values, glm::dvec2 at, float otherwise) {
    if (values.size() != cells) return otherwise;
    const double x = std::floor(at.x - 0.5), y = std::floor(at.y - 0.5);
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const int a = corner & 1, b = corner >> 1;
      const double weight =
          (a ? at.x - 0.5 - x : x + 1.5 - at.x) * (b ? at.y - 0.5 - y : y + 1.5 - at.y);
      const int j = std::clamp(int(y) + b, 0, grid.ny() - 1);
      sum +=
          weight *
          double(
              values[std::size_t(j) * std::size_t(grid.nx()) + std::size_t(wrapped(int(x) + a))]);
    }
    return float(sum);
  };
  // A file with heights and no mask: sea where the ground is at or below 0.
  const bool has_water = ground.water.size() == cells;
  for (int j = 0; j < map->ny; ++j) {
    GridSearch::Found found;
    for (int i = 0; i < map->nx; ++i) {
      const glm::dvec2 at = map->low_rad + glm::dvec2(i, j) * map->step_rad;
      const glm::dvec2 place = place_deg(body, direction(map->axes, at));
      found = i == 0 || found.off_cells > 0 ? search.find(place) : search.find(place, found.at);
      if (found.off_cells > 0.75) continue;
      const std::size_t node = std::size_t(j) * std::size_t(map->nx) + std::size_t(i);
      const float height = interpolated(ground.height_m, found.at, 0);
      map->height_m[node] = height;
      map->water[node] = has_water ? interpolated(ground.water, found.at, 1) : height <= 0.5f;
    }
  }
  return map;
}

}  // namespace nepho::netcdf
