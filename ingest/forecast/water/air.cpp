#include "forecast/water/air.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "units/constants.h"

namespace nepho::forecast {
namespace {

using namespace constants;

constexpr double kGeopotentialRadius_m = 6356766;  // US Standard Atmosphere 1976
constexpr double kVirtual = kVapourGasConstant_J_per_kg_K / kDryAirGasConstant_J_per_kg_K - 1;
constexpr double kEpsilon = kDryAirGasConstant_J_per_kg_K / kVapourGasConstant_J_per_kg_K;
constexpr double kScale_m_per_K = kDryAirGasConstant_J_per_kg_K / kStandardGravity_m_per_s2;

struct StandardLayer {
  double base_m, temperature_K, lapse_K_per_m;
};
constexpr std::array<StandardLayer, 7> kStandard = {{{0, 288.15, -0.0065},
                                                     {11000, 216.65, 0},
                                                     {20000, 216.65, 0.001},
                                                     {32000, 228.65, 0.0028},
                                                     {47000, 270.65, 0},
                                                     {51000, 270.65, -0.0028},
                                                     {71000, 214.65, -0.002}}};

// Height gained from `base` down to a fraction of its pressure.
double rise_m(const StandardLayer& layer, double log_ratio) {
  if (layer.lapse_K_per_m == 0) return kScale_m_per_K * layer.temperature_K * log_ratio;
  return layer.temperature_K / layer.lapse_K_per_m *
         std::expm1(kScale_m_per_K * layer.lapse_K_per_m * log_ratio);
}

double log_ratio_of(const StandardLayer& layer, double rise) {
  if (layer.lapse_K_per_m == 0) return rise / (kScale_m_per_K * layer.temperature_K);
  return std::log1p(layer.lapse_K_per_m * rise / layer.temperature_K) /
         (kScale_m_per_K * layer.lapse_K_per_m);
}

// (a - b) / ln(a / b); the arithmetic mean is its limit, to 1e-9 where they are so near.
double logarithmic_mean(double a, double b) {
#if defined(NEPHO_MUTANT_LOWER_TEMPERATURE)
  b = a;
#endif
  const double ratio = (a - b) / (a + b);
  if (std::abs(ratio) < 1e-3) return 0.5 * (a + b) * (1 - ratio * ratio / 3);
  return (a - b) / std::log(a / b);
}

}  // namespace

double height_of_geopotential_height_m(double h) {
  return kGeopotentialRadius_m * h / (kGeopotentialRadius_m - h);
}

double specific_humidity(double relative_humidity, double temperature_K, double pressure_Pa) {
  const double celsius = temperature_K - kZeroCelsius_K;
  const double saturation_Pa = 611.2 * std::exp(17.67 * celsius / (celsius + 243.5));
  const double vapour_Pa =
      std::min(relative_humidity * saturation_Pa, 0.5 * pressure_Pa);  // no steam high up
  return kEpsilon * vapour_Pa / (pressure_Pa - (1 - kEpsilon) * vapour_Pa);
}

double virtual_temperature_K(double temperature_K, double q) {
  return temperature_K * (1 + kVirtual * q);
}

double moist_density_kg_per_m3(double pressure_Pa, double temperature_K, double q) {
  return pressure_Pa / (kDryAirGasConstant_J_per_kg_K * virtual_temperature_K(temperature_K, q));
}

double temperature_of_theta_K(double theta_K, double pressure_Pa) {
  return theta_K * std::pow(pressure_Pa / 1e5, 2.0 / 7);
}

double standard_pressure_Pa(double height_m) {
  double pressure = kStandardSurfacePressure_Pa;
  for (std::size_t n = 0;; ++n) {
    const bool last = n + 1 == kStandard.size() || height_m <= kStandard[n + 1].base_m;
    const double rise = (last ? height_m : kStandard[n + 1].base_m) - kStandard[n].base_m;
    pressure *= std::exp(-log_ratio_of(kStandard[n], rise));
    if (last) return pressure;
  }
}

double standard_geopotential_height_m(double pressure_Pa) {
  double base = kStandardSurfacePressure_Pa;
  for (std::size_t n = 0;; ++n) {
    const double rise = rise_m(kStandard[n], std::log(base / pressure_Pa));
    if (n + 1 == kStandard.size() || kStandard[n].base_m + rise <= kStandard[n + 1].base_m)
      return kStandard[n].base_m + rise;
    base *= std::exp(-log_ratio_of(kStandard[n], kStandard[n + 1].base_m - kStandard[n].base_m));
  }
}

double standard_temperature_K(double height_m) {
  std::size_t n = 0;
  while (n + 1 < kStandard.size() && height_m > kStandard[n + 1].base_m) ++n;
  return kStandard[n].temperature_K + kStandard[n].lapse_K_per_m * (height_m - kStandard[n].base_m);
}

void hypsometric_heights_m(std::span<const double> pressure_Pa, std::span<const double> tv_K,
                           double surface_pressure_Pa, double surface_height_m,
                           std::span<double> height_m) {
  for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
    const double below_Pa = k == 0 ? surface_pressure_Pa : pressure_Pa[k - 1];
    const double below_m = k == 0 ? surface_height_m : height_m[k - 1];
    const double mean_K = k == 0 ? tv_K[0] : logarithmic_mean(tv_K[k - 1], tv_K[k]);
    height_m[k] = below_m + kScale_m_per_K * mean_K * std::log(below_Pa / pressure_Pa[k]);
  }
}

double height_in_layers_m(std::span<const double> pressure_Pa, std::span<const double> tv_K,
                          std::span<const double> height_m, double at_Pa) {
  const std::size_t nz = pressure_Pa.size();
  std::size_t k = 0;  // the level below
  while (k + 1 < nz && pressure_Pa[k + 1] > at_Pa) ++k;
  double here_K = tv_K[k];
  if (at_Pa < pressure_Pa[k] && k + 1 < nz) {
    // Linear in height is a power of the pressure.
    const double power =
        std::log(tv_K[k + 1] / tv_K[k]) / std::log(pressure_Pa[k + 1] / pressure_Pa[k]);
    here_K = tv_K[k] * std::pow(at_Pa / pressure_Pa[k], power);
  }
  return height_m[k] +
         kScale_m_per_K * logarithmic_mean(tv_K[k], here_K) * std::log(pressure_Pa[k] / at_Pa);
}

}  // namespace nepho::forecast
