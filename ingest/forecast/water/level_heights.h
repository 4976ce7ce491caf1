#pragma once

#include <span>
#include <string>
#include <vector>

namespace nepho::forecast {

// Interfaces (nz + 1) of levels (nz, rising): at mid height, and half a layer beyond both ends; the
// lowest not below `ground` where that is itself below the lowest level. NaN: no ground.
void interfaces_of_levels_m(std::span<const double> level_m, double ground_m,
                            std::span<float> interface_m);

// Columns of `count` heights each, made strictly rising: a height that is missing, or less than
// kThinnestLayer_m above the one below, is lifted. Returns how many were.
inline constexpr float kThinnestLayer_m = 0.1f;
std::size_t make_rising(std::vector<float>& height_m, std::size_t count);

}  // namespace nepho::forecast
