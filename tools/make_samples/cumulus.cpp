#include "cumulus.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "hash_noise.h"

namespace nepho::samples {
namespace {

// All lengths for a cloud of 3.2 km; other sizes scale with the box.
constexpr double kBox_m = 3200;
constexpr double kBaseHeight_m = 160;  // of the condensation level over the lowest voxels
constexpr double kMargin_m = 420;      // how far the skin's noise and the skirts reach

// A main tower that leans, its shoulders, and low ones around; heads are wider than their necks.
struct Turret {
  double x, z, neck_radius, head_radius, height;
};
constexpr Turret kTurrets[] = {
    {-260, -40, 300, 430, 1660}, {430, 120, 290, 370, 1270},  {-800, 260, 250, 290, 860},
    {110, -640, 270, 320, 900},  {-700, -480, 260, 250, 560}, {930, -230, 240, 260, 640},
    {-1150, -60, 210, 190, 370}, {760, 560, 250, 240, 500},   {-130, 760, 280, 300, 740},
    {1210, 170, 180, 170, 290},  {480, -860, 220, 200, 350},  {-470, 950, 210, 190, 330},
    {40, 120, 460, 300, 520},    {-480, -60, 420, 260, 450},  {520, -190, 400, 240, 420},
};

double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend / 4;
}

}  // namespace

Cumulus::Cumulus(const CumulusShape& shape) : shape_(shape), top_m_(0) {
  const double scale = shape.voxel_m * shape.size[0] / kBox_m;
  Dice dice(shape.seed);
  for (const Turret& turret : kTurrets) {
    // A stack of bubbles, wide at the foot, leaning a little.
    const double lean_x = dice(-0.08, 0.26), lean_z = dice(-0.2, 0.2);
    const int storeys = 3 + int(turret.height / 330);
    for (int storey = 0; storey < storeys; ++storey) {
      const double t = double(storey) / (storeys - 1);
      const double radius =
          turret.neck_radius + (turret.head_radius - turret.neck_radius) * t + dice(-30, 30);
      const double y = 30 + t * (turret.height - turret.head_radius);
      const glm::dvec3 centre = {turret.x + lean_x * y + dice(-50, 50), y,
                                 turret.z + lean_z * y + dice(-50, 50)};
      const Bubble bubble = {centre * scale, radius * scale, 70 * scale};
      bubbles_.push_back(bubble);
      grow(bubble, storey == storeys - 1 ? 3 : 2, dice);
    }
  }
  for (const Bubble& b : bubbles_) top_m_ = std::max(top_m_, b.centre_m.y + b.radius_m);
}

// Smaller bubbles sit on the upper and outer side of larger ones.
void Cumulus::grow(Bubble parent, int generations, Dice& dice) {
  if (generations == 0) return;
  const int children = generations == 3 ? 11 : 7;
  for (int child = 0; child < children; ++child) {
    const double up = dice(-0.25, 1.0), angle = dice(0, 6.283185307179586);
    const double side = std::sqrt(std::max(0.0, 1 - up * up));
    const glm::dvec3 direction = {side * std::cos(angle), up, side * std::sin(angle)};
    const double radius = parent.radius_m * dice(0.30, 0.52);
    const Bubble bubble = {parent.centre_m + direction * (parent.radius_m - 0.30 * radius), radius,
                           0.28 * radius};
    bubbles_.push_back(bubble);
    grow(bubble, generations - 1, dice);
  }
}

Cumulus Cumulus::near(const glm::dvec3& centre_m, double radius_m) const {
  Cumulus part = *this;
  const double reach_m = radius_m + kMargin_m * shape_.voxel_m * shape_.size[0] / kBox_m;
  std::erase_if(part.bubbles_, [&](const Bubble& b) {
    return glm::length(b.centre_m - centre_m) > b.radius_m + reach_m;
  });
  return part;
}

// Below 0 inside. The bubbles' distance, pushed out by cells that are rounded outside and creased
// between: the cauliflower at all the sizes that the voxels can show.
double Cumulus::skin_distance(const glm::dvec3& p_m) const {
  const double scale = shape_.voxel_m * shape_.size[0] / kBox_m;
  const std::uint64_t seed = shape_.seed * 1000;
  glm::dvec3 warp;
  for (int axis = 0; axis < 3; ++axis)
    warp[axis] = fractal_noise(p_m / (420 * scale), 2, seed + 10 * std::uint64_t(axis));
  const glm::dvec3 p = p_m + 48 * scale * warp;
  double distance = kMargin_m * scale;
  for (const Bubble& b : bubbles_)
    distance = smooth_min(distance, glm::length(p - b.centre_m) - b.radius_m, b.blend_m);
  if (distance > 200 * scale || distance < -400 * scale) return distance;
  const double sizes_m[] = {240, 120, 62};
  for (const double size_m : sizes_m) {
    const double cell = cell_distance(p / (size_m * scale), seed + std::uint64_t(size_m));
    distance -= 0.32 * size_m * scale * (0.75 - std::min(cell * cell, 1.2));
  }
  return distance;
}

double Cumulus::density(const glm::dvec3& p_m) const {
  const double scale = shape_.voxel_m * shape_.size[0] / kBox_m;
  const std::uint64_t seed = shape_.seed * 1000 + 500;
  // The condensation level: flat, but for a metre-scale waviness of the boundary layer.
  const double height_m = p_m.y + 14 * scale * fractal_noise(p_m / (260 * scale), 3, seed);
  const double base = smooth_step(-12 * scale, 26 * scale, height_m);
  if (base == 0 || bubbles_.empty()) return 0;
  const double distance_m = skin_distance(p_m);
  const double edge = smooth_step(9 * scale, -16 * scale, distance_m);

  // water ~ height over base; extinction ~ water^(2/3)
  const double rise = std::clamp(height_m / top_m_, 0.0, 1.0);
  const double adiabatic = 0.25 + 0.75 * std::cbrt(rise * rise);
  const double core = 0.45 + 0.55 * smooth_step(0, -170 * scale, distance_m);
  const double patches = 1 + 0.22 * fractal_noise(p_m / (150 * scale), 3, seed + 20);
  double density = edge * adiabatic * core * patches;

  // Skirts: torn shreds around the lower flanks, where the cloud evaporates.
  const double reach_m = (150 - 110 * rise) * scale;
  if (distance_m < reach_m) {
    const double shreds = fractal_noise(p_m * glm::dvec3(1, 1.7, 1) / (170 * scale), 4, seed + 40);
    const double fade = 1 - smooth_step(0, reach_m, distance_m);
    density = std::max(density, 0.16 * fade * (1 - 0.7 * rise) * smooth_step(0.12, 0.75, shreds));
  }
  return density * base < 2e-3 ? 0 : density * base;
}

SampleGrid make_cumulus(const CumulusShape& shape) {
  const Cumulus cumulus(shape);
  SampleGrid grid;
  grid.columns = glm::dmat3(shape.voxel_m);
  const double scale = shape.voxel_m * shape.size[0] / kBox_m;
  const glm::dvec3 middle_m = {0.5 * shape.voxel_m * shape.size[0], kBaseHeight_m * scale,
                               0.5 * shape.voxel_m * shape.size[2]};
  // The base stands at y = 0 of the file, above the middle.
  grid.translation = -middle_m;
  const Voxel high = {shape.size[0] - 1, shape.size[1] - 1, shape.size[2] - 1};
  // Per block, so that each voxel asks the few bubbles around it.
  const Voxel blocks = {shape.size[0] / 8, shape.size[1] / 8, shape.size[2] / 8};
  std::vector<Cumulus> parts(
      std::size_t(blocks[0]) * std::size_t(blocks[1]) * std::size_t(blocks[2]),
      Cumulus(cumulus).near({1e9, 0, 0}, 0));
  const auto part_of = [&](const Voxel& v) {
    return (std::size_t(v[2] / 8) * std::size_t(blocks[1]) + std::size_t(v[1] / 8)) *
               std::size_t(blocks[0]) +
           std::size_t(v[0] / 8);
  };
  tbb::parallel_for(0, blocks[2], [&](int z) {
    for (int y = 0; y < blocks[1]; ++y)
      for (int x = 0; x < blocks[0]; ++x) {
        const glm::dvec3 centre_m = shape.voxel_m * (8.0 * glm::dvec3(x, y, z) + 3.5) - middle_m;
        parts[part_of({8 * x, 8 * y, 8 * z})] = cumulus.near(centre_m, 6.1 * shape.voxel_m);
      }
  });
  grid.blocks = sample({0, 0, 0}, high, [&](const Voxel& v) {
    const glm::dvec3 p_m = shape.voxel_m * glm::dvec3(v[0], v[1], v[2]) - middle_m;
    return float(parts[part_of(v)].density(p_m));
  });
  return grid;
}

}  // namespace nepho::samples
