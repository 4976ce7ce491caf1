#version 450
// Visibility of the sky (up, mean of four level directions, down) at every second sample; the fill
// pass interpolates the rest: it varies over mean free paths, not voxels.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 0, rgba16f) uniform image3D light_image;
#define LIGHT_ATLAS_SIZE imageSize(light_image)
#include "head.glsl"
#include "walk.glsl"
#include "march.glsl"
#include "lit_sample.glsl"
#ifdef NEPHO_GROUND
#include "planet.glsl"
#endif

float visible(dvec3 direction) {
  ray_direction = direction;
  float tau = optical_depth_ahead(40.0);  // beyond it the sky is dark to 4e-4
#ifdef NEPHO_SINGLE
  return exp(-tau);
#else
  return sky_visibility(tau);
#endif
}

void main() {
  load_frame();
#ifdef NEPHO_GROUND
  load_planet();
#endif
  if (gl_GlobalInvocationID.x >= uint(light_samples.length())) return;
  uint entry = light_samples[gl_GlobalInvocationID.x];
  int tile = int(entry / 729u);
  ivec3 sample_index = lit_sample_index(entry);
  ray_start = lit_world(tile, sample_index);
#ifdef NEPHO_GROUND
  // Over a planet, up is that of the place; a little aside, as samples lie on the corners of cells and
  // a ray along their edges would be in four of them.
  dvec3 up = planet_scaled(planet_scaled(ray_start));
  up = up / sqrt(dot(up, up)) + dvec3(0.0011LF, 0.0007LF, 0.0013LF);
  up /= sqrt(dot(up, up));
  dvec3 east = abs(up.x) < 0.6LF ? dvec3(0.0LF, up.z, -up.y) : dvec3(-up.z, 0.0LF, up.x);
  east /= sqrt(dot(east, east));
  dvec3 axes[3] = dvec3[3](up, east, cross(up, east));
  dvec3 start = ray_start;
#endif
  // One loop: each copy of the march costs half a second to compile in software.
  vec3 sum = vec3(0.0);
  for (int direction = 0; direction < 6; ++direction) {
    int row = 3 * (direction >> 1);
#ifdef NEPHO_GROUND
    dvec3 axis = axes[direction >> 1];
    ray_start = start;
#else
    dvec3 axis = dvec3(frame.sky_axes[row], frame.sky_axes[row + 1], frame.sky_axes[row + 2]);
#endif
    float seen = visible((direction & 1) == 0 ? axis : -axis);
    sum[direction == 0 ? 0 : direction == 1 ? 2 : 1] += seen;
  }
  ivec3 texel = lit_texel(tile, sample_index);
  float tau = imageLoad(light_image, texel).r;
  imageStore(light_image, texel, vec4(tau, sum.x, 0.25 * sum.y, sum.z));
}
