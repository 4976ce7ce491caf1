#include "forecast/water/level_heights.h"

#include <cmath>

namespace nepho::forecast {

void interfaces_of_levels_m(std::span<const double> level_m, double ground_m,
                            std::span<float> interface_m) {
  const std::size_t nz = level_m.size();
  for (std::size_t k = 1; k < nz; ++k) interface_m[k] = float(0.5 * (level_m[k - 1] + level_m[k]));
  const double low_half = nz > 1 ? 0.5 * (level_m[1] - level_m[0]) : 0.5;
  const double high_half = nz > 1 ? 0.5 * (level_m[nz - 1] - level_m[nz - 2]) : 0.5;
  double bottom = level_m[0] - low_half;
  if (ground_m < level_m[0] && bottom < ground_m) bottom = ground_m;
  interface_m[0] = float(bottom);
  interface_m[nz] = float(level_m[nz - 1] + high_half);
}

std::size_t make_rising(std::vector<float>& height_m, std::size_t count) {
  std::size_t lifted = 0;
  for (std::size_t first = 0; first + count <= height_m.size(); first += count) {
    if (!std::isfinite(height_m[first])) {
      height_m[first] = 0;
      ++lifted;
    }
    for (std::size_t k = 1; k < count; ++k) {
      float& here = height_m[first + k];
      const float least = height_m[first + k - 1] + kThinnestLayer_m;
      if (here >= least) continue;  // NaN is not
      here = least;
      ++lifted;
    }
  }
  return lifted;
}

}  // namespace nepho::forecast
