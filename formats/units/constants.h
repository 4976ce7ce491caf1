#pragma once

// Physical constants: value, unit, source, standard uncertainty. "exact" is exact by definition.

namespace nepho::constants {

// WGS 84, NIMA TR8350.2 (2000): the ellipsoid is defined by a and 1/f. Exact.
inline constexpr double kWgs84Equatorial_m = 6378137.0;
inline constexpr double kWgs84InverseFlattening = 298.257223563;
inline constexpr double kWgs84Polar_m = kWgs84Equatorial_m * (1 - 1 / kWgs84InverseFlattening);

// Radius of the sphere of the ellipsoid's volume, (a a b)^(1/3); Moritz (2000), GRS 80, R3. 1 m.
inline constexpr double kEarthMeanRadius_m = 6371000.8;
// Mean equatorial radius, IAU WGCCRE 2015, Archinal et al. (2018), doi:10.1007/s10569-017-9805-5.
inline constexpr double kMarsEquatorial_m = 3396190.0;  // 100 m
inline constexpr double kMarsPolar_m = 3376200.0;       // 100 m

// IAU 2012 resolution B2. Exact.
inline constexpr double kAstronomicalUnit_m = 149597870700.0;
// Nominal, IAU 2015 resolution B3. Exact as a conversion; the photosphere is known to 140 km.
inline constexpr double kSunRadius_m = 6.957e8;
// asin(R / 1 au); through the year it varies by 1.7 %.
inline constexpr double kSunAngularRadius_rad = 4.6505e-3;  // 1e-6
// Total solar irradiance at 1 au, Kopp & Lean (2011), doi:10.1029/2010GL045777.
inline constexpr double kSolarIrradiance_W_per_m2 = 1360.8;  // 0.5

// CGPM 1901. Exact.
inline constexpr double kStandardGravity_m_per_s2 = 9.80665;
// CODATA 2018, k N_A. Exact.
inline constexpr double kGasConstant_J_per_mol_K = 8.31446261815324;
// R / M with M = 28.9644 g/mol, US Standard Atmosphere 1976 (dry air without today's CO2): 1e-5.
inline constexpr double kDryAirGasConstant_J_per_kg_K = 287.058;
// R / 18.015268 g/mol, IAPWS R6-95. 1e-6 of it.
inline constexpr double kVapourGasConstant_J_per_kg_K = 461.52280;
// Water at 0 degC, IAPWS R6-95; cloud drops are within 2 % of it from -40 to 40 degC.
inline constexpr double kWaterDensity_kg_per_m3 = 999.84;
// Ice Ih at 0 degC, IAPWS R10-06. 0.1.
inline constexpr double kIceDensity_kg_per_m3 = 916.7;
// ITS-90 ice point; the zero of the Celsius scale. Exact.
inline constexpr double kZeroCelsius_K = 273.15;

}  // namespace nepho::constants
