#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace nepho::test {

// Integer hash and plain arithmetic only: the same bits on every machine.
inline double lattice_noise(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = std::uint64_t(x) * 0x9e3779b97f4a7c15u ^
                    std::uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^ std::uint64_t(z) * 0x165667b19e3779f9u;
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
  return double((h ^ h >> 32) >> 11) * 0x1p-53;
}

inline double value_noise(glm::dvec3 p) {
  const glm::dvec3 c = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const glm::dvec3 f = p - c;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const double weight = (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z);
    sum +=
        weight * lattice_noise(std::int64_t(c.x) + x, std::int64_t(c.y) + y, std::int64_t(c.z) + z);
  }
  return sum;
}

// Thresholded fractal noise: mostly zero, with sharp edges at every scale.
inline double cloud(glm::dvec3 p) {
  double sum = 0, amplitude = 0.5;
  for (int octave = 0; octave < 4; ++octave, amplitude *= 0.5, p = 2.0 * p)
    sum += amplitude * value_noise(p);
  return 0.05 * std::max(0.0, sum - 0.52);
}

// A few smooth puffs around the points of a cube, on the scale of 1.
inline double puffs(glm::dvec3 p) {
  const glm::dvec3 f =
      p - glm::dvec3{std::floor(p.x) + 0.5, std::floor(p.y) + 0.5, std::floor(p.z) + 0.5};
  return 0.02 * std::exp(-12 * dot(f, f));
}

}  // namespace nepho::test
