#include "forecast/bricks/surface_of.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bricks/shell_chart.h"
#include "forecast/bricks/cell_overlap.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/bricks/layout.h"

namespace nepho::forecast {
namespace {

using std::numbers::pi;
constexpr int kMostNodes = 4096;         // an axis
constexpr std::size_t kMostPieces = 64;  // places of a moving nest
constexpr double kOutside_cells = 0.75;  // beyond which a node has no ground

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

// One place of a domain, and the ground there.
struct Piece {
  GridSearch search;
  ForecastGround ground;

  std::size_t cells() const {
    return std::size_t(search.grid().nx()) * std::size_t(search.grid().ny());
  }
  bool has(const std::vector<float>& values) const { return values.size() == cells(); }

  // Bilinear between cell centres; of polygons the cell's own.
  float value(const std::vector<float>& values, glm::dvec2 at) const {
    const HorizontalGrid& grid = search.grid();
    if (grid.polygons()) return values[std::size_t(at.x)];
    const double x = std::floor(at.x - 0.5), y = std::floor(at.y - 0.5);
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const int a = corner & 1, b = corner >> 1, n = grid.nx();
      const double weight =
          (a ? at.x - 0.5 - x : x + 1.5 - at.x) * (b ? at.y - 0.5 - y : y + 1.5 - at.y);
      const int i = grid.around() ? (int(x) + a + n) % n : std::clamp(int(x) + a, 0, n - 1);
      const int j = std::clamp(int(y) + b, 0, grid.ny() - 1);
      sum += weight * double(values[std::size_t(j) * std::size_t(n) + std::size_t(i)]);
    }
    return float(sum);
  }
};

bool same_place(const HorizontalGrid& a, const HorizontalGrid& b) {
  if (&a == &b) return true;
  if (a.nx() != b.nx() || a.ny() != b.ny()) return false;
  const auto corner = [](const HorizontalGrid& grid, int n) {
    return unit_vector(grid.lat_lon_deg(n & 1 ? grid.nx() : 0, n & 2 ? grid.ny() : 0));
  };
  for (int n = 0; n < 4; ++n)
    if (glm::length(corner(a, n) - corner(b, n)) > 1e-7) return false;
  return true;
}

// All different places of one domain, in order of time; before those of coarser ones.
void add_pieces(const Forecast& domain, std::vector<Piece>& pieces) {
  for (std::size_t time = 0; time < domain.times_s().size() && pieces.size() < kMostPieces;
       ++time) {
    const auto grid = domain.grid(time);
    const auto known = [&](const Piece& piece) { return same_place(*grid, piece.search.grid()); };
    if (std::ranges::any_of(pieces, known)) continue;
    Piece piece{GridSearch(grid), domain.ground(time)};
    if (piece.has(piece.ground.height_m) || piece.has(piece.ground.water))
      pieces.push_back(std::move(piece));
  }
}

std::vector<Piece> pieces_of(const Forecast& forecast) {
  std::vector<Piece> pieces;
  for (const DomainTime& each : all_domains(forecast)) add_pieces(*each.domain, pieces);
  return pieces;
}

// The frame, and the domains' extent in it, from points along their edges.
void frame_region(SurfaceMap& map, const std::vector<Piece>& pieces, const Ellipsoid& body) {
  const auto at = [&](const HorizontalGrid& grid, double x, double y) {
    return scaled_direction(body, grid.lat_lon_deg(x, y), 0);
  };
  const HorizontalGrid& first = pieces.front().search.grid();
  const glm::dvec2 half = pieces.front().search.middle();
  const glm::dvec3 centre = at(first, half.x, half.y);
  const glm::dvec3 along = first.polygons()
                               ? glm::dvec3(-centre.y, centre.x, 1e-9)
                               : at(first, half.x + std::min(0.5, half.x / 2), half.y) - centre;
  const glm::dvec3 east = glm::normalize(along - glm::dot(along, centre) * centre);
  map.axes = {centre, east, glm::cross(centre, east)};
  glm::dvec2 low(1e9), high(-1e9);
  const auto include = [&](const glm::dvec3& u) {
    if (std::isnan(u.x)) return;
    low = glm::min(low, angles(map.axes, u));
    high = glm::max(high, angles(map.axes, u));
  };
  constexpr int kPoints = 64;
  for (const Piece& piece : pieces) {
    if (const CellPolygons* polygons = piece.search.grid().polygons())
      for (const glm::dvec2& corner : polygons->corner_deg)
        include(scaled_direction(body, corner, 0));
    for (int n = 0; n <= kPoints; ++n) {
      const HorizontalGrid& grid = piece.search.grid();
      const double nx = grid.nx(), ny = grid.ny(), x = nx * n / kPoints, y = ny * n / kPoints;
      for (const glm::dvec3& u : {at(grid, x, 0), at(grid, x, ny), at(grid, 0, y), at(grid, nx, y)})
        include(u);
      // A disc within the grid touches its edges nowhere.
      if (std::isnan(at(grid, x, 0).x))
        for (int row = 0; row <= kPoints; ++row) include(at(grid, x, ny * row / kPoints));
    }
  }
  map.low_rad = low;
  map.step_rad = high - low;
}

// One row of nodes from one place of the domain; nodes that are set already stay.
void fill_row(SurfaceMap& map, int j, const Piece& piece, const Ellipsoid& body,
              std::vector<char>& set) {
  GridSearch::Found found;
  found.off_cells = 1;
  for (int i = 0; i < map.nx; ++i) {
    const std::size_t node = std::size_t(j) * std::size_t(map.nx) + std::size_t(i);
    if (set[node]) continue;
    const glm::dvec2 at = map.low_rad + glm::dvec2(i, j) * map.step_rad;
    const glm::dvec2 place = place_deg(body, direction(map.axes, at));
    found = found.off_cells > 0 ? piece.search.find(place) : piece.search.find(place, found.at);
    if (found.off_cells > kOutside_cells) continue;
    set[node] = 1;
    if (piece.has(piece.ground.height_m))
      map.height_m[node] = piece.value(piece.ground.height_m, found.at);
    map.water[node] = piece.has(piece.ground.water) ? piece.value(piece.ground.water, found.at)
                      : map.height_m[node] <= 0.5f  ? 1.0f
                                                    : 0.0f;
  }
}

}  // namespace

GroundMap ground_map(const Forecast& forecast) {
  const std::vector<Piece> pieces = pieces_of(forecast);
  if (pieces.empty()) return {};
  const Ellipsoid body = Ellipsoid::wgs84();
  const GridSearch& search = pieces.front().search;
  auto map = std::make_shared<SurfaceMap>();
  map->around = search.grid().around();
  if (map->around) {
    map->low_rad = {-pi, -pi / 2};
    map->step_rad = {2 * pi, pi};
  } else {
    frame_region(*map, pieces, body);
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
  std::vector<char> set(nodes, 0);
  tbb::parallel_for(0, map->ny, [&](int j) {
    for (const Piece& piece : pieces) fill_row(*map, j, piece, body, set);
  });
  const Piece& first = pieces.front();
  return {std::move(map), first.has(first.ground.water)};
}

}  // namespace nepho::forecast
