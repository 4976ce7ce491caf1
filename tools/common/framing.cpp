#include "common/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/error.h"

namespace nepho {
namespace {

constexpr std::size_t kEnoughNodes = 10000;  // about 1/20 of the cloud's extent each
constexpr double kDefaultFov_rad = 0.6;      // 34 degrees: a portrait lens
constexpr double kMargin = 1.08;             // air around the cloud
constexpr double kViewAzimuth_rad = 0.6;     // looking north-north-east, the cloud's corner ahead
constexpr double kLookUp_rad = 0.14;         // from below: the horizon stays low
constexpr double kLookDown_rad = 0.35;       // on a layer
constexpr double kLookIntoLayer_rad = 0.9;   // on one without an end: no horizon in sight
constexpr double kFlat = 0.15;               // a layer: height over width

void add_corners(const VolumeInfo& info, NodeKey key, std::vector<glm::dvec3>& points) {
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const Index3 sample = Lattice::global_sample(
        key,
        {kBrickCells * (corner & 1), kBrickCells * (corner >> 1 & 1), kBrickCells * (corner >> 2)});
    points.push_back(info.chart->ecef_m({key.root(), info.lattice.q(key.level(), sample)}));
  }
}

struct Extent {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double size() const { return high - low; }
  double middle() const { return low + 0.5 * size(); }
};

struct Extents {
  Extent x, y, z;
};

Extents extents(std::span<const glm::dvec3> points, const glm::dvec3& x, const glm::dvec3& y,
                const glm::dvec3& z) {
  Extents result;
  for (const glm::dvec3& p : points) {
    result.x.add(glm::dot(p, x));
    result.y.add(glm::dot(p, y));
    result.z.add(glm::dot(p, z));
  }
  return result;
}

// How far back from `target` the eye must be for every point to lie inside the picture.
double distance_that_holds(std::span<const glm::dvec3> points, const glm::dvec3& target,
                           const glm::dvec3& right, const glm::dvec3& upward,
                           const glm::dvec3& forward, double tan_x, double tan_y) {
  double distance = 0;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 d = p - target;
    const double ahead = glm::dot(d, forward);
    distance = std::max({distance, std::abs(glm::dot(d, right)) / tan_x - ahead,
                         std::abs(glm::dot(d, upward)) / tan_y - ahead});
  }
  return distance;
}

// The eye nearest to the points that sees them all in this direction. Each point keeps it behind
// four planes, x - ex <= (z - ez) tan_x and so on, so that the largest sums decide. Relative to
// `middle`, to keep the bits where the world's origin is far.
glm::dvec3 nearest_eye(std::span<const glm::dvec3> points, const glm::dvec3& middle,
                       const glm::dvec3& right, const glm::dvec3& upward, const glm::dvec3& forward,
                       double tan_x, double tan_y) {
  Extent x_plus, x_minus, y_plus, y_minus;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 d = p - middle;
    const double x = glm::dot(d, right), y = glm::dot(d, upward), z = glm::dot(d, forward);
    x_plus.add(x - tan_x * z);
    x_minus.add(-x - tan_x * z);
    y_plus.add(y - tan_y * z);
    y_minus.add(-y - tan_y * z);
  }
  const double ez = std::min(-(x_plus.high + x_minus.high) / (2 * tan_x),
                             -(y_plus.high + y_minus.high) / (2 * tan_y));
  return middle + 0.5 * (x_plus.high - x_minus.high) * right +
         0.5 * (y_plus.high - y_minus.high) * upward + ez * forward;
}

glm::dvec3 not_parallel(const glm::dvec3& up, const glm::dvec3& otherwise,
                        const glm::dvec3& forward) {
  return glm::length(glm::cross(forward, up)) > 1e-6 ? up : otherwise;
}

}  // namespace

NodeSummary summary_of(const BrickSource& source, NodeKey key, double time_s) {
  NodeSummary summary;
  const Status status = source.summary(key, time_s, summary);
  if (status != Status::kOk) {
    char text[512] = "";
    source.last_error(text, sizeof text);
    throw Error({to_string(status), "volume '" + source.info().name + "'", "", text, ""});
  }
  return summary;
}

std::vector<glm::dvec3> occupied_points(const BrickSource& source, double time_s) {
  const VolumeInfo& info = source.info();
  std::vector<NodeKey> nodes;
  std::vector<glm::dvec3> points;
  for (int root = 0; root < info.chart->roots(); ++root) nodes.emplace_back(root, 0, 0u, 0u, 0u);
  while (!nodes.empty()) {
    const bool enough = nodes.size() >= kEnoughNodes;
    std::vector<NodeKey> finer;
    for (const NodeKey key : nodes) {
      const NodeSummary summary = summary_of(source, key, time_s);
      const bool finest = key.level() == info.lattice.max_level();
      const bool uniform = summary.constant && summary.max_extinction_per_m > 0;
      // A coarse brick may hold a neighbour's cloud on its face and nothing below.
      if (finest ? summary.empty : summary.children == 0 && !uniform) continue;
      if (enough || finest || uniform) {
        add_corners(info, key, points);
        continue;
      }
      const SplitMask mask = info.lattice.split_axes(key.level());
      for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
        if ((octant & ~mask) == 0 && (summary.children >> octant & 1))
          finer.push_back(key.child(mask, octant));
    }
    nodes = std::move(finer);
  }
  return points;
}

Camera frame_camera(std::span<const glm::dvec3> points, const LocalAxes& axes,
                    const CameraSpec& wish, double aspect, bool endless) {
  Camera camera;
  camera.vertical_fov_rad = wish.vertical_fov_rad.value_or(kDefaultFov_rad);
  const Extents size = extents(points, axes.east, axes.north, axes.up);
  const bool flat = size.z.size() < kFlat * std::min(size.x.size(), size.y.size());
  const double pitch_rad = endless ? -kLookIntoLayer_rad : flat ? -kLookDown_rad : kLookUp_rad;
  const glm::dvec3 horizontal =
      std::sin(kViewAzimuth_rad) * axes.east + std::cos(kViewAzimuth_rad) * axes.north;
  glm::dvec3 forward = std::cos(pitch_rad) * horizontal + std::sin(pitch_rad) * axes.up;

  camera.target_m = wish.target_m.value_or(
      size.x.middle() * axes.east + size.y.middle() * axes.north + size.z.middle() * axes.up);
  if (wish.eye_m) forward = glm::normalize(camera.target_m - *wish.eye_m);
  camera.up = not_parallel(wish.up.value_or(axes.up), axes.north, forward);
  if (wish.eye_m) {
    camera.eye_m = *wish.eye_m;
    return camera;
  }
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 upward = glm::cross(right, forward);
  const double tan_y = std::tan(camera.vertical_fov_rad / 2) / kMargin, tan_x = tan_y * aspect;
  if (wish.target_m) {
    camera.eye_m = camera.target_m - forward * distance_that_holds(points, camera.target_m, right,
                                                                   upward, forward, tan_x, tan_y);
    return camera;
  }
  camera.eye_m = nearest_eye(points, camera.target_m, right, upward, forward, tan_x, tan_y);
  camera.target_m = camera.eye_m + forward * glm::dot(camera.target_m - camera.eye_m, forward);
  return camera;
}

glm::dvec3 sun_over_left_shoulder(const Camera& camera, const glm::dvec3& up) {
  constexpr double elevation_rad = glm::radians(40.0), aside_rad = glm::radians(55.0);
  glm::dvec3 view = glm::normalize(camera.target_m - camera.eye_m);
  // Looking straight down or up, the picture's upper edge says where "ahead" is.
  if (glm::length(glm::cross(view, up)) < 1e-6) view = camera.up;
  glm::dvec3 ahead = view - glm::dot(view, up) * up;
  ahead = glm::length(ahead) > 0 ? glm::normalize(ahead) : glm::dvec3(0, 1, 0);
  const glm::dvec3 left = glm::cross(up, ahead);
  return std::cos(elevation_rad) * (std::sin(aside_rad) * left - std::cos(aside_rad) * ahead) +
         std::sin(elevation_rad) * up;
}

}  // namespace nepho
