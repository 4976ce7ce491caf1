#include "forecast/water/assumed_water.h"

#include <algorithm>
#include <cmath>

namespace nepho::forecast {
namespace {

constexpr double kSurfaceWater_kg_per_m3 = 0.21e-3, kScale_m = 700;

}  // namespace

std::vector<float> water_of_fraction(std::span<const float> fraction, const Air& air,
                                     std::span<const float> interface_m, std::size_t cells) {
  const std::size_t nz = fraction.size() / cells;
  std::vector<float> water(fraction.size());
  for (std::size_t n = 0; n < cells; ++n) {
    const float* z = &interface_m[n * (nz + 1)];
    double vapour = air.vapour.empty() ? kAssumedVapour_kg_per_m2 : 0;
    for (std::size_t k = 0; !air.vapour.empty() && k < nz; ++k) {
      const Air::State state = air.at(k, n, cells);
      const double here =
          state.specific_humidity * state.density_kg_per_m3 * (double(z[k + 1]) - double(z[k]));
      if (std::isfinite(here)) vapour += here;
    }
    // No vapour at all leaves a scale of nothing: as dry as 1 g/m2.
    const double scale_m = kScale_m * std::log1p(std::max(vapour, 1e-3));
    for (std::size_t k = 0; k < nz; ++k) {
      const double middle_m = 0.5 * (double(z[k]) + double(z[k + 1])) - double(z[0]);
      const float part = fraction[k * cells + n];
#ifdef NEPHO_MUTANT_WHOLE_CELL
      const float cut = part > 0 ? 1 : part;
#else
      const float cut = std::isnan(part) ? part : std::clamp(part, 0.f, 1.f);
#endif
      water[k * cells + n] =
          float(double(cut) * kSurfaceWater_kg_per_m3 * std::exp(-middle_m / scale_m));
    }
  }
  return water;
}

}  // namespace nepho::forecast
