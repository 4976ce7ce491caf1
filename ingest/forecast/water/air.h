#pragma once

#include <span>
#include <string>
#include <vector>

namespace nepho::forecast {

// Moist air, and the heights of pressures in it. SI; scalars; NaN in, NaN out.

inline constexpr double kStandardSurfacePressure_Pa = 101325;

// Geometric height over sea level of a geopotential height (geopotential / 9.80665 m s-2):
// z = R H / (R - H), R the radius that the US Standard Atmosphere 1976 takes.
double height_of_geopotential_height_m(double geopotential_height_m);

// Specific humidity (kg per kg of moist air) of a relative humidity (a ratio), over water: Bolton
// (1980), doi:10.1175/1520-0493(1980)108<1046:TCOEPT>2.0.CO;2, eq. 10; 0.1 % from -30 to 35 degC.
double specific_humidity(double relative_humidity, double temperature_K, double pressure_Pa);

// T (1 + (Rv / Rd - 1) q) for q per kg of moist air.
double virtual_temperature_K(double temperature_K, double specific_humidity);
double moist_density_kg_per_m3(double pressure_Pa, double temperature_K, double specific_humidity);

// WRF: theta (p / 1000 hPa)^(2 / 7).
double temperature_of_theta_K(double theta_K, double pressure_Pa);

// US Standard Atmosphere 1976, -2 to 71 km: the geopotential height of a pressure, and the
// temperature there. Only where a file has no temperature, and for tests.
double standard_geopotential_height_m(double pressure_Pa);
double standard_temperature_K(double geopotential_height_m);
double standard_pressure_Pa(double geopotential_height_m);

// Geopotential height (m) of levels of falling pressure over a surface: layers in which the virtual
// temperature is linear in height, for which the logarithmic mean of both ends is exact. Below the
// lowest level its virtual temperature holds. Hydrostatic, dry gas constant, 9.80665 m s-2.
void hypsometric_heights_m(std::span<const double> pressure_Pa,
                           std::span<const double> virtual_temperature_K,
                           double surface_pressure_Pa, double surface_height_m,
                           std::span<double> height_m);

// The height at any pressure in the same layers, of levels whose `height_m` those are: the virtual
// temperature is linear in height between levels, and constant below the lowest and above the
// topmost.
double height_in_layers_m(std::span<const double> pressure_Pa,
                          std::span<const double> virtual_temperature_K,
                          std::span<const double> height_m, double at_Pa);

}  // namespace nepho::forecast
