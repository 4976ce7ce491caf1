#pragma once

#include <array>
#include <cstdint>

#include "optics/phase_table.h"

namespace nepho {

// The committed table, made by tools/make_mie_table: one row per effective radius.
struct MieRow {
  double effective_radius_m;
  PhaseBulk bulk;
  // 1e4 ln P, with P of mean 1 over the sphere: rounded to 5e-5 relative.
  std::array<std::array<std::int32_t, kPhaseTexels>, 3> log_phase_1e4;
};
inline constexpr double kMieTableStep = 1e-4;
// Close enough for the asymmetry between two rows to be interpolated within 5e-4.
inline constexpr std::array<double, 15> kMieRadii_m{4e-6,   4.5e-6,  5e-6,  5.7e-6,  6.5e-6,
                                                    7.2e-6, 8e-6,    9e-6,  10e-6,   11.8e-6,
                                                    14e-6,  16.7e-6, 20e-6, 24.5e-6, 30e-6};
inline constexpr double kMieVariance = 0.1;
inline constexpr int kMieIntegrationRadii = 8000;
// Water at kWavelengths_m: Hale & Querry (1973).
inline constexpr std::array<double, 3> kWaterIndex{1.331, 1.333, 1.337};
inline constexpr std::array<double, 3> kWaterAbsorption{1.64e-8, 1.96e-9, 1.02e-9};

// What the row must hold: the whole calculation of one radius and wavelength.
struct MieColumn {
  double asymmetry = 0, extinction_efficiency = 0, co_albedo = 0;
  std::array<std::int32_t, kPhaseTexels> log_phase_1e4{};
};
MieColumn compute_mie_column(double effective_radius_m, int wavelength);

const std::array<MieRow, kMieRadii_m.size()>& mie_rows();

}  // namespace nepho
