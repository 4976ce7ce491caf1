#version 450
// Where the ray of each pixel meets the ground, for the passes that follow: known for all pixels,
// whichever are marched.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 1, rgba32f) uniform writeonly image2D met;
uniform ivec2 first_pixel;
#include "head.glsl"
const float FAR = 1e30;
dvec3 ray_start, ray_direction;
#include "fp64.glsl"
#include "ground_distance.glsl"
#include "camera.glsl"
#include "planet.glsl"
#include "surface.glsl"

void main() {
  load_frame();
  load_planet();
  ivec2 pixel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= frame.width || pixel.y >= frame.height) return;
  begin_camera_ray(pixel);
  float ground_m = FAR;
  if (begin_planet_ray()) ground_m = surface_distance();
  imageStore(met, pixel, vec4(1.0, 1.0, 1.0, ground_m));
}
