#include "tree/view_metric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"

namespace nepho {
namespace {

constexpr double kOffScreen = 0.25;
// Off-screen and its shadow too: it takes part of the sky's light away, from all directions alike.
constexpr double kNoShadow = 1.0 / 16;
// Arcs bulge between the grid points of a shell node: 22.5 deg of arc rises 2 % of its chord.
constexpr double kBulge = 1.05;
constexpr double kFront = 0.2;  // in front of the eye: at this part of a node's size and distance

struct QBox {
  glm::dvec3 low, high;
};

QBox q_box(const Lattice& lattice, NodeKey key) {
  const Index3 n = lattice.nodes(key.level());
  const glm::dvec3 count{double(n[0]), double(n[1]), double(n[2])};
  const glm::dvec3 at{double(key.i()), double(key.j()), double(key.k())};
  return {at / count, (at + 1.0) / count};
}

template <class Shape>
Shape shape_of(const Chart& chart, int root, const QBox& box) {
  Shape shape;
  for (int p = 0; p < 27; ++p) {
    const glm::dvec3 f = glm::dvec3{double(p % 3), double(p / 3 % 3), double(p / 9)} / 2.0;
    shape.grid_m[std::size_t(p)] = chart.ecef_m({root, glm::mix(box.low, box.high, f)});
  }
  shape.center_m = shape.grid_m[13];
  constexpr std::array<int, 3> stride = {1, 3, 9};
  for (int p = 0; p < 27; ++p) {
    const glm::dvec3& here = shape.grid_m[std::size_t(p)];
    shape.radius_m = std::max(shape.radius_m, kBulge * glm::length(here - shape.center_m));
    for (int axis = 0; axis < 3; ++axis) {
      const int step = stride[std::size_t(axis)];
      if (p / step % 3 != 0) continue;
      const glm::dvec3& middle = shape.grid_m[std::size_t(p + step)];
      const glm::dvec3& end = shape.grid_m[std::size_t(p + 2 * step)];
      shape.edge_m[axis] =
          std::max(shape.edge_m[axis], glm::length(middle - here) + glm::length(end - middle));
    }
  }
  return shape;
}

// The eye in the node's coordinates, moved by whole periods to where it is nearest.
glm::dvec3 nearest_image(const BoxChart& chart, const QBox& box, glm::dvec3 eye_m) {
  const glm::dvec3 q = chart.inverse_edges() * (eye_m - chart.origin_m());
  const glm::dvec3 turns = glm::round(q - (box.low + box.high) / 2.0);
  if (chart.periodic().x) eye_m -= turns.x * chart.edges_m()[0];
  if (chart.periodic().y) eye_m -= turns.y * chart.edges_m()[1];
  return eye_m;
}

// Hidden by a sphere: beyond the plane of its horizon and within its shadow's cone.
bool behind_planet(const ShellChart& chart, const glm::dvec3& eye_m, const glm::dvec3& center_m,
                   double radius_m) {
  const glm::dvec3 eye = chart.to_scaled(eye_m), center = chart.to_scaled(center_m);
  const double stretch = chart.body().equatorial_m / chart.body().polar_m;
  const double radius = std::max(stretch, 1.0) * radius_m;
  // The ground that hides: the lowest that any cloud's ray can reach.
  const double body = chart.body().equatorial_m + std::min(0.0, chart.bottom_m());
  const double away = glm::length(eye);
  if (!(away > body)) return false;
  const glm::dvec3 inwards = -eye / away, offset = center - eye;
  const double depth = glm::dot(offset, inwards);
  if (depth - radius < (away - body) * (away + body) / away) return false;
  const double tangent = body / std::sqrt((away - body) * (away + body));
  const double across = glm::length(offset - depth * inwards);
  return across + radius * std::sqrt(1 + tangent * tangent) < depth * tangent;
}

// How far a shadow that starts at `from_m` reaches: to the ground, or out of the clouds.
double shadow_length_m(const Chart& any, const glm::dvec3& from_m, const glm::dvec3& to_sun) {
  if (const auto* box = dynamic_cast<const BoxChart*>(&any)) {
    const auto& e = box->edges_m();
    return glm::length(e[0]) + glm::length(e[1]) + glm::length(e[2]);
  }
  const auto& shell = static_cast<const ShellChart&>(any);
  // A ray stays a ray in scaled space, and keeps its parameter.
  const glm::dvec3 from = shell.to_scaled(from_m), along = shell.to_scaled(from_m - to_sun) - from;
  const double a = glm::dot(along, along), b = glm::dot(from, along);
  const auto root = [&](double radius, double sign) {
    const double d = b * b - a * (glm::dot(from, from) - radius * radius);
    return d > 0 ? (-b + sign * std::sqrt(d)) / a : -1;
  };
  const double body = shell.body().equatorial_m, ground = body + std::min(0.0, shell.bottom_m());
  const double down = root(ground, -1);
  return std::max(0.0, down > 0 ? down : root(body + shell.bottom_m() + shell.thickness_m(), 1));
}

// The length along x, on the picture, of the thinnest layer that a box with these edges can be seen
// to hold: a layer across (1, m) is as thick as the widest edge in that direction. The largest of
// |x + m y| is convex in m; its least is where two of them meet, or one is 0.
double least_run(const std::array<glm::dvec2, 3>& edges) {
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double zero_x, double zero_y) {  // m with zero_x + m zero_y = 0
    const double m = zero_y == 0 ? 0 : -zero_x / zero_y;
    double most = 0;
    for (const glm::dvec2& edge : edges) most = std::max(most, std::abs(edge.x + m * edge.y));
    least = std::min(least, most);
  };
  for (std::size_t a = 0; a < 3; ++a) {
    consider(edges[a].x, edges[a].y);
    const glm::dvec2 &one = edges[a], &other = edges[(a + 1) % 3];
    consider(one.x - other.x, one.y - other.y);
    consider(one.x + other.x, one.y + other.y);
  }
  return least;
}

}  // namespace

struct ViewMetric::Shape {
  std::array<glm::dvec3, 27> grid_m;
  glm::dvec3 edge_m{0.0};  // longest row of grid points along each axis
  glm::dvec3 center_m;
  double radius_m = 0;

  // Of a ray from the eye, in the node as a box about its middle: out by the nearest pair of walls.
  double path_m(const glm::dvec3& eye_m) const {
    const glm::dvec3 sight = center_m - eye_m;
    const double away_m = glm::length(sight);
    double path_m = glm::length(edge_m);
    for (std::size_t axis = 0, step = 1; axis < 3; ++axis, step *= 3) {
      const glm::dvec3 along = glm::normalize(grid_m[13 + step] - grid_m[13 - step]);
      const double slope = away_m > 0 ? std::abs(glm::dot(along, sight)) / away_m : 1;
      const double edge = edge_m[int(axis)];
      if (slope * path_m > edge) path_m = edge / slope;
    }
    return path_m;
  }
};

ViewMetric::ViewMetric(const Camera& camera, const RenderSettings& settings,
                       const std::optional<glm::dvec3>& to_sun)
    : to_sun_(to_sun),
      eye_m_(camera.eye_m),
      forward_(glm::normalize(camera.target_m - camera.eye_m)),
      right_(glm::normalize(glm::cross(forward_, camera.up))),
      up_(glm::cross(right_, forward_)),
      tan_half_height_(std::tan(camera.vertical_fov_rad / 2)),
      tan_half_width_(tan_half_height_ * settings.width / settings.height),
      pixel_rad_(2 * tan_half_height_ / settings.height),
      width_(settings.width),
      height_(settings.height) {}

bool ViewMetric::on_screen(const glm::dvec3& center_m, double radius_m) const {
  const glm::dvec3 offset = center_m - eye_m_;
  const double depth = glm::dot(offset, forward_);
  if (depth < -radius_m) return false;
  const auto inside = [&](double across, double tangent) {
    return std::abs(across) - depth * tangent < radius_m * std::sqrt(1 + tangent * tangent);
  };
#if defined(NEPHO_MUTANT_SEEN_HALF)
  if (glm::dot(offset, right_) < 0) return false;
#endif
  return inside(glm::dot(offset, right_), tan_half_width_) &&
         inside(glm::dot(offset, up_), tan_half_height_);
}

bool ViewMetric::seen(const VolumeInfo& info, const Shape& shape) const {
  if (const auto* chart = dynamic_cast<const BoxChart*>(info.chart.get())) {
    if (chart->periodic().x || chart->periodic().y) return true;
  } else if (behind_planet(static_cast<const ShellChart&>(*info.chart), eye_m_, shape.center_m,
                           shape.radius_m)) {
    return false;
  }
  return on_screen(shape.center_m, shape.radius_m);
}

bool ViewMetric::shadows_seen(const VolumeInfo& info, const Shape& shape) const {
  if (!to_sun_) return true;
#if defined(NEPHO_MUTANT_SHADOW_NONE)
  return false;
#endif
  const double length_m = shadow_length_m(*info.chart, shape.center_m, *to_sun_);
  const int parts = std::clamp(int(std::ceil(length_m / (2 * shape.radius_m))), 1, 16);
  const double half_m = 0.5 * length_m / parts;
  for (int p = 0; p < parts; ++p)
    if (on_screen(shape.center_m - (2 * p + 1) * half_m * *to_sun_, shape.radius_m + half_m))
      return true;
  return false;
}

bool ViewMetric::seen(const VolumeInfo& info, NodeKey key) const {
  return seen(info, shape_of<Shape>(*info.chart, key.root(), q_box(info.lattice, key)));
}

std::optional<ViewMetric::Footprint> ViewMetric::footprint(const VolumeInfo& info,
                                                           NodeKey key) const {
  const auto shape = shape_of<Shape>(*info.chart, key.root(), q_box(info.lattice, key));
  if (!seen(info, shape)) return std::nullopt;
  const glm::dvec2 all{double(width_), double(height_)};
  constexpr double kMost = std::numeric_limits<double>::infinity();
  Footprint footprint{all, glm::dvec2{0.0}, glm::dvec2{kMost}};
  const glm::dvec2 scale = 0.5 * all / glm::dvec2{tan_half_width_, tan_half_height_};
  // Edges of a voxel in the camera's axes.
  const glm::dmat3 to_camera = glm::transpose(glm::dmat3{right_, up_, forward_});
  const std::array<glm::dvec3, 3> edges_m = {
      to_camera * (shape.grid_m[14] - shape.grid_m[12]) / double(kBrickCells),
      to_camera * (shape.grid_m[16] - shape.grid_m[10]) / double(kBrickCells),
      to_camera * (shape.grid_m[22] - shape.grid_m[4]) / double(kBrickCells)};
  bool around = false;
  if (const auto* box = dynamic_cast<const BoxChart*>(info.chart.get()))
    around = box->periodic().x || box->periodic().y;
  for (const glm::dvec3& point_m : shape.grid_m) {
    const glm::dvec3 offset_m = to_camera * (point_m - eye_m_);
    // A node beside the eye or behind it is anywhere, and its voxels are large.
    around = around || offset_m.z < kFront * std::max(glm::length(offset_m), shape.radius_m);
    if (offset_m.z <= 0) continue;
    const glm::dvec2 slope = glm::dvec2{offset_m} / offset_m.z;
    std::array<glm::dvec2, 3> edges;
    for (std::size_t e = 0; e < 3; ++e)
      edges[e] = scale * (glm::dvec2{edges_m[e]} - slope * edges_m[e].z) / offset_m.z;
    footprint.voxel_pixels.x = std::min(footprint.voxel_pixels.x, least_run(edges));
    for (glm::dvec2& edge : edges) std::swap(edge.x, edge.y);
    footprint.voxel_pixels.y = std::min(footprint.voxel_pixels.y, least_run(edges));
    const glm::dvec2 at = 0.5 * all + scale * glm::dvec2{slope.x, -slope.y};
    footprint.low = glm::min(footprint.low, at);
    footprint.high = glm::max(footprint.high, at);
  }
  if (around) {
    footprint.low = glm::dvec2{0.0};
    footprint.high = all;
    return footprint;
  }
  const glm::dvec2 bulge = (kBulge - 1) * (footprint.high - footprint.low) + 1.0;
  footprint.low -= bulge;
  footprint.high += bulge;
  return footprint;
}

ViewMetric::NodeView ViewMetric::view(const VolumeInfo& info, NodeKey key) const {
  const QBox box = q_box(info.lattice, key);
  const auto shape = shape_of<Shape>(*info.chart, key.root(), box);
  glm::dvec3 eye_m = eye_m_;
  glm::dvec3 q;
  if (const auto* chart = dynamic_cast<const BoxChart*>(info.chart.get())) {
    eye_m = nearest_image(*chart, box, eye_m_);
    q = chart->inverse_edges() * (eye_m - chart->origin_m());
  } else {
    q = static_cast<const ShellChart&>(*info.chart).coordinates(key.root(), eye_m);
    // An eye on the axis of a neighbouring face has no angle on this one: any is as near.
    for (int axis = 0; axis < 3; ++axis)
      if (std::isnan(q[axis])) q[axis] = 0.5;
  }
  const glm::dvec3 clamped = glm::clamp(q, box.low, box.high);
  double distance_m = glm::length(info.chart->ecef_m({key.root(), clamped}) - eye_m);
  for (const glm::dvec3& point : shape.grid_m)
    distance_m = std::min(distance_m, glm::length(point - eye_m));

  // A split of the height alone opens the way to those of width that follow it.
  int last = key.level();
  while (info.lattice.split_axes(last) == kSplitZ && last + 1 < info.lattice.max_level()) ++last;
  double voxel_m = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (splits(info.lattice.split_axes(key.level()), axis) ||
        splits(info.lattice.split_axes(last), axis))
      voxel_m = std::max(voxel_m, shape.edge_m[axis] / kBrickCells);
  // An eye in the node looks at voxels from half a voxel away.
  const double pixels = voxel_m / (std::max(distance_m, voxel_m / 2) * pixel_rad_);
  const double length_m = std::max({shape.edge_m.x, shape.edge_m.y, shape.edge_m.z});
  double share = 1;
  if (!seen(info, shape)) share = shadows_seen(info, shape) ? kOffScreen : kNoShadow;
  return {share * pixels, length_m, shape.path_m(eye_m)};
}

}  // namespace nepho
