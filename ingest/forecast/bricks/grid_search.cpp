#include "forecast/bricks/grid_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forecast/grids/cell_size.h"
#include "geo/nearest_places.h"

namespace nepho::forecast {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kSeeds = 40;  // an axis

}  // namespace

struct GridSearch::PolygonCells {
  NearestPlaces centres;
  const CellPolygons& cells;

  // Sides of the cell's walls that a direction lies on: the same for all, if inside.
  bool holds(std::uint32_t cell, const glm::dvec3& u) const {
    int left = 0, right = 0;
    const std::uint32_t begin = cells.first[cell], end = cells.first[cell + 1];
    for (std::uint32_t at = begin; at < end; ++at) {
      const glm::dvec3 a = unit_vector(cells.corner_deg[at]),
                       b = unit_vector(cells.corner_deg[at + 1 < end ? at + 1 : begin]);
      const double side = glm::dot(glm::cross(a, b), u);
      left += side > 0;
      right += side < 0;
    }
    return end > begin && (left == 0 || right == 0);
  }
};

namespace {

constexpr std::size_t kCandidates = 8;  // cells whose centres are nearest

}  // namespace

GridSearch::GridSearch(std::shared_ptr<const HorizontalGrid> grid) : grid_(std::move(grid)) {
  if (const CellPolygons* polygons = grid_->polygons()) {
    std::vector<glm::dvec3> centres;
    glm::dvec3 sum(0.0);
    for (int n = 0; n < grid_->nx(); ++n) {
      centres.push_back(direction({n + 0.5, 0.5}));
      const std::size_t cell = std::size_t(n);
      if (polygons->first[cell + 1] > polygons->first[cell]) sum += centres.back();
    }
    cells_ = std::make_shared<const PolygonCells>(
        PolygonCells{NearestPlaces(std::move(centres)), *polygons});
    middle_ = {cells_->centres.nearest(sum / (glm::length(sum) + 1e-300), 1).front() + 0.5, 0.5};
    cell_rad_ = polygon_width_rad(*polygons, std::size_t(middle_.x));
    return;
  }
  const int nx = grid_->nx(), ny = grid_->ny();
  step_ = std::max(1, (std::max(nx, ny) + kSeeds - 1) / kSeeds);
  for (int j = 0; j < ny; j += step_)
    for (int i = 0; i < nx; i += step_) {
      const glm::dvec2 at = {i + 0.5, j + 0.5};
      const glm::dvec3 u = direction(at);
      if (!std::isnan(u.x)) seeds_.push_back({at, u});
    }
  if (seeds_.empty()) seeds_.push_back({{nx / 2.0, ny / 2.0}, glm::dvec3(0.0)});
  const auto to_middle = [&](const Seed& seed) {
    return glm::length(seed.at - glm::dvec2(nx / 2.0, ny / 2.0));
  };
  const glm::dvec2 exact = {nx / 2.0, ny / 2.0};
  const glm::dvec2 middle =
      std::isnan(direction(exact).x) ? std::ranges::min_element(seeds_, {}, to_middle)->at : exact;
  middle_ = middle;
  const glm::dvec3 here = direction(middle);
  cell_rad_ = std::min(glm::length(direction(middle - glm::dvec2(0.5, 0)) - here),
                       glm::length(direction(middle - glm::dvec2(0, 0.5)) - here)) *
              2;
}

glm::dvec3 GridSearch::direction(glm::dvec2 at) const {
  return grid_->direction(at.x, at.y);
}

glm::dvec2 GridSearch::inside(glm::dvec2 at) const {
  const double nx = grid_->nx();
  if (grid_->around()) {
    at.x -= nx * std::floor(at.x / nx);
    if (at.x >= nx) at.x = 0;
  } else {
    at.x = std::clamp(at.x, 0.0, nx);
  }
  at.y = std::clamp(at.y, 0.0, double(grid_->ny()));
  return at;
}

glm::dvec2 GridSearch::walk(const glm::dvec3& wanted, glm::dvec2 start, int step) const {
  const auto distance = [&](glm::dvec2 at) {
    const glm::dvec3 gap = direction(at) - wanted;
    return glm::dot(gap, gap);
  };
  glm::dvec2 best = start;
  double nearest = distance(best);
  for (; step > 0; step /= 2)
    for (bool moved = true; moved;) {
      moved = false;
      const glm::dvec2 from = best;
      for (int n = 0; n < 9; ++n) {
        const glm::dvec2 next = inside(from + double(step) * glm::dvec2(n % 3 - 1, n / 3 - 1));
        if (const double d = distance(next); d < nearest) nearest = d, best = next, moved = true;
      }
    }
  return best;
}

GridSearch::Found GridSearch::polish(const glm::dvec3& wanted, glm::dvec2 at) const {
  constexpr double kStep = 1e-4;
  glm::dvec3 gap = wanted - direction(at);
  for (int turn = 0; turn < 40; ++turn) {
    const glm::dvec2 x0 = inside(at - glm::dvec2(kStep, 0)), y0 = inside(at - glm::dvec2(0, kStep));
    // One-sided at the grid's ends; across the end of the longitudes both sides are there.
    const double run_x = grid_->around() ? 2 * kStep : inside(at + glm::dvec2(kStep, 0)).x - x0.x;
    const double run_y = inside(at + glm::dvec2(0, kStep)).y - y0.y;
    const glm::dvec3 dx = (direction(inside(at + glm::dvec2(kStep, 0))) - direction(x0)) / run_x;
    const glm::dvec3 dy = (direction(inside(at + glm::dvec2(0, kStep))) - direction(y0)) / run_y;
    const double xx = glm::dot(dx, dx), xy = glm::dot(dx, dy), yy = glm::dot(dy, dy);
    const double gx = glm::dot(dx, gap), gy = glm::dot(dy, gap);
    const double det = xx * yy - xy * xy;
    glm::dvec2 step = det > 1e-12 * xx * yy ? glm::dvec2(gx * yy - gy * xy, gy * xx - gx * xy) / det
                                            : glm::dvec2(0, yy > 0 ? gy / yy : 0);
    const double length = glm::length(step);
    if (!(length > 1e-9)) break;
    if (length > 2) step *= 2 / length;
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, step *= 0.5) {
      const glm::dvec2 next = inside(at + step);
      const glm::dvec3 rest = wanted - direction(next);
      if (!(glm::dot(rest, rest) < glm::dot(gap, gap))) continue;
      better = true;
      at = next;
      gap = rest;
    }
    if (!better) break;
  }
  const double off = glm::length(gap) / cell_rad_;
  return {at, off < 1e-6 ? 0 : off};
}

// At a pole x has no slope, and a cell's middle may be the pole: from the nearest of points all
// around it instead.
GridSearch::Found GridSearch::near_pole(const glm::dvec3& wanted, Found found) const {
  if (found.off_cells == 0 || !grid_->around()) return found;
  constexpr int kAround = 36;
  Seed nearest{found.at, glm::dvec3(0.0)};
  for (int row = -6; row <= 6; ++row)
    for (int n = 0; n < kAround; ++n) {
      const glm::dvec2 at = inside({grid_->nx() * (n + 0.5) / kAround, found.at.y + 0.2 * row});
      const Seed seed{at, direction(at)};
      const double slope =
          glm::length(direction(inside(at + glm::dvec2(0.01, 0))) - seed.direction);
      if (slope > 1e-6 * cell_rad_ &&
          glm::dot(seed.direction, wanted) > glm::dot(nearest.direction, wanted))
        nearest = seed;
    }
  const Found again = polish(wanted, nearest.at);
  return again.off_cells < found.off_cells ? again : found;
}

GridSearch::Found GridSearch::find(glm::dvec2 lat_lon_deg) const {
  const glm::dvec3 wanted = unit_vector(lat_lon_deg);
  if (cells_) {
    const std::vector<std::uint32_t> near = cells_->centres.nearest(wanted, kCandidates);
    for (const std::uint32_t cell : near)
      if (cells_->holds(cell, wanted)) return {{cell + 0.5, 0.5}, 0};
    const double away = glm::length(cells_->centres[near.front()] - wanted);
    return {{near.front() + 0.5, 0.5}, std::max(away / cell_rad_, 1e-3)};
  }
  const auto nearest = std::ranges::max_element(
      seeds_, {}, [&](const Seed& seed) { return glm::dot(seed.direction, wanted); });
  return near_pole(wanted, polish(wanted, walk(wanted, nearest->at, step_)));
}

GridSearch::Found GridSearch::find(glm::dvec2 lat_lon_deg, glm::dvec2 start) const {
  if (cells_) return find(lat_lon_deg);
  const glm::dvec3 wanted = unit_vector(lat_lon_deg);
  const Found found = polish(wanted, inside(start));
  return found.off_cells > 0 ? find(lat_lon_deg) : found;
}

}  // namespace nepho::forecast
