#version 450
// One texel of the sun map: a march from the sun's side through all clouds (sun_map.glsl).
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 0, rgba32f) uniform writeonly image2DArray map;
uniform ivec2 first_pixel;
#include "head.glsl"
#include "walk.glsl"
#define NEPHO_NOTE_DEPTH
void note_depth(float tau, float begin_m, float end_m);
#include "march.glsl"
#include "planet.glsl"

// Of each band: optical depth so far, where it begins (from the first that is not haze, and from the
// first at all), and the integral of place times what is taken from a beam through this band alone.
float noted_depth[NEPHO_BANDS], noted_first_m[NEPHO_BANDS], noted_edge_m[NEPHO_BANDS], noted_mean[NEPHO_BANDS];
dvec3 noted_start;  // heights are those of planet_ray's start; the march may move its own

// Part of an even step's optical depth within a band goes to that band.
void note_band(int band, float tau, float begin_m, float length_m, float height_m, float rise_m) {
  const float haze = 0.02;
  float low_m = planet.cloud_bottom_m + float(band) * planet.map_band_m;
  float u = band == 0 ? (rise_m < 0.0 ? 1.0 : 0.0) : clamp((low_m - height_m) / rise_m, 0.0, 1.0);
  float v = band == NEPHO_BANDS - 1 ? (rise_m < 0.0 ? 0.0 : 1.0)
                                    : clamp((low_m + planet.map_band_m - height_m) / rise_m, 0.0, 1.0);
#ifdef NEPHO_MUTANT_ONE_BAND
  u = 0.0;
  v = band == 0 ? 1.0 : 0.0;
#endif
  float part = abs(v - u), own = tau * part, at_m = begin_m + min(u, v) * length_m;
  if (own <= 0.0) return;
  noted_mean[band] += exp(-noted_depth[band]) * own * (exp_e0(own) * at_m + exp_w1(own) * part * length_m);
  if (noted_depth[band] <= 0.0) noted_first_m[band] = at_m;
  if (noted_depth[band] < haze) noted_edge_m[band] = at_m;
  noted_depth[band] += own;
}
void note_depth(float tau, float begin_m, float end_m) {
  if (tau <= 0.0) return;
  float moved_m = float(dot(ray_start - noted_start, ray_direction));
  float height_m = planet_height(moved_m + begin_m), rise_m = planet_height(moved_m + end_m) - height_m;
  if (abs(rise_m) < 1e-3) rise_m = 1e-3;
#define NEPHO_DO_BAND(b) note_band(b, tau, begin_m, end_m - begin_m, height_m, rise_m);
  NEPHO_EACH_BAND
#undef NEPHO_DO_BAND
}

vec4 band_texel(int band, float start_m) {
  float tau = noted_depth[band], taken = 1.0 - exp(-tau);
  if (taken <= 0.0) return vec4(0.0);
  float begin_m = tau < 0.1 ? noted_first_m[band] : noted_edge_m[band];
  // Mean depth of what an even cloud takes, as a part of its length; for small depths a series.
  float share = tau < 0.5 ? 0.5 - tau / 12.0 : 1.0 / tau - (1.0 - taken) / taken;
  float length_m = max((noted_mean[band] / taken - begin_m) / share, 1.0);
  return vec4(taken, taken * (start_m - begin_m), taken * length_m, 0.0);
}

void main() {
  load_frame();
  load_planet();
  ivec2 at = first_pixel + ivec2(gl_GlobalInvocationID.xy), size = imageSize(map).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 u = planet.map_range * ((2.0 * vec2(at) + 1.0) / vec2(size) - 1.0);
  vec2 x = 0.5 * planet.map_warp_m * (exp(u) - exp(-u));
  dvec3 axes[3];
  for (int row = 0; row < 3; ++row)
    axes[row] = dvec3(planet.map_axes[3 * row], planet.map_axes[3 * row + 1], planet.map_axes[3 * row + 2]);
  dvec3 center = vec_of(planet.map_center_m);
  ray_start = center + double(x.x) * axes[0] + double(x.y) * axes[1] + 3.0LF * planet.outer_m * axes[2];
  ray_direction = -axes[2];
#define NEPHO_DO_BAND(b) noted_depth[b] = noted_first_m[b] = noted_edge_m[b] = noted_mean[b] = 0.0;
  NEPHO_EACH_BAND
#undef NEPHO_DO_BAND
  if (begin_planet_ray()) {
    noted_start = ray_start;
    optical_depth_ahead(1e4);
  }
  float start = float(dot(axes[2], ray_start - center));
#define NEPHO_DO_BAND(b) imageStore(map, ivec3(at, b), band_texel(b, start));
  NEPHO_EACH_BAND
#undef NEPHO_DO_BAND
}
