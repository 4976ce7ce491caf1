#include "live/seen_distance.h"

namespace nepho {
namespace {

// What a cloud hides of what is behind it, for the pixel to go where the cloud goes: the sky has no
// marks that would be missed, and the fringe of a bright cloud is a speck on dark ground where the
// cloud has moved on.
constexpr float kHidesSky = 0.02f, kHidesGround = 0.1f;

}  // namespace

std::vector<float> seen_distances(const gl::PixelValues& values, bool planet) {
  std::vector<float> distances_m(values.depths.size());
  for (std::size_t p = 0; p < distances_m.size(); ++p) {
    const auto [moment_m, part, start_m, behind_m] = values.depths[p];
    const float ground_m = planet ? values.met[p][3] : behind_m;
    const bool sky = !(ground_m < gl::kNoGround_m);
    distances_m[p] = part > (sky ? kHidesSky : kHidesGround) ? start_m + moment_m / part
                     : sky                                   ? gl::kNoGround_m
                                                             : start_m + ground_m;
  }
  return distances_m;
}

}  // namespace nepho
