#pragma once

#include <span>
#include <vector>

#include "forecast/conventions/model.h"

namespace nepho::forecast {

// Water of clouds of which only the fraction is known, as CCM3 prescribes it (Kiehl et al. 1998,
// doi:10.1175/1520-0442(1998)011<1131:TNCFAR>2.0.CO;2): the cloudy part of a cell holds
// 0.21 g/m3 exp(-z / h) at the height z over the ground, h = 700 m ln(1 + w), w the column's vapour
// in kg/m2; ice from -10 degC (none) to -30 degC (all).
inline constexpr double kAssumedIce_K = 243.15, kAssumedLiquid_K = 263.15;
// Of a file without vapour: the mean of the globe.
inline constexpr double kAssumedVapour_kg_per_m2 = 25;

// kg/m3 of the whole cell, [k][cells]; fractions are in [0, 1] (cut to it) or NaN, which stays.
std::vector<float> water_of_fraction(std::span<const float> fraction, const Air& air,
                                     std::span<const float> interface_m, std::size_t cells);

}  // namespace nepho::forecast
