#version 450
// One texel of the sun map: a march from the sun's side through all clouds (sun_map.glsl).
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 0, rgba32f) uniform writeonly image2D map;
uniform ivec2 first_pixel;
#include "head.glsl"
#include "walk.glsl"
#define NEPHO_NOTE_DEPTH
float noted_depth = 0.0, noted_first_m = -1.0, noted_mean = 0.0;
void note_depth(float tau, float t_m) {
  if (tau <= 0.0) return;
  noted_mean += exp(-noted_depth) * tau * exp_e0(tau) * t_m;
  noted_depth += tau;
  if (noted_first_m < 0.0 || noted_depth < 0.02) noted_first_m = t_m;
}
#include "march.glsl"
#include "planet.glsl"

void main() {
  load_frame();
  load_planet();
  ivec2 at = first_pixel + ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 u = planet.map_range * ((2.0 * vec2(at) + 1.0) / vec2(size) - 1.0);
  vec2 x = 0.5 * planet.map_warp_m * (exp(u) - exp(-u));
  dvec3 axes[3];
  for (int row = 0; row < 3; ++row)
    axes[row] = dvec3(planet.map_axes[3 * row], planet.map_axes[3 * row + 1], planet.map_axes[3 * row + 2]);
  dvec3 center = vec_of(planet.map_center_m);
  ray_start = center + double(x.x) * axes[0] + double(x.y) * axes[1] + 3.0LF * planet.outer_m * axes[2];
  ray_direction = -axes[2];
  vec4 texel = vec4(0.0);
  if (begin_planet_ray()) {
    float tau = optical_depth_ahead(1e4);
    float taken = 1.0 - exp(-tau);
    if (taken > 0.0) {
      float start = float(dot(axes[2], ray_start - center));
      texel = vec4(taken, taken * (start - noted_first_m), taken * start - noted_mean, tau);
    }
  }
  imageStore(map, at, texel);
}
