#include "reference/chart_ray.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "physics/physics_cpp.h"
#include "reference/chart_rays.h"

namespace nepho {
namespace {

FaceAxes face_axes(const ShellChart& chart, int root) {
  const auto on_cube = [&](double x, double y) {
    const glm::dvec3 p = chart.to_scaled(chart.ecef_m({root, {x, y, 0}}));
    return glm::round(p / std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
  };
  const auto axis = [](const glm::dvec3& p) {
    for (int a = 0; a < 2; ++a)
      if (p[a] != 0) return FaceAxes::Axis{a, p[a]};
    return FaceAxes::Axis{2, p[2]};
  };
  const glm::dvec3 normal = on_cube(0.5, 0.5);
  return {axis(normal), axis(on_cube(1, 0.5) - normal), axis(on_cube(0.5, 1) - normal)};
}

const std::array<FaceAxes, 6>& cube_axes() {
  static const std::array<FaceAxes, 6> axes = [] {
    const ShellChart chart(Ellipsoid::sphere(1), 0, 1);
    std::array<FaceAxes, 6> all;
    for (int root = 0; root < 6; ++root) all[std::size_t(root)] = face_axes(chart, root);
    return all;
  }();
  return axes;
}

}  // namespace

SphereChords::SphereChords(const glm::dvec3& origin, const glm::dvec3& direction)
    : a_(glm::dot(direction, direction)),
      b_(glm::dot(origin, direction)),
      r0_(glm::length(origin)),
      miss_(glm::length(glm::cross(origin, direction))),
      slope_(std::sqrt(a_)) {}

std::optional<SphereChords::Chord> SphereChords::with(double radius) const {
  const double c = (r0_ - radius) * (r0_ + radius);
  // b^2 - a c without the cancellation of the two: |d|^2 R^2 - |o x d|^2, factored.
  const double reach = slope_ * radius;
  const double discriminant = (reach - miss_) * (reach + miss_);
  if (discriminant < 0) return std::nullopt;
  const double q = -(b_ + std::copysign(std::sqrt(discriminant), b_));
  if (q == 0) return Chord{0, 0};
  return Chord{std::min(q / a_, c / q), std::max(q / a_, c / q)};
}

Index3 BoxRay::wrapped(const Cell& cell) const {
  Index3 result;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t n = cells_[a];
#if defined(NEPHO_MUTANT_NO_WRAP)
    result[a] = std::uint32_t(std::clamp<std::int64_t>(cell[a], 0, n - 1));
#else
    const bool inside = cell[a] >= 0 && cell[a] < n;
    result[a] = std::uint32_t(inside ? cell[a] : (cell[a] % n + n) % n);
#endif
  }
  return result;
}

ShellRay::ShellRay(const ShellChart& chart, const Index3& cells, const Ray& ray)
    : chart_(chart),
      cells_(cells),
      count_(double(cells[0]), double(cells[1]), double(cells[2])),
      direction_(chart.to_scaled(ray.direction)),
      origin_(chart.to_scaled(ray.origin_m)),
      closest_m_(-glm::dot(origin_, direction_) / glm::dot(direction_, direction_)),
      chords_(origin_, direction_),
      axes_(cube_axes()) {}

ChartRay::Start ShellRay::start(double t_max_m) const {
  Start s{0, -1, 0, {}};
  const auto top = chords_.with(radius_m(count_.z));
  if (!top) return s;
  s.t_m = std::max(0.0, top->first);
  s.end_m = std::min(t_max_m, top->second);
  if (glm::length(origin_) < radius_m(0))
    if (const auto bottom = chords_.with(radius_m(0))) s.t_m = std::max(s.t_m, bottom->second);
  if (s.end_m > s.t_m) enter(s.t_m, s.root, s.cell);
  return s;
}

glm::dvec3 ShellRay::cells_at(int root, double t_m) const {
  const FaceAxes& face = axes_[std::size_t(root)];
  const glm::dvec3 p = origin_ + t_m * direction_;
  const double across = face.normal.of(p);
  const auto coordinate = [](double angle) { return 0.5 + angle * (2 / std::numbers::pi); };
  const double altitude_m = glm::length(p) - chart_.body().equatorial_m;
  return count_ * glm::dvec3{coordinate(angle_[0].of(face.u.of(p) / across)),
                             coordinate(angle_[1].of(face.v.of(p) / across)),
                             (altitude_m - chart_.bottom_m()) / chart_.thickness_m()};
}

double ShellRay::wall_tangent(std::size_t axis, std::int64_t wall) const {
  Wall& last = wall_[axis];
  if (last.wall != wall) last = {wall, equiangular(2 * double(wall) / count_[int(axis)] - 1)};
  return last.tangent;
}

ChartRay::Exit ShellRay::exit(int root, const Block& block, double t_m) const {
  Exit exit{kNoDistance_m, 0, 0};
  const FaceAxes& face = axes_[std::size_t(root)];
  const double across = face.normal.of(origin_), across_slope = face.normal.of(direction_);
  for (const std::size_t a : {0u, 1u}) {
    const FaceAxes::Axis& axis = a == 0 ? face.u : face.v;
    const double along = axis.of(origin_), along_slope = axis.of(direction_);
    // Of the coordinate's tangent along the ray, times a square.
    const double rise = along_slope * across - along * across_slope;
    if (rise == 0) continue;
    const int side = rise > 0 ? 1 : -1;
    const double tangent = wall_tangent(a, (side > 0 ? block.high : block.low)[a]);
    const double slope = along_slope - tangent * across_slope;
    if (side * slope <= 0) continue;
    const double t = std::max(t_m, -(along - tangent * across) / slope);
    if (t < exit.t_m) exit = {t, int(a), side};
  }
  if (t_m < closest_m_)
    if (const auto below = chords_.with(radius_m(double(block.low[2])))) {
      const double t = std::max(t_m, below->first);
      if (t < exit.t_m) exit = {t, 2, -1};
    }
  const auto above = chords_.with(radius_m(double(block.high[2])));
  const double t = std::max(t_m, above ? above->second : closest_m_);
  if (t < exit.t_m) exit = {t, 2, 1};
  return exit;
}

bool ShellRay::cross_end(const Exit& exit, double& t_m, int& root, Cell& cell) const {
  if (exit.axis == 2) {
    if (exit.side > 0) return false;
    const auto bottom = chords_.with(radius_m(0));
    if (!bottom) return false;
    t_m = std::max(t_m, bottom->second);
    enter(t_m, root, cell);
    return true;
  }
  // The other name of the middle sample of the edge that was crossed.
  Column edge{root, cells_[0] / 2, cells_[1] / 2};
  (exit.axis == 0 ? edge.i : edge.j) = exit.side > 0 ? cells_[0] : 0;
  Column other;
  for (const Column& name : chart_.names(edge, cells_))
    if (name.root != root) other = name;
  root = other.root;
  const glm::dvec3 at = cells_at(root, exit.t_m);
  const auto index = [&](std::uint32_t name, int axis) -> std::int64_t {
    const std::uint32_t n = cells_[std::size_t(axis)];
    if (name == 0) return 0;
    return name == n ? n - 1 : floor_clamped(at[axis], n);
  };
  cell[0] = index(other.i, 0);
  cell[1] = index(other.j, 1);
  return true;
}

void ShellRay::enter(double t_m, int& root, Cell& cell) const {
  const glm::dvec3 p = origin_ + t_m * direction_;
  root = 0;
  for (int face = 1; face < 6; ++face)
    if (axes_[std::size_t(face)].normal.of(p) > axes_[std::size_t(root)].normal.of(p)) root = face;
  const glm::dvec3 at = cells_at(root, t_m);
  for (int a = 0; a < 3; ++a) cell[std::size_t(a)] = floor_clamped(at[a], cells_[std::size_t(a)]);
}

int ShellRay::sub_steps(double length_m, double cells_high) const {
#if defined(NEPHO_MUTANT_ONE_SIMPSON_STEP)
  return 1;
#endif
  return f64::simpson_steps(length_m * glm::length(direction_), chart_.body().equatorial_m,
                            cells_high * chart_.thickness_m() / count_.z);
}

std::unique_ptr<ChartRay> chart_ray(const VolumeInfo& info, const Ray& ray) {
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  if (info.chart->kind() == ChartKind::kBox)
    return std::make_unique<BoxRay>(static_cast<const BoxChart&>(*info.chart), cells, ray);
  return std::make_unique<ShellRay>(static_cast<const ShellChart&>(*info.chart), cells, ray);
}

void Ground::set(const Ellipsoid& body) {
  radius_m_ = body.equatorial_m;
  z_scale_ = body.equatorial_m / body.polar_m;
}

void Ground::add(const Chart& chart) {
  const auto* shell = dynamic_cast<const ShellChart*>(&chart);
  if (!shell) return;
  const double radius_m = shell->body().equatorial_m + std::min(0.0, shell->bottom_m());
  if (radius_m_ != 0 && radius_m_ <= radius_m) return;
  radius_m_ = radius_m;
  z_scale_ = shell->body().equatorial_m / shell->body().polar_m;
}

double Ground::sun_part(const glm::dvec3& point_m, const glm::dvec3& to_sun) const {
  if (radius_m_ == 0) return 1;
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 p = scale * point_m;
  const double r_m = glm::length(p);
  return f64::sun_above_horizon(radius_m_, r_m - radius_m_,
                                glm::dot(p, glm::normalize(scale * to_sun)) / r_m);
}

double Ground::distance_m(const Ray& ray) const {
  if (radius_m_ == 0) return kNoDistance_m;
  const glm::dvec3 scale{1, 1, z_scale_};
  const glm::dvec3 origin = scale * ray.origin_m, direction = scale * ray.direction;
  // A centimetre: a point of the ground itself sees the sky.
  if (glm::dot(origin, direction) >= 0 || glm::length(origin) < radius_m_ - 0.01)
    return kNoDistance_m;
  const auto chord = SphereChords(origin, direction).with(radius_m_);
  return chord ? std::max(chord->first, 0.0) : kNoDistance_m;
}

}  // namespace nepho
