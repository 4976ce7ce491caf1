#include "reference/surface.h"

#include <algorithm>
#include <cmath>

namespace nepho {
namespace {

constexpr double kSteepest = 10;         // walls of data are no steeper than this
constexpr int kFalsi = 16, kSteps = 64;  // to find where a ray meets it
constexpr double kOnGround_m = 1e-8;     // ten times what a place's height is rounded to
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

template <class Take>
void PlanetSurface::take_at(glm::dvec2 node, const Take& take) const {
  const int nx = map_->nx, ny = map_->ny;
  if (map_->around) node.x -= std::floor(node.x / nx) * nx;
  const double last_x = map_->around ? nx : nx - 1, last_y = ny - 1;
  if (!(node.x >= 0 && node.y >= 0 && node.x <= last_x && node.y <= last_y)) return;
  const int i = std::min(int(node.x), int(last_x) - 1), j = std::min(int(node.y), ny - 2);
  const double f = node.x - i, g = node.y - j;
  const int next = i + 1 == nx ? 0 : i + 1;
  take([&](const std::vector<float>& values) {
    const auto value = [&](int x, int y) { return double(values[std::size_t(y * nx + x)]); };
    const double low = value(i, j) + f * (value(next, j) - value(i, j));
    const double high = value(i, j + 1) + f * (value(next, j + 1) - value(i, j + 1));
    return low + g * (high - low);
  });
}

double PlanetSurface::height_m(glm::dvec2 node) const {
  double height_m = 0;
  take_at(node, [&](const auto& mixed) { height_m = std::max(mixed(map_->height_m), 0.0); });
  return height_m;
}

double PlanetSurface::gap_m(const glm::dvec3& point_m) const {
  return glm::length(glm::dvec3{1, 1, z_scale_} * point_m) - body_.equatorial_m -
         height_m(node(point_m));
}

// Steps that the steepest slope allows, but for a hundredth of a cell.
std::optional<PlanetSurface::Bracket> PlanetSurface::terrain(const Ray& ray, double begin_m,
                                                             double end_m) const {
  double t = begin_m, before = begin_m, gap_before_m = 0;
  while (true) {
    const double above_m = gap_m(ray.origin_m + t * ray.direction);
    if (above_m <= 0) return Bracket{before, t, gap_before_m, above_m};
    if (t >= end_m) return std::nullopt;
    before = t;
    gap_before_m = above_m;
    const double down =
        std::max(-glm::dot(glm::normalize(ray.origin_m + t * ray.direction), ray.direction), 0.0);
    t = std::min(t + std::max(above_m / (down + 1.2 * slope_ + 1e-3), 0.01 * cell_m_), end_m);
  }
}

// Regula falsi, Illinois: within a cell heights along a ray are nearly a parabola. At the map's
// edges they jump: then halves.
double PlanetSurface::meeting_m(const Ray& ray, Bracket b) const {
  int kept = 0;  // the end that stayed: -1, 1
  for (int step = 0; step < kSteps && b.above_m < b.under_m; ++step) {
    const double part =
        step < kFalsi && b.gap_above_m > 0 ? b.gap_above_m / (b.gap_above_m - b.gap_under_m) : 0.5;
    const double t = b.above_m + part * (b.under_m - b.above_m);
    const double gap = gap_m(ray.origin_m + t * ray.direction);
    if (std::abs(gap) < kOnGround_m) return t;
    if (gap > 0) {
      b.above_m = t;
      b.gap_above_m = gap;
      if (kept == 1) b.gap_under_m *= 0.5;
      kept = 1;
    } else {
      b.under_m = t;
      b.gap_under_m = gap;
      if (kept == -1) b.gap_above_m *= 0.5;
      kept = -1;
    }
  }
  return b.under_m;
}

std::optional<PlanetSurface::Bracket> PlanetSurface::bracket(const Ray& ray, bool from_it,
                                                             double within_m) const {
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 p = scale * ray.origin_m, d = scale * ray.direction;
  const double a = glm::dot(d, d), b = glm::dot(p, d), top_m = body_.equatorial_m + top_m_ + 1;
  const double r_m = glm::length(p), c = (r_m - top_m) * (r_m + top_m);
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return std::nullopt;
  const double begin_m = (-b - std::sqrt(discriminant)) / a;
  const double end_m = std::min((-b + std::sqrt(discriminant)) / a, within_m);
  if (c > 0 && !(begin_m > 0)) return std::nullopt;
  double first_m = std::max(begin_m, 0.0);
#if !defined(NEPHO_MUTANT_ROOT_OF_THE_START)
  if (from_it) {
    // The root of the start is known. In its cell heights are quadratic along the ray: what leaves
    // and comes back is below until the cell's end, and so is found by the steps.
    first_m = kOffStart * cell_m_;
    const double gap = gap_m(ray.origin_m + first_m * ray.direction);
    if (gap <= 0) return Bracket{0, 0, 0, gap};
  }
#endif
  if (first_m > end_m) return std::nullopt;
  return terrain(ray, first_m, end_m);
}

double PlanetSurface::distance_m(const Ray& ray, bool from_it, double within_m) const {
  const double sea_m = sea_.distance_m(ray), end_m = std::min(sea_m, within_m);
  const double at_sea_m = sea_m <= within_m ? sea_m : kNoDistance_m;
  if (!map_) return at_sea_m;
#if defined(NEPHO_MUTANT_START_OFF_THE_GROUND)
  if (from_it) {
    const glm::dvec3 start_m = ray.origin_m + 0.02 * cell_m_ * spot(ray.origin_m).normal;
    return distance_m({start_m, ray.direction});
  }
#endif
  const auto found = bracket(ray, from_it, end_m);
  return found ? std::min(at_sea_m, meeting_m(ray, *found)) : at_sea_m;
}

bool PlanetSurface::hides(const Ray& ray, bool from_it) const {
  const double sea_m = sea_.distance_m(ray);
  return sea_m < kNoDistance_m || (map_ && bracket(ray, from_it, kNoDistance_m));
}

PlanetSurface::Spot PlanetSurface::spot(const glm::dvec3& point_m) const {
  Spot spot;
  const glm::dvec3 scale{1, 1, z_scale_};
  spot.up = spot.normal = glm::normalize(scale * scale * point_m);
  if (!map_) return spot;
  const glm::dvec2 node = this->node(point_m);
  take_at(node, [&](const auto& mixed) {
    spot.height_m = std::max(mixed(map_->height_m), 0.0);
    spot.water = mixed(map_->water);
  });
  // Slope over one cell: bilinear heights then have a continuous normal.
  const glm::dvec2 rise_m{
      height_m(node + glm::dvec2{0.5, 0}) - height_m(node - glm::dvec2{0.5, 0}),
      height_m(node + glm::dvec2{0, 0.5}) - height_m(node - glm::dvec2{0, 0.5})};
  const glm::dvec3 across = glm::normalize(scale * point_m), north = map_->axes[2];
  const glm::dvec3 east = glm::cross(north, across);
  const double level = std::max(glm::length(east), 1e-4);
  const glm::dvec3 east_here = east / level, north_here = glm::cross(across, east_here);
  const glm::dvec2 slope = rise_m / (map_->step_rad * glm::dvec2{level, 1}) / body_.equatorial_m;
  spot.normal =
      glm::normalize(spot.up - (1 - spot.water) * (slope.x * east_here + slope.y * north_here));
  return spot;
}

}  // namespace nepho
