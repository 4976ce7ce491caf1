#pragma once

#include "forecast/rasters/raster_options.h"

namespace nepho::forecast {

// One column of a raster: what its bands say, NaN where they say nothing, and the cloud made of it.

struct ColumnValues {
  double optical_depth, liquid_path_kg_per_m2, ice_path_kg_per_m2, water_path_kg_per_m2, cover;
  double top_m, top_Pa, top_K, base_m, radius_m;
};

struct CloudColumn {
  double optical_depth = 0;  // mean over the cell; 0: clear
  double ice_share = 0;      // of it
  double base_m = 0, top_m = 0;
  double radius_m = 0;  // of its liquid part
};

// What a column lacks to be a cloud.
enum class Lacks { kNothing, kTop };

// Optical depth first, else water paths by extinction per mass (water.h), else the stated depth.
// Retrieved and stated depths are those of the cloudy part, and are multiplied by the cover; paths
// are means already. The top is the stated one, else a height, else the standard atmosphere's of a
// pressure, else that of a temperature below its tropopause. The base is the stated one, else the
// raster's, else by the stated thickness, else by the profile's (raster_options.h). Clouds are at
// least 50 m thick and end above the sea by a tenth of their top's height. Returns kTop where there
// is cloud without a top.
Lacks cloud_column(const ColumnValues& values, const RasterOptions& options, CloudColumn& column);

inline constexpr double kLeastThickness_m = 50;
inline constexpr double kIceBelow_K = 245.15;

// Layers of a profile: the share of the optical depth that lies below part `x` in [0, 1] of the
// height between base and top.
double depth_below(Profile profile, double x);
// Optical depth of an adiabatic cloud of this thickness, and the other way round.
double adiabatic_depth(double thickness_m, double droplets_per_m3);
double adiabatic_thickness_m(double optical_depth, double droplets_per_m3);

}  // namespace nepho::forecast
