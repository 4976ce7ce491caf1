#version 450
// The samples between those of the sky pass.
layout(local_size_x = 64) in;
layout(binding = 0, rgba16f) uniform image3D light_image;
layout(binding = 0) uniform sampler3D atlas;
#define LIGHT_ATLAS_SIZE imageSize(light_image)
#include "head.glsl"
#include "walk.glsl"
#include "lit_sample.glsl"

void main() {
  load_frame();
  if (gl_GlobalInvocationID.x >= uint(light_samples.length())) return;
  uint entry = light_samples[gl_GlobalInvocationID.x];
  int tile = int(entry / 729u);
  ivec3 sample_index = lit_sample_index(entry), odd = sample_index & 1;
  if (odd == ivec3(0)) return;
  vec3 sum = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 side = 2 * (ivec3(corner, corner >> 1, corner >> 2) & 1) - 1;
    sum += imageLoad(light_image, lit_texel(tile, sample_index + odd * side)).gba;
  }
  ivec3 texel = lit_texel(tile, sample_index);
  imageStore(light_image, texel, vec4(imageLoad(light_image, texel).r, sum * 0.125));
}
