#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace nepho::samples {

// Noise from an integer hash and plain arithmetic (square root is the only function, and is exact):
// the same bits on every machine.

inline std::uint64_t hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = std::uint64_t(x) * 0x9e3779b97f4a7c15u ^
                    std::uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^
                    std::uint64_t(z) * 0x165667b19e3779f9u ^ seed * 0xd6e8feb86659fd93u;
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  return h ^ h >> 32;
}
inline double unit(std::uint64_t bits) {
  return double(bits & 0x1fffff) / double(0x200000);
}

// A sequence of numbers in [0, 1).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double operator()() { return unit(hash(std::int64_t(++count_), 0, 0, seed_)); }
  double operator()(double low, double high) { return low + (high - low) * (*this)(); }

 private:
  std::uint64_t seed_, count_ = 0;
};

// Gradient noise (Perlin, 2002: quintic weights, edge-midpoint gradients), about -1..1.
inline double gradient_noise(const glm::dvec3& p, std::uint64_t seed) {
  const glm::dvec3 cell = glm::floor(p), f = p - cell;
  const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    const std::uint64_t h = hash(std::int64_t(cell.x) + dx, std::int64_t(cell.y) + dy,
                                 std::int64_t(cell.z) + dz, seed) %
                            12;
    const double x = f.x - dx, y = f.y - dy, z = f.z - dz;
    const double a = h < 8 ? x : y, b = h < 4 ? y : z;
    const double slope = (h & 1 ? -a : a) + (h & 2 ? -b : b);
    sum += (dx ? w.x : 1 - w.x) * (dy ? w.y : 1 - w.y) * (dz ? w.z : 1 - w.z) * slope;
  }
  return sum;
}

inline double fractal_noise(glm::dvec3 p, int octaves, std::uint64_t seed) {
  double sum = 0, amplitude = 1;
  for (int octave = 0; octave < octaves; ++octave, amplitude *= 0.5, p *= 2.03)
    sum += amplitude * gradient_noise(p, seed + std::uint64_t(octave));
  return sum;
}

// Distance to the nearest of one random point per unit cell (Worley, 1996).
inline double cell_distance(const glm::dvec3& p, std::uint64_t seed) {
  const glm::dvec3 cell = glm::floor(p), f = p - cell;
  double nearest = 9;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::uint64_t h = hash(std::int64_t(cell.x) + dx, std::int64_t(cell.y) + dy,
                                     std::int64_t(cell.z) + dz, seed);
        const glm::dvec3 d = glm::dvec3(dx + unit(h), dy + unit(h >> 21), dz + unit(h >> 42)) - f;
        nearest = std::min(nearest, glm::dot(d, d));
      }
  return std::sqrt(nearest);
}

inline double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace nepho::samples
