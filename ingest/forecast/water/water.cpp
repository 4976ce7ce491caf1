#include "forecast/water/water.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "units/constants.h"

namespace nepho::forecast {
namespace {

using namespace constants;
constexpr double kPi = std::numbers::pi;
constexpr double kWavelength_m = 550e-9;

// Martin et al.'s fits to aircraft: droplets per cm3 from aerosol particles per cm3.
constexpr double sea_number_per_cm3(double aerosol) {
  return -1.15e-3 * aerosol * aerosol + 0.963 * aerosol + 5.30;
}
constexpr double land_number_per_cm3(double aerosol) {
  return -2.10e-4 * aerosol * aerosol + 0.568 * aerosol - 27.9;
}

}  // namespace

const char* name_of(Species species) {
  switch (species) {
    case Species::kCloudWater:
      return "cloud water";
    case Species::kRain:
      return "rain";
    case Species::kCloudIce:
      return "cloud ice";
    case Species::kSnow:
      return "snow";
    case Species::kGraupel:
      return "graupel";
  }
  return "";
}

bool is_ice(Species species) {
  return species != Species::kCloudWater && species != Species::kRain;
}

Droplets droplets_over(double land) {
  const double sea = sea_number_per_cm3(50), continent = land_number_per_cm3(900);
  return {1e6 * (sea + (continent - sea) * land), 0.77 + (0.69 - 0.77) * land};
}

double droplet_radius_m(double in_cloud_kg_per_m3, const Droplets& droplets) {
  const double cubed =
      3 * in_cloud_kg_per_m3 /
      (4 * kPi * kWaterDensity_kg_per_m3 * droplets.k * std::max(droplets.number_per_m3, 1.0));
  return std::clamp(std::cbrt(cubed), 4e-6, 30e-6);
}

double droplet_efficiency(double radius_m) {
#ifdef NEPHO_MUTANT_GEOMETRIC
  return 2;
#endif
  return 2 + 2.12 * std::pow(2 * kPi * radius_m / kWavelength_m, -2.0 / 3);
}

double ice_radius_m(double in_cloud_kg_per_m3, double temperature_K, double latitude_deg) {
  const double content_g_per_m3 = std::max(in_cloud_kg_per_m3, 0.0) * 1e3;
  const double celsius = temperature_K - kZeroCelsius_K;
  // Both powers are of one logarithm.
  const double log_content = std::log(std::max(content_g_per_m3, 1e-30));
  const double diameter_um = (1.2351 + 0.0105 * celsius) *
                             (45.8966 * std::exp(0.2214 * log_content) +
                              0.7957 * std::exp(0.2535 * log_content) * (temperature_K - 83.15));
  const double smallest_um = 20 + 40 * std::cos(latitude_deg * kPi / 180);
  return 0.64952e-6 * std::clamp(diameter_um, smallest_um, 155.0);
}

double droplet_extinction_m2_per_kg(double radius_m) {
  return 3 * droplet_efficiency(radius_m) / (4 * kWaterDensity_kg_per_m3 * radius_m);
}

double ice_extinction_m2_per_kg(double radius_m) {
  return 3 / (2 * kIceDensity_kg_per_m3 * radius_m);
}

double precipitation_extinction_m2_per_kg(Species species, double content_kg_per_m3,
                                          double temperature_K) {
  double number_per_m4 = 8e6, density = kWaterDensity_kg_per_m3;
  if (species == Species::kSnow) {
    const double below_freezing_K = std::clamp(kZeroCelsius_K - temperature_K, 0.0, 90.0);
    number_per_m4 = 2e6 * std::exp(0.12 * below_freezing_K);
    density = 100;
  } else if (species == Species::kGraupel) {
    number_per_m4 = 4e6;
    density = 500;
  }
  // Mass pi rho N0 D0^4, and twice the cross-section pi/4 N0 2 D0^3: extinction / mass is
  // 1 / (rho D0).
  const double diameter_m =
      std::sqrt(std::sqrt(std::max(content_kg_per_m3, 1e-12) / (kPi * density * number_per_m4)));
  return 1 / (density * diameter_m);
}

}  // namespace nepho::forecast
