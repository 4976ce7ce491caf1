#pragma once

#include <vector>

#include "sample_grid.h"

namespace nepho::samples {

// A fair-weather cumulus, y up: a flat base at the condensation level, turrets of bubbles upon
// bubbles, and noise of cells on their skin. Made, not simulated; deterministic.
//
// Extinction grows with height over the base as the adiabatic liquid water does (water ~ h, so
// extinction ~ h^(2/3) for a fixed number of droplets), is diluted near the skin by mixing, and
// fades in ragged skirts below the flanks. Density 1 is the most; 0.06 1/m makes it real.
struct CumulusShape {
  double voxel_m = 20;
  Voxel size{160, 120, 160};
  std::uint64_t seed = 7;
};

struct Bubble {
  glm::dvec3 centre_m;
  double radius_m;
  double blend_m;  // over which it melts into its neighbours
};

class Cumulus {
 public:
  explicit Cumulus(const CumulusShape& shape);
  // The position is relative to the middle of the base.
  double density(const glm::dvec3& p_m) const;
  // With only the bubbles that reach this box: the same values within it, faster.
  Cumulus near(const glm::dvec3& centre_m, double radius_m) const;

 private:
  void grow(Bubble parent, int generations, class Dice& dice);
  double skin_distance(const glm::dvec3& p_m) const;

  CumulusShape shape_;
  double top_m_;
  std::vector<Bubble> bubbles_;
};

SampleGrid make_cumulus(const CumulusShape& shape);

}  // namespace nepho::samples
