#include <cmath>

#include "optics/mie.h"
#include "optics/mie_table.h"

namespace nepho {

MieColumn compute_mie_column(double effective_radius_m, int wavelength) {
  const auto w = std::size_t(wavelength);
  std::vector<double> cosines(kPhaseTexels);
  for (int texel = 0; texel < kPhaseTexels; ++texel)
    cosines[std::size_t(texel)] = std::cos(phase_texel_angle_rad(texel));
  const DropletOptics optics = droplet_optics({.effective_radius_m = effective_radius_m,
                                               .effective_variance = kMieVariance,
                                               .wavelength_m = kWavelengths_m[w],
                                               .index = {kWaterIndex[w], kWaterAbsorption[w]},
                                               .radii = kMieIntegrationRadii},
                                              cosines);
  MieColumn column{optics.asymmetry, optics.extinction_efficiency, optics.co_albedo, {}};
  for (std::size_t texel = 0; texel < optics.phase.size(); ++texel)
    column.log_phase_1e4[texel] =
        std::int32_t(std::lround(std::log(optics.phase[texel]) / kMieTableStep));
  return column;
}

}  // namespace nepho
