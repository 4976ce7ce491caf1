#include "gl/ground_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace nepho::gl {
namespace {

constexpr double kPerFeature = 1.5;   // pixels' distance, in widths of what is told apart there
constexpr double kLeastSine = 0.02;   // of the angle at which the ground is seen, or lit
constexpr double kDisc_rad = 0.0047;  // the sun's radius
constexpr double kDiscMargin_pixels = 2;

glm::dvec3 vec(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

// Moved along `along` onto the plane across `up`.
glm::dvec3 projected(const glm::dvec3& v, const glm::dvec3& along, const glm::dvec3& up) {
  const double sine = glm::dot(along, up);
  const double least = sine < 0 ? std::min(sine, -kLeastSine) : std::max(sine, kLeastSine);
  return v - along * (glm::dot(v, up) / least);
}

// The least width, in any direction, of the shadow that one voxel of this leaf casts on level
// ground.
double shadow_width_m(const VolumeInfo& info, NodeKey key, const glm::dvec3& to_sun) {
  const Index3 nodes = info.lattice.nodes(key.level());
  glm::dvec3 middle, edge_q;
  const std::array<std::uint32_t, 3> at = key.ijk();
  for (std::size_t a = 0; a < 3; ++a) {
    middle[int(a)] = (double(at[a]) + 0.5) / double(nodes[a]);
    edge_q[int(a)] = 1.0 / (double(kBrickCells) * double(nodes[a]));
  }
  const glm::dvec3 center_m = info.chart->ecef_m({int(key.root()), middle});
  const glm::dvec3 up = glm::normalize(center_m);
  std::array<glm::dvec3, 3> edges_m;
  for (int a = 0; a < 3; ++a) {
    glm::dvec3 q = middle;
    q[a] += edge_q[a];
    edges_m[std::size_t(a)] =
        projected(info.chart->ecef_m({int(key.root()), q}) - center_m, to_sun, up);
  }
  const glm::dvec3 level = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 east = glm::normalize(glm::cross(level, up)), north = glm::cross(up, east);
  double least_m = std::numeric_limits<double>::infinity();
  constexpr int kDirections = 8;
  for (int d = 0; d < kDirections; ++d) {
    const double angle = std::numbers::pi * d / kDirections;
    const glm::dvec3 across = std::cos(angle) * east + std::sin(angle) * north;
    double width_m = 0;
    for (const glm::dvec3& edge : edges_m) width_m += std::abs(glm::dot(edge, across));
    least_m = std::min(least_m, width_m);
  }
  return least_m;
}

// The least that pixels on the ground have to tell apart: shadows of single voxels, cells of the
// map.
double least_feature_m(const RenderRequest& request, const Forest& forest,
                       const PlanetScene& planet) {
  double least_m =
      planet.terrain ? double(planet.data.surface_cell_m) : std::numeric_limits<double>::infinity();
  for (const VolumeTree& tree : forest.volumes)
    for (const TreeNode& node : tree.nodes)
      if (node.seen && node.kind == NodeKind::kBrick)
        least_m =
            std::min(least_m, shadow_width_m(tree.source->info(), node.key, request.sun.to_sun));
  return least_m;
}

// A tile of the plan: the ray through its middle, and how ray and ground move with a pixel.
class TileRay {
 public:
  TileRay(const FrameData& frame, int x, int y) : frame_(frame) {
    const double half = 0.5 * (kStrideTile - 1);
    direction_ = towards(x * kStrideTile + half, y * kStrideTile + half);
    const double middle_x = x * kStrideTile + half, middle_y = y * kStrideTile + half;
    by_x_ = towards(middle_x + 1, middle_y) - direction_;
    by_y_ = towards(middle_x, middle_y + 1) - direction_;
  }
  // Metres of level ground between the neighbours of a row, or of a column.
  double step_m(bool along_y, double distance_m) const {
    const glm::dvec3 up = glm::normalize(vec(frame_.eye_m) + distance_m * direction_);
    return distance_m * glm::length(projected(along_y ? by_y_ : by_x_, direction_, up));
  }
  bool near_sun() const {
    const double pixel_rad = std::max(glm::length(by_x_), glm::length(by_y_));
    const double angle = 2 * std::asin(std::min(0.5 * glm::length(direction_ - sun()), 1.0));
    return angle < kDisc_rad + (kStrideTile / std::numbers::sqrt2 + kDiscMargin_pixels) * pixel_rad;
  }

 private:
  glm::dvec3 sun() const { return vec(frame_.to_sun); }
  glm::dvec3 towards(double x, double y) const {
    return glm::normalize(vec(frame_.forward) +
                          ((2 * x + 1) / frame_.width - 1) * vec(frame_.right) +
                          (1 - (2 * y + 1) / frame_.height) * vec(frame_.up));
  }
  const FrameData& frame_;
  glm::dvec3 direction_, by_x_, by_y_;
};

std::uint8_t stride_of(double pixels) {
#if defined(NEPHO_MUTANT_PIXEL_GROUND)
  pixels = 1e9;
#endif
  return pixels >= 8 ? 8 : pixels >= 4 ? 4 : pixels >= 2 ? 2 : 1;
}

}  // namespace

GroundTiles ground_tiles(const RenderRequest& request, const Forest& forest, const FrameData& frame,
                         const PlanetScene& planet, const PixelValues& values) {
  const int columns = (frame.width + kStrideTile - 1) / kStrideTile;
  const int rows = (frame.height + kStrideTile - 1) / kStrideTile;
  // The ground's greatest distance in each tile; negative where it shows none.
  std::vector<float> distance_m(std::size_t(columns) * std::size_t(rows), -1.0f);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const float here = values.met[std::size_t(y) * std::size_t(frame.width) + std::size_t(x)][3];
      float& most = distance_m[std::size_t(y / kStrideTile * columns + x / kStrideTile)];
      if (here < kNoGround_m) most = std::max(most, here);
    }
  GroundTiles tiles;
  tiles.strides.x.assign(distance_m.size(), kStrideTile);
  tiles.strides.y = tiles.strides.x;
  tiles.near_sun.assign(distance_m.size(), 0);
  const double apart_m = kPerFeature * least_feature_m(request, forest, planet);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const auto at = std::size_t(y * columns + x);
      const TileRay ray(frame, x, y);
      const double ground_m = double(distance_m[at]);
      if (ground_m >= 0) {
        tiles.strides.x[at] = stride_of(apart_m / ray.step_m(false, ground_m));
        tiles.strides.y[at] = stride_of(apart_m / ray.step_m(true, ground_m));
      }
      tiles.near_sun[at] = ray.near_sun();
      if (tiles.near_sun[at]) tiles.strides.x[at] = tiles.strides.y[at] = 1;
    }
  return tiles;
}

}  // namespace nepho::gl
