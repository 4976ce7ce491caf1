// A planet with air and ground, as C++ fills it and shaders read it (std430, like frame.layout.h).
// Scaled space: z stretched by a / b; the planet is a sphere of radius a there.
#ifdef __cplusplus
#pragma once
namespace nepho {
#endif

struct PlanetData {
  double radius_m;         // a
  double z_scale;          // a / b
  double outer_m;          // radius, scaled space, of a sphere around air and volumes
  double map_center_m[3];  // sun map: the middle of its plane
  double map_axes[9];      // rows: its two axes, and to the sun; unit
  double surface_axes[9];  // surface map: rows centre, east, north
  double surface_low_rad[2];
  double surface_per_rad[2];  // nodes per radian
  float rayleigh_per_m[3];    // scattering at height 0
  float aerosol_per_m[3];     // extinction at height 0
  float aerosol_scattering_per_m[3];
  float ozone_per_m[3];  // absorption at the peak
  float rayleigh_scale_m;
  float aerosol_scale_m;
  float aerosol_asymmetry;
  float ozone_low_m;
  float ozone_peak_m;
  float ozone_high_m;
  float air_top_m;
  float land_albedo[3];
  float water_albedo[3];
  float slope_variance;  // of the water, both axes
  float cloud_top_m;     // no extinction above; heights as the chart's
  float cloud_bottom_m;  // none below
  float map_band_m;      // sun map: height of a layer's band, from the bottom
  float map_warp_m;      // sun map: |x| = warp sinh(range u), u in [0, 1]
  float map_range;
  float surface_top_m;    // highest of the surface map
  float surface_cell_m;   // its smallest cell
  float surface_slope;    // its steepest
  float pixel_rad;
  float cloud_asymmetry;  // of the clouds, for daylight under them
  int surface_nx;
  int surface_ny;
  int surface_around;
};

#ifdef __cplusplus
}  // namespace nepho
#endif
