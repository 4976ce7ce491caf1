#pragma once

#include <array>
#include <vector>

#include "bricks/volume_info.h"

namespace nepho {

// Phase functions as look-up tables. Three wavelengths in the order of a picture's channels.
inline constexpr std::array<double, 3> kWavelengths_m{650e-9, 550e-9, 450e-9};
inline constexpr int kPhaseTexels = 1024;

// Texel i belongs to u = i / (kPhaseTexels - 1), u = sqrt(theta / pi) as in physics/phase.glsl, so
// both ends are texels: a filtered texture is asked at (u (kPhaseTexels - 1) + 1/2) / kPhaseTexels.
double phase_texel_angle_rad(int texel);

// Natural logarithm of the phase function (1/sr, integral over the sphere 1), kPhaseTexels x 3,
// wavelength fastest; between texels the logarithm is linear. Mie: water droplets, effective
// variance 0.1, interpolated between the radii of mie_table.inc in the logarithms of both, then
// normalised (integral 1 to 1e-6, asymmetry within 5e-4 of phase_bulk). Throws Error where the
// radius is outside 4 .. 30 um (HG + Draine: 2.5 .. 25 um) or |asymmetry| >= 1.
std::vector<float> phase_table(const Phase& phase);

// What comes with it, per wavelength. Other than Mie: extinction efficiency 2, no absorption.
struct PhaseBulk {
  std::array<double, 3> asymmetry{}, extinction_efficiency{}, co_albedo{};
};
PhaseBulk phase_bulk(const Phase& phase);

// Integral over the sphere, and mean cosine, of the curve that a table means, at one wavelength.
struct PhaseMoments {
  double integral = 0, asymmetry = 0;
};
// `end`: only of the part before this texel, forward of it.
PhaseMoments phase_table_moments(const std::vector<float>& table, int wavelength,
                                 int end = kPhaseTexels - 1);

}  // namespace nepho
