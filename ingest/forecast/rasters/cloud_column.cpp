#include "forecast/rasters/cloud_column.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forecast/water/air.h"
#include "forecast/water/water.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

// Condensate of rising air, kg/m3 per m: 1 to 2.5e-6 from cold to warm cloud bases (Brenguier et
// al. 2000).
constexpr double kCondensate_kg_per_m4 = 2e-6;
constexpr double kLowestBaseOfTop = 0.1;
constexpr double kSurface_K = 288.15, kLapse_K_per_m = 6.5e-3, kTropopause_m = 11000;

bool has(double value) {
  return !std::isnan(value);
}

// The standard atmosphere's, in the troposphere.
double height_of_temperature_m(double temperature_K) {
  return std::clamp((kSurface_K - temperature_K) / kLapse_K_per_m, 200.0, kTropopause_m);
}
double standard_air_K(double height_m) {
  return kSurface_K - kLapse_K_per_m * std::clamp(height_m, 0.0, kTropopause_m);
}

double top_of(const ColumnValues& v, const RasterOptions& options) {
  if (options.top_m) return *options.top_m;
  if (has(v.top_m)) return v.top_m;
  if (has(v.top_Pa))
    return height_of_geopotential_height_m(standard_geopotential_height_m(v.top_Pa));
  if (has(v.top_K)) return height_of_temperature_m(v.top_K);
  return NAN;
}

// Of a top that is not known, where it is to follow from the base, the base's temperature counts.
bool is_ice_top(const ColumnValues& v, const RasterOptions& options, double height_m) {
  if (options.phase != RasterPhase::kByTemperature) return options.phase == RasterPhase::kIce;
  return (has(v.top_K) ? v.top_K : standard_air_K(height_m)) < kIceBelow_K;
}

// Optical depths of liquid and ice, means over the cell.
struct Depths {
  double liquid = 0, ice = 0;
};

Depths depths_of(const ColumnValues& v, const RasterOptions& options, bool ice_top,
                 double liquid_m2_per_kg, double ice_m2_per_kg) {
  const double cover = has(v.cover) ? std::clamp(v.cover, 0.0, 1.0) : 1.0;
  const auto path = [](double kg_per_m2) { return has(kg_per_m2) ? std::max(kg_per_m2, 0.0) : 0; };
  Depths paths{path(v.liquid_path_kg_per_m2) * liquid_m2_per_kg,
               path(v.ice_path_kg_per_m2) * ice_m2_per_kg};
  if (!has(v.liquid_path_kg_per_m2) && !has(v.ice_path_kg_per_m2)) {
    const double water = path(v.water_path_kg_per_m2);
    (ice_top ? paths.ice : paths.liquid) = water * (ice_top ? ice_m2_per_kg : liquid_m2_per_kg);
  }
  const double by_paths = paths.liquid + paths.ice;
  const bool any_path =
      has(v.liquid_path_kg_per_m2) || has(v.ice_path_kg_per_m2) || has(v.water_path_kg_per_m2);
  double depth = by_paths;
  if (has(v.optical_depth))
    depth = std::max(v.optical_depth, 0.0) * cover;
  else if (!any_path && options.optical_depth)
    depth = *options.optical_depth * cover;
  const double ice_share = by_paths > 0 ? paths.ice / by_paths : ice_top ? 1.0 : 0.0;
  return {depth * (1 - ice_share), depth * ice_share};
}

double thickness_of(const Depths& depth, const RasterOptions& options, double liquid_m2_per_kg,
                    double ice_m2_per_kg) {
  if (options.thickness_m) return *options.thickness_m;
  double ice_m = depth.ice / ice_m2_per_kg / options.ice_content_kg_per_m3;
#ifdef NEPHO_MUTANT_ICE_AS_WATER
  ice_m *= options.ice_content_kg_per_m3 / options.liquid_content_kg_per_m3;
#endif
  const double liquid_m = options.profile == Profile::kAdiabatic
                              ? adiabatic_thickness_m(depth.liquid, options.droplets_per_m3)
                              : depth.liquid / liquid_m2_per_kg / options.liquid_content_kg_per_m3;
  return std::max(ice_m + liquid_m, kLeastThickness_m);
}

}  // namespace

double depth_below(Profile profile, double x) {
  return profile == Profile::kUniform ? x : std::pow(x, 5.0 / 3);
}

// Extinction 3/2 q / (rho r_e), q = C z, r_e^3 = 3 q / (4 pi rho k N); integrated over z.
double adiabatic_depth(double thickness_m, double droplets_per_m3) {
  using constants::kWaterDensity_kg_per_m3;
  const double k = droplets_over(0).k;
  const double per_third = std::cbrt(4 * std::numbers::pi * kWaterDensity_kg_per_m3 * k *
                                     droplets_per_m3 / (3 * kCondensate_kg_per_m4));
  return 0.6 * 1.5 * kCondensate_kg_per_m4 / kWaterDensity_kg_per_m3 * per_third *
         std::pow(thickness_m, 5.0 / 3);
}

double adiabatic_thickness_m(double optical_depth, double droplets_per_m3) {
  return std::pow(optical_depth / adiabatic_depth(1, droplets_per_m3), 0.6);
}

Lacks cloud_column(const ColumnValues& v, const RasterOptions& options, CloudColumn& column) {
  column = {};
  double top_m = top_of(v, options);
  const double base_m = options.base_m ? *options.base_m : v.base_m;
  const bool ice_top = is_ice_top(v, options, has(top_m) ? top_m : has(base_m) ? base_m : 0);
  const bool radius = has(v.radius_m) && v.radius_m > 0;
  const double liquid_radius_m = radius && !ice_top ? v.radius_m : options.liquid_radius_m;
  const double ice_radius_m = radius && ice_top ? v.radius_m : options.ice_radius_m;
  const double liquid_m2_per_kg = droplet_extinction_m2_per_kg(liquid_radius_m);
  const double ice_m2_per_kg = ice_extinction_m2_per_kg(ice_radius_m);
  const Depths depth = depths_of(v, options, ice_top, liquid_m2_per_kg, ice_m2_per_kg);
  const double total = depth.liquid + depth.ice;
  if (!(total > 0)) return Lacks::kNothing;
  const double thick_m = thickness_of(depth, options, liquid_m2_per_kg, ice_m2_per_kg);
  if (!has(top_m)) {
    if (!has(base_m)) return Lacks::kTop;
    top_m = base_m + thick_m;
  }
  column.optical_depth = total;
  column.ice_share = depth.ice / total;
  column.radius_m = liquid_radius_m;
  column.top_m = top_m;
  column.base_m = has(base_m) && !(options.thickness_m && !options.base_m)
                      ? base_m
                      : std::max(top_m - thick_m, top_m > 0 ? kLowestBaseOfTop * top_m : -1e9);
  column.base_m = std::min(column.base_m, top_m - 1);
  if (!options.base_m && !options.thickness_m)
    column.base_m = std::min(column.base_m, top_m - kLeastThickness_m);
  return Lacks::kNothing;
}

}  // namespace nepho::forecast
