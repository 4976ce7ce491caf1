#include "forecast/bricks/layer_profile.h"

#include <algorithm>
#include <cmath>

namespace nepho::forecast {
namespace {

#ifdef NEPHO_MUTANT_LIMITER
constexpr bool kLimited = false;
#else
constexpr bool kLimited = true;
#endif

// A value, and the thickness of the layer that has it.
struct Layer {
  double h, mean;
};

// Difference across layer b from the parabola through three means, no steeper than to either
// neighbour's (1.7, 1.8).
double slope(Layer a, Layer b, Layer c) {
  const double down = b.mean - a.mean, up = c.mean - b.mean;
  const double parabola =
      b.h / (a.h + b.h + c.h) *
      ((2 * a.h + b.h) / (c.h + b.h) * up + (b.h + 2 * c.h) / (a.h + b.h) * down);
  if (!kLimited) return parabola;
  if (!(up * down > 0)) return 0;
  const double most = 2 * std::min(std::abs(up), std::abs(down));
  return std::clamp(parabola, -most, most);
}

// At the interface of b and c, from the quartic through four layers' integrals (1.6).
double edge(Layer a, Layer b, Layer c, Layer d, double slope_b, double slope_c) {
  const double below = (a.h + b.h) / (2 * b.h + c.h), above = (d.h + c.h) / (2 * c.h + b.h);
  const double step = c.mean - b.mean;
  const double bend = 2 * c.h * b.h / (b.h + c.h) * (below - above) * step - b.h * below * slope_c +
                      c.h * above * slope_b;
  const double value = b.mean + b.h / (b.h + c.h) * step + bend / (a.h + b.h + c.h + d.h);
  if (!kLimited) return value;
  return std::clamp(value, std::min(b.mean, c.mean), std::max(b.mean, c.mean));
}

// Flat at extremes; else bent so that it does not turn within the layer (1.10).
Parabola parabola(double mean, double low, double high) {
  if (kLimited) {
    const double rise = high - low, off = mean - 0.5 * (low + high);
    if (!((high - mean) * (mean - low) > 0))
      low = high = mean;
    else if (rise * off > rise * rise / 6)
      low = 3 * mean - 2 * high;
    else if (rise * off < -rise * rise / 6)
      high = 3 * mean - 2 * low;
  }
  return {low, high, 6 * (mean - 0.5 * (low + high))};
}

}  // namespace

void reconstruct(std::span<const double> thickness, std::span<const double> mean,
                 std::span<Parabola> profile) {
  const auto nz = std::ptrdiff_t(mean.size());
  // Beyond both ends the layer there goes on.
  const auto layer = [&](std::ptrdiff_t k) {
    const auto at = std::size_t(std::clamp(k, std::ptrdiff_t{0}, nz - 1));
    return Layer{thickness[at], mean[at]};
  };
  const auto slope_of = [&](std::ptrdiff_t k) {
    return slope(layer(k - 1), layer(k), layer(k + 1));
  };
  double low = nz > 0 ? mean[0] : 0, slope_here = nz > 0 ? slope_of(0) : 0;
  for (std::ptrdiff_t k = 0; k < nz; ++k) {
    const double slope_above = slope_of(k + 1);
    const double high =
        edge(layer(k - 1), layer(k), layer(k + 1), layer(k + 2), slope_here, slope_above);
    profile[std::size_t(k)] = parabola(mean[std::size_t(k)], low, high);
    low = high;
    slope_here = slope_above;
  }
}

}  // namespace nepho::forecast
