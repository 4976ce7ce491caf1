#version 450
// One sample of light is that of another: the same place in another tile, or the nearest in cloud.
layout(local_size_x = 64) in;
layout(binding = 0, NEPHO_LIGHT_FORMAT) uniform image3D light_image;
layout(binding = 0) uniform sampler3D atlas;
#define LIGHT_ATLAS_SIZE imageSize(light_image)
#include "head.glsl"
#include "walk.glsl"
#include "lit_sample.glsl"

void main() {
  load_frame();
  uint at = 2u * gl_GlobalInvocationID.x;
  if (at >= uint(light_samples.length())) return;
  uint to = light_samples[at], from = light_samples[at + 1u];
  imageStore(light_image, lit_texel(int(to / 729u), lit_sample_index(to)),
             imageLoad(light_image, lit_texel(int(from / 729u), lit_sample_index(from))));
}
