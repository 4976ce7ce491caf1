#include "sources/noise/land.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "sources/noise/lattice_noise.h"
#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

constexpr int kPerHalfTurn = 360;
constexpr double kShore = 0.03;  // standard deviations from land to water: about a node

// Fractal noise of Hurst exponent 0.8, from 5000 km down to the grid's own spacing.
double relief(const glm::dvec3& direction, std::uint32_t seed) {
  double sum = 0, amplitude = 1, per_radius = 1.3;
  for (std::uint32_t octave = 0; octave < 7; ++octave) {
    const glm::dvec3 p = per_radius * direction + glm::dvec3(7.3, 2.9, 5.1) * double(octave + 1);
    sum += amplitude * value_noise(p, seed + 0x51ed270bu * octave);
    amplitude *= 0.56, per_radius *= 2.03;
  }
  return sum;
}

}  // namespace

std::shared_ptr<const SurfaceMap> make_land(double land, std::uint32_t seed) {
  if (!(land > 0)) return nullptr;
  auto map = std::make_shared<SurfaceMap>();
  const double step_rad = std::numbers::pi / kPerHalfTurn;
  map->low_rad = {-std::numbers::pi, -std::numbers::pi / 2};
  map->step_rad = {step_rad, step_rad};
  map->nx = 2 * kPerHalfTurn, map->ny = kPerHalfTurn + 1;
  map->around = true;
  const std::size_t count = std::size_t(map->nx) * std::size_t(map->ny);
  std::vector<double> height(count);
  std::vector<std::pair<double, double>> by_height;  // and area
  for (int j = 0; j < map->ny; ++j) {
    const glm::dvec2 up = cosine_sine(map->low_rad.y + j * step_rad);
    const double level = std::max(up.x, 0.0);
    for (int i = 0; i < map->nx; ++i) {
      const glm::dvec2 around = cosine_sine(map->low_rad.x + i * step_rad);
      const double h = relief({level * around.x, level * around.y, up.y}, seed);
      height[std::size_t(i) + std::size_t(map->nx) * std::size_t(j)] = h;
      by_height.emplace_back(h, level);
    }
  }
  std::ranges::sort(by_height);
  double area = 0, all = 0, sea_level = by_height.front().first - 1;
  for (const auto& [h, part] : by_height) all += part;
  for (const auto& [h, part] : by_height) {
    if (area >= (1 - land) * all) break;
    sea_level = h, area += part;
  }
  map->height_m.assign(count, 0);
  for (const double h : height)
    map->water.push_back(float(std::clamp(0.5 - (h - sea_level) / kShore, 0.0, 1.0)));
  return map;
}

}  // namespace nepho::noise
