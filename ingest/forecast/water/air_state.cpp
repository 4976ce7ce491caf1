#include "forecast/conventions/model.h"
#include "forecast/water/air.h"

namespace nepho::forecast {

Air::State Air::at(std::size_t k, std::size_t n, std::size_t cells) const {
  State state{};
  const std::size_t at = k * cells + n;
  state.pressure_Pa = pressure_Pa.empty() ? level_pressure_Pa[k] : double(pressure_Pa[at]);
  if (temperature_K.empty() && level_temperature_K.empty()) {
    state.temperature_K = standard_temperature_K(standard_geopotential_height_m(state.pressure_Pa));
  } else {
    state.temperature_K =
        temperature_K.empty() ? level_temperature_K[k] : double(temperature_K[at]);
    if (is_theta)
      state.temperature_K = temperature_of_theta_K(state.temperature_K, state.pressure_Pa);
  }
  double q = vapour.empty() ? 0 : double(vapour[at]);
  if (!(q > 0)) q = 0;  // missing vapour is dry air: 1 % of the density
  if (vapour_is == Vapour::kMixingRatio) q = q / (1 + q);
  if (vapour_is == Vapour::kRelative)
    q = specific_humidity(q, state.temperature_K, state.pressure_Pa);
  state.specific_humidity = q;
  state.density_kg_per_m3 =
      !density_kg_per_m3.empty() ? double(density_kg_per_m3[at])
      : !level_density_kg_per_m3.empty()
          ? level_density_kg_per_m3[k]
          : moist_density_kg_per_m3(state.pressure_Pa, state.temperature_K, q);
  state.dry_density_kg_per_m3 = state.density_kg_per_m3 * (1 - q);
  return state;
}

}  // namespace nepho::forecast
