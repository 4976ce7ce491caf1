#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace nepho::noise {

// Noise that is *exactly* standard normal at every point, over the draw of its seed: lattice values
// are normal (a table of 2048 quantiles behind an integer hash), weights w are divided by
// sqrt(sum w^2). Then a sum of octaves is normal too, and the closure E f(m + s Z) is the exact
// expectation over the octaves that a level leaves out. Shapes that are not normal (billows, cells)
// are bent through their own distribution until they are; level sets stay where they were.
// Values are clipped to +-kTail (6e-5 of them). C2 between lattice points. Same bits everywhere.

// Value noise, cells of 1: weights are quintic (Perlin, 2002).
double value_noise(const glm::dvec3& p, std::uint32_t seed);
double value_noise(const glm::dvec2& p, std::uint32_t seed);

// Bounds over a box of lattice coordinates: exact corners of the interpolation, cell by cell; the
// clip where the box touches more than 27 (9) cells.
struct Range {
  double low = 0, high = 0;
};
Range value_noise_range(const glm::dvec3& low, const glm::dvec3& high, std::uint32_t seed);
Range value_noise_range(const glm::dvec2& low, const glm::dvec2& high, std::uint32_t seed);

// Rounded lobes with sharp creases between them, Phi^-1(2 Phi(|n|) - 1): high in a lobe.
double billow(double normal);
// Distance to the second nearest minus to the nearest of one point per cell (Worley, 1996; jitter
// 0.9), as a standard normal: low on the borders between cells, high in their middles.
double cells(const glm::dvec2& p, std::uint32_t seed);
// The same before it is bent: for the test of its table.
double cell_border_distance(const glm::dvec2& p, std::uint32_t seed);

// Bounds within `radius` of p: the distance changes by at most 2 per unit.
Range cells_range(const glm::dvec2& p, double radius, std::uint32_t seed);

std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

}  // namespace nepho::noise
