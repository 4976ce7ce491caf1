// Clouds' shadows on the air: a map across the sun's direction, dense under the eye, with a layer for
// each band of height. Each texel: W = 1 - transmittance of that band's clouds on that line, W times
// the depth where they begin (along the line, growing towards the sun), W times the length of the even
// cloud that takes as much and at the same mean depth. A band's clouds stand for that one.
layout(binding = 5) uniform sampler2DArray sun_map;
vec3 map_start, map_along;  // of the ray, in the map's axes
vec2 map_planet;            // the planet's middle there
float map_texel;            // width of a texel over that of the map's scale, asinh

void begin_sun_map() {
  dvec3 from_center = ray_start - vec_of(planet.map_center_m);
  for (int row = 0; row < 3; ++row) {
    dvec3 axis = dvec3(planet.map_axes[3 * row], planet.map_axes[3 * row + 1], planet.map_axes[3 * row + 2]);
    map_start[row] = float(dot(axis, from_center));
    map_along[row] = float(dot(axis, ray_direction));
    if (row < 2) map_planet[row] = float(-dot(axis, vec_of(planet.map_center_m)));
  }
  map_texel = 2.0 * planet.map_range / float(textureSize(sun_map, 0).x);
}

// Optical depth between the sun and a place at `depth_m` of the line, in one band.
float band_depth(vec4 texel, float depth_m) {
  if (texel.x <= 1e-4) return 0.0;
  return -log(max(1.0 - texel.x, 1e-6)) * clamp((texel.y - texel.x * depth_m) / texel.z, 0.0, 1.0);
}

const float SUN_IS_UP = 0.02;  // sine of its height

// Part of the sun's light that clouds leave at t_m. Where its beam grazes the planet, between lines
// above all clouds and lines through hundreds of km of them, a texel that is wider than what the beam
// passes over shows its own square: within 2.5 texels of that edge shadows on the air fade away.
float sun_visible(float t_m) {
#ifdef NEPHO_MUTANT_NO_AIR_SHADOW
  return 1.0;
#endif
  float height_m = planet_height(t_m);
  if (height_m > planet.cloud_top_m) return 1.0;
  vec3 q = map_start + t_m * map_along;
  vec2 far = abs(q.xy) / planet.map_warp_m;
  vec2 at = 0.5 * sign(q.xy) * log(far + sqrt(far * far + 1.0)) / planet.map_range + 0.5;
  float tau = 0.0;
  // Under a sun that is up, what is below a place is not in its way. A loop, as bands are looked up by all
  // rays side by side until none is left.
  float sun_up = planet_ray.sun_up_m + t_m * planet_ray.stretch * planet_ray.sun_along;
  int band = sun_up > SUN_IS_UP * planet_ray.radius_m ? int((height_m - planet.cloud_bottom_m) / planet.map_band_m) : 0;
  for (band = max(band, 0); band < NEPHO_BANDS; ++band)
    tau += band_depth(textureLod(sun_map, vec3(at, float(band)), 0.0), q.z);
#ifdef NEPHO_MUTANT_SUN_MAP_EDGE
  return exp(-tau);
#endif
  float texel_m = map_texel * planet.map_warp_m * max(sqrt(far.x * far.x + 1.0), sqrt(far.y * far.y + 1.0));
  float inside_m = float(planet.radius_m) + planet.cloud_top_m - length(q.xy - map_planet);
  return exp(-tau * clamp(inside_m / texel_m - 1.5, 0.0, 1.0));
}
