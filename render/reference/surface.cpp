#include "reference/surface.h"

#include <algorithm>
#include <cmath>

namespace nepho {
namespace {

constexpr double kSteepest = 10;  // walls of data are no steeper than this
constexpr int kHalvings = 48;
constexpr double kOffStart = 1e-5;  // of a cell: where a ray from the ground is above or below it

// Height of a node; under the ellipsoid counts as 0.
double node_height_m(const SurfaceMap& map, int i, int j) {
  return std::max(0.0, double(map.height_m[std::size_t(j * map.nx + i)]));
}

}  // namespace

const SurfaceMap* surface_of(const RenderRequest& request) {
  const SurfaceMap* map = request.terrain;
  for (const RenderVolume& volume : request.volumes)
    if (!map) map = volume.source->info().surface.get();
  if (!map || map->nx < 2 || map->ny < 2) return nullptr;
  const bool says_something =
      std::ranges::any_of(map->height_m, [](float height_m) { return height_m > 0; }) ||
      std::ranges::any_of(map->water, [](float water) { return water < 1; });
  return says_something ? map : nullptr;
}

glm::dvec3 mean_ground_albedo(const RenderRequest& request) {
  const GroundLook& look = request.planet->ground;
  const SurfaceMap* map = surface_of(request);
  if (!map) return look.water_albedo;
  double water = 0;
  for (const float w : map->water) water += double(w) / double(map->water.size());
  return glm::mix(look.land_albedo, look.water_albedo, water);
}

PlanetSurface::PlanetSurface(const Ellipsoid& body, const SurfaceMap* map)
    : body_(body), map_(map), z_scale_(body.equatorial_m / body.polar_m) {
  sea_.set(body);
  if (!map) return;
  const double north_m = body.polar_m * map->step_rad.y;
  cell_m_ = north_m;
  for (int j = 0; j < map->ny; ++j) {
    const double level = std::cos(map->low_rad.y + j * map->step_rad.y);
    const double east_m = std::max(body.polar_m * map->step_rad.x * level, 1.0);
    if (level > 0.1) cell_m_ = std::min(cell_m_, east_m);
    for (int i = 0; i < map->nx; ++i) {
      const double here_m = node_height_m(*map, i, j);
      top_m_ = std::max(top_m_, here_m);
      const int next = i + 1 < map->nx ? i + 1 : 0;
      double slope =
          next > i || map->around ? std::abs(node_height_m(*map, next, j) - here_m) / east_m : 0;
      if (j + 1 < map->ny)
        slope = std::hypot(slope, (node_height_m(*map, i, j + 1) - here_m) / north_m);
      slope_ = std::max(slope_, std::min(slope, kSteepest));
    }
  }
}

glm::dvec2 PlanetSurface::node(const glm::dvec3& point_m) const {
  const glm::dvec3 u = glm::normalize(glm::dvec3{1, 1, z_scale_} * point_m) * map_->axes;
  const glm::dvec2 angle{std::atan2(u.y, u.x), std::asin(std::clamp(u.z, -1.0, 1.0))};
  return (angle - map_->low_rad) / map_->step_rad;
}

glm::dvec2 PlanetSurface::at(glm::dvec2 node) const {
  const int nx = map_->nx, ny = map_->ny;
  if (map_->around) node.x -= std::floor(node.x / nx) * nx;
  const double last_x = map_->around ? nx : nx - 1, last_y = ny - 1;
  if (!(node.x >= 0 && node.y >= 0 && node.x <= last_x && node.y <= last_y)) return {0, 1};
  const int i = std::min(int(node.x), int(last_x) - 1), j = std::min(int(node.y), ny - 2);
  const double f = node.x - i, g = node.y - j;
  const int next = i + 1 == nx ? 0 : i + 1;
  const auto mixed = [&](const std::vector<float>& values) {
    const auto value = [&](int x, int y) { return double(values[std::size_t(y * nx + x)]); };
    const double low = value(i, j) + f * (value(next, j) - value(i, j));
    const double high = value(i, j + 1) + f * (value(next, j + 1) - value(i, j + 1));
    return low + g * (high - low);
  };
  return {std::max(mixed(map_->height_m), 0.0), mixed(map_->water)};
}

double PlanetSurface::gap_m(const glm::dvec3& point_m) const {
  return glm::length(glm::dvec3{1, 1, z_scale_} * point_m) - body_.equatorial_m -
         at(node(point_m)).x;
}

// Steps that the steepest slope allows, but for a hundredth of a cell.
double PlanetSurface::terrain_m(const Ray& ray, double begin_m, double end_m) const {
  const auto gap = [&](double t) { return gap_m(ray.origin_m + t * ray.direction); };
  double t = begin_m, before = begin_m;
  while (true) {
    const double above_m = gap(t);
    if (above_m <= 0) break;
    if (t >= end_m) return kNoDistance_m;
    before = t;
    const double down =
        std::max(-glm::dot(glm::normalize(ray.origin_m + t * ray.direction), ray.direction), 0.0);
    t = std::min(t + std::max(above_m / (down + 1.2 * slope_ + 1e-3), 0.01 * cell_m_), end_m);
  }
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (before + t);
    (gap(middle) > 0 ? before : t) = middle;
  }
  return t;
}

double PlanetSurface::distance_m(const Ray& ray, bool from_it) const {
  const double sea_m = sea_.distance_m(ray);
  if (!map_) return sea_m;
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 p = scale * ray.origin_m, d = scale * ray.direction;
  const double a = glm::dot(d, d), b = glm::dot(p, d), top_m = body_.equatorial_m + top_m_ + 1;
  const double c = (glm::length(p) - top_m) * (glm::length(p) + top_m);
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return sea_m;
  const double begin_m = (-b - std::sqrt(discriminant)) / a;
  const double end_m = (-b + std::sqrt(discriminant)) / a;
  if (c > 0 && !(begin_m > 0)) return sea_m;
  double first_m = std::max(begin_m, 0.0);
#if defined(NEPHO_MUTANT_START_OFF_THE_GROUND)
  if (from_it) {
    const glm::dvec3 start_m = ray.origin_m + 0.02 * cell_m_ * spot(ray.origin_m).normal;
    return distance_m({start_m, ray.direction});
  }
#elif !defined(NEPHO_MUTANT_ROOT_OF_THE_START)
  if (from_it) {
    // The root of the start is known. In its cell heights are quadratic along the ray: what leaves
    // and comes back is below until the cell's end, and so is found by the steps.
    first_m = kOffStart * cell_m_;
    if (gap_m(ray.origin_m + first_m * ray.direction) <= 0) return 0;
  }
#endif
  return std::min(sea_m, terrain_m(ray, first_m, std::min(end_m, sea_m)));
}

PlanetSurface::Spot PlanetSurface::spot(const glm::dvec3& point_m) const {
  Spot spot;
  const glm::dvec3 scale{1, 1, z_scale_};
  spot.up = spot.normal = glm::normalize(scale * scale * point_m);
  if (!map_) return spot;
  const glm::dvec2 node = this->node(point_m), here = at(node);
  spot.height_m = here.x;
  spot.water = here.y;
  // Slope over one cell: bilinear heights then have a continuous normal.
  const glm::dvec2 rise_m{at(node + glm::dvec2{0.5, 0}).x - at(node - glm::dvec2{0.5, 0}).x,
                          at(node + glm::dvec2{0, 0.5}).x - at(node - glm::dvec2{0, 0.5}).x};
  const glm::dvec3 across = glm::normalize(scale * point_m), north = map_->axes[2];
  const glm::dvec3 east = glm::cross(north, across);
  const double level = std::max(glm::length(east), 1e-4);
  const glm::dvec3 east_here = east / level, north_here = glm::cross(across, east_here);
  const glm::dvec2 slope = rise_m / (map_->step_rad * glm::dvec2{level, 1}) / body_.equatorial_m;
  spot.normal =
      glm::normalize(spot.up - (1 - here.y) * (slope.x * east_here + slope.y * north_here));
  return spot;
}

}  // namespace nepho
