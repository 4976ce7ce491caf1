#version 450
// Optical depth towards the sun, through all volumes, at each sample of each light tile.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 0, NEPHO_LIGHT_FORMAT) uniform writeonly image3D light_image;
#define LIGHT_ATLAS_SIZE imageSize(light_image)
#include "head.glsl"
#include "walk.glsl"
#include "march.glsl"
#include "lit_sample.glsl"

void main() {
  load_frame();
  if (gl_GlobalInvocationID.x >= uint(light_samples.length())) return;
  uint entry = light_samples[gl_GlobalInvocationID.x];
  int tile = int(entry / 729u);
  ivec3 sample_index = lit_sample_index(entry);
  ray_start = lit_world(tile, sample_index);
  ray_direction = vec_of(frame.to_sun);
  float tau = optical_depth_ahead(1e4);
  imageStore(light_image, lit_texel(tile, sample_index), vec4(tau, 0.0, 0.0, 0.0));
}
