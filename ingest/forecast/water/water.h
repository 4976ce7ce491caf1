#pragma once

namespace nepho::forecast {

// Water in the air to extinction at 550 nm (geometric optics; the edge term for droplets). Contents
// are kg per m3 of air; radii in m; extinction in 1/m.

enum class Species { kCloudWater, kRain, kCloudIce, kSnow, kGraupel };
const char* name_of(Species species);
bool is_ice(Species species);

// Droplets per m3 by Martin et al. (1994), doi:10.1175/1520-0469(1994)051<1823:TMAPOE>2.0.CO;2:
// from 50 (sea) and 900 (land) aerosol particles per cm3, and the ratio k of cubed volume radius to
// cubed effective radius. `land` in [0, 1] is interpolated between both.
struct Droplets {
  double number_per_m3, k;
};
Droplets droplets_over(double land);

// (3 LWC / (4 pi rho_w k N))^(1/3), within 4 to 30 um.
double droplet_radius_m(double in_cloud_kg_per_m3, const Droplets& droplets);

// Extinction efficiency of a gamma distribution of droplets (effective variance 0.1) at 550 nm:
// 2 + 2.12 (2 pi r / lambda)^(-2/3), the edge term of Nussenzveig & Wiscombe (1980) fitted to Mie
// sums: 1e-3 of it from 4 to 30 um.
double droplet_efficiency(double radius_m);

// Of ice crystals, Sun & Rikus (1999) as corrected by Sun (2001): diameter from content and
// temperature, 0.64952 of it is the radius; at least 20 um at the poles to 60 um at the equator,
// at most 155 um in diameter.
double ice_radius_m(double in_cloud_kg_per_m3, double temperature_K, double latitude_deg);

// Content times this is extinction. Cloud water and ice: 3 Q / (4 rho r).
double droplet_extinction_m2_per_kg(double radius_m);
double ice_extinction_m2_per_kg(double radius_m);
// Rain, snow and graupel are far larger than droplets, so that they are never mixed with them:
// exponential distributions of spheres, N(D) = N0 exp(-D / D0). Rain: Marshall & Palmer (1948),
// N0 = 8e6 m-4. Snow: Houze et al. (1979), N0 = 2e6 exp(0.12 (273.15 K - T)) m-4, 100 kg/m3.
// Graupel: N0 = 4e6 m-4, 500 kg/m3 (Hong & Lim 2006).
double precipitation_extinction_m2_per_kg(Species species, double content_kg_per_m3,
                                          double temperature_K);

}  // namespace nepho::forecast
