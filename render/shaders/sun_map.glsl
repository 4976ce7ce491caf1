// Clouds' shadows on the air: a map across the sun's direction, dense under the eye. Each texel:
// W = 1 - transmittance of all clouds on that line, W times the depth where they begin, W times the
// mean depth of what they take; depths along the line, growing towards the sun.
layout(binding = 5) uniform sampler2D sun_map;
vec3 map_start, map_along;  // of the ray, in the map's axes

void begin_sun_map() {
  dvec3 from_center = ray_start - vec_of(planet.map_center_m);
  for (int row = 0; row < 3; ++row) {
    dvec3 axis = dvec3(planet.map_axes[3 * row], planet.map_axes[3 * row + 1], planet.map_axes[3 * row + 2]);
    map_start[row] = float(dot(axis, from_center));
    map_along[row] = float(dot(axis, ray_direction));
  }
}

// Part of the sun's light that clouds leave at t_m.
float sun_visible(float t_m) {
#ifdef NEPHO_MUTANT_NO_AIR_SHADOW
  return 1.0;
#endif
  if (planet_height(t_m) > planet.cloud_top_m) return 1.0;
  vec3 q = map_start + t_m * map_along;
  vec2 far = abs(q.xy) / planet.map_warp_m;
  vec2 at = sign(q.xy) * log(far + sqrt(far * far + 1.0)) / planet.map_range;
  vec4 texel = textureLod(sun_map, 0.5 * at + 0.5, 0.0);
  if (texel.x <= 1e-4) return 1.0;
  float begin = texel.y / texel.x, mean = texel.z / texel.x;
  float part = clamp((begin - q.z) / max(2.0 * (begin - mean), 1.0), 0.0, 1.0);
  return exp(part * log(max(1.0 - texel.x, 1e-6)));
}
