#pragma once

#include <span>

namespace nepho::forecast {

// What a layer holds between its interfaces: a parabola in u, 0 at its bottom and 1 at its top,
// where equal steps of u are equal volumes. Its mean over u is the layer's.
struct Parabola {
  double low = 0, high = 0;  // at u = 0 and u = 1
  double six = 0;            // 6 (mean - (low + high) / 2)
  double operator()(double u) const { return low + u * (high - low + six * (1 - u)); }
};

// Colella & Woodward (1984), doi:10.1016/0021-9991(84)90143-8, equations 1.6 to 1.10, on layers of
// any `thickness` (> 0): a parabola for each `mean`, bottom to top. Each keeps its layer's mean, is
// monotone in it and stays between the means of the layers beside it, so that it is >= 0 where they
// are, and 0 in a layer of 0. Where values meet smoothly they are continuous; layers that are
// higher or lower than both neighbours are flat, and so are the lowest and the topmost, of whose
// other side nothing is known. All three spans have the same size.
void reconstruct(std::span<const double> thickness, std::span<const double> mean,
                 std::span<Parabola> profile);

}  // namespace nepho::forecast
