// Clouds' shadows on the air: a map across the sun's direction, dense under the eye, with a layer for
// each band of height. Each texel: W = 1 - transmittance of that band's clouds on that line, W times
// the depth where they begin (along the line, growing towards the sun), W times the length of the even
// cloud that takes as much and at the same mean depth. A band's clouds stand for that one.
layout(binding = 5) uniform sampler2DArray sun_map;
vec3 map_start, map_along;  // of the ray, in the map's axes

void begin_sun_map() {
  dvec3 from_center = ray_start - vec_of(planet.map_center_m);
  for (int row = 0; row < 3; ++row) {
    dvec3 axis = dvec3(planet.map_axes[3 * row], planet.map_axes[3 * row + 1], planet.map_axes[3 * row + 2]);
    map_start[row] = float(dot(axis, from_center));
    map_along[row] = float(dot(axis, ray_direction));
  }
}

// Optical depth between the sun and a place at `depth_m` of the line, in one band.
float band_depth(vec4 texel, float depth_m) {
  if (texel.x <= 1e-4) return 0.0;
  return -log(max(1.0 - texel.x, 1e-6)) * clamp((texel.y - texel.x * depth_m) / texel.z, 0.0, 1.0);
}

// Part of the sun's light that clouds leave at t_m.
float sun_visible(float t_m) {
#ifdef NEPHO_MUTANT_NO_AIR_SHADOW
  return 1.0;
#endif
  if (planet_height(t_m) > planet.cloud_top_m) return 1.0;
  vec3 q = map_start + t_m * map_along;
  vec2 far = abs(q.xy) / planet.map_warp_m;
  vec2 at = 0.5 * sign(q.xy) * log(far + sqrt(far * far + 1.0)) / planet.map_range + 0.5;
  float tau = 0.0;
#define NEPHO_DO_BAND(b) tau += band_depth(textureLod(sun_map, vec3(at, float(b)), 0.0), q.z);
  NEPHO_EACH_BAND
#undef NEPHO_DO_BAND
  return exp(-tau);
}
