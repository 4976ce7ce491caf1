#version 450
// Rays of the pixels that the buffer names, in its order: neighbours side by side.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 1) uniform sampler3D light_atlas;
// Three for each ray. Before: the second holds its pixel, the distance of the ground (planets) and
// whether the air in front of the clouds is known (first and third: its light and what it leaves) or
// asked for. After: radiance and optical depth; transmittance, and that distance; with NEPHO_SEEN_DEPTH
// what the third holds is at `scattered`.
layout(std430, binding = 5) restrict buffer PixelBuffer { vec4 pixels[]; };
#include "head.glsl"
vec2 light_tiles;
vec3 per_light_texel;
#include "walk.glsl"
#include "march.glsl"
#include "camera.glsl"

#ifdef NEPHO_GROUND
#define Passed vec3
float most_of(vec3 c) { return max(c.r, max(c.g, c.b)); }
#else
#define Passed float
float most_of(float c) { return c; }
#endif
struct Seen {
  vec3 radiance;
  Passed transmittance;
  float optical_depth;
};
float passed(Seen seen) { return most_of(seen.transmittance); }
#ifdef NEPHO_GROUND
#include "planet.glsl"
#endif
#ifdef NEPHO_SUN_MAP
#include "sun_map.glsl"
#endif
#ifdef NEPHO_AIR
#include "air_tables.glsl"
#include "air_spans.glsl"
#endif
#include "lights.glsl"

#ifdef NEPHO_SEEN_DEPTH
// How far away what is seen is: over all steps of cloud, what each hides of what lies behind it, times
// its distance from the ray's start, m; the sum of these parts; the distances of that start from the
// eye and of the ground from that start, m.
vec4 scattered = vec4(0.0, 0.0, 0.0, FAR);
// Where half of what lies behind is hidden; that far away is what hides so much, as a mean of two clouds
// would be between them.
float half_hidden_m = -1.0;
#endif

// A step of cloud: its own light and optical depth, the transmittance at its end and its mean; air in front of and behind it, half each
// (Strang's splitting).
void add_step(inout Seen seen, vec3 light, float tau, float through, float mean, float t, float step_m) {
#ifdef NEPHO_AIR
  vec3 weights = span_weights(t + 0.5 * step_m);
  vec3 half_way = exp(-(0.5 * step_m) * air_extinction(weights));
  seen.transmittance *= half_way;
  seen.radiance += seen.transmittance * step_m * mean * air_emission_at(weights);
#endif
  seen.radiance += seen.transmittance * light;
#ifdef NEPHO_SEEN_DEPTH
  // Scattered half way where the step is thin, a mean free path on where it is thick.
  float here = passed(seen);
  if (here > 0.5 && here * through <= 0.5) half_hidden_m = t + step_m * (log(2.0 * here) / tau);
  scattered.xy += here * (1.0 - through) * vec2(t + step_m * (mean / (1.0 + mean)), 1.0);
#endif
#ifdef NEPHO_MUTANT_EULER
  seen.transmittance *= max(1.0 - tau, 0.0);
#else
  seen.transmittance *= through;
#endif
#ifdef NEPHO_AIR
  seen.transmittance *= half_way;
#endif
  seen.optical_depth += tau;
}

// Of a step whose source is linear in optical depth.
vec3 linear_light(vec3 s0, vec3 s1, float tau, float through, out float mean) {
  float rise = exp_w1_through(tau, through);
  mean = through + tau * rise;  // e0, and no difference of like numbers
  return tau * (s0 * mean + (s1 - s0) * rise);
}

// Where the march through cloud is: extinction and source at its last place, and the step that is
// tried next. `fresh` where that place was outside of cloud: the first step then has no length.
struct March {
  float k0;
  vec3 s0;
  float longest;
  bool fresh;
};
#ifdef NEPHO_COUNT_SAMPLES
uint extinction_count = 0u, source_count = 0u;
#endif
March march = March(0.0, vec3(0.0), FAR, true);

#ifdef NEPHO_ADAPTIVE
#include "adaptive_steps.glsl"
#else
#include "fixed_steps.glsl"
#endif

#ifdef NEPHO_GROUND
#include "see_planet.glsl"
#else
Seen see() {
  Seen seen = Seen(vec3(0.0), 1.0, 0.0);
  float end_m, t = begin_walks(end_m);
  float sine = float(dot(ray_direction, dvec3(frame.sky_axes[0], frame.sky_axes[1], frame.sky_axes[2])));
  vec3 background;
  for (int c = 0; c < 3; ++c)
    background[c] = end_m < FAR ? frame.below[c]
                                : sky_radiance(sine, frame.zenith[c], frame.horizon[c], frame.below[c]);
#ifdef NEPHO_ADAPTIVE
  behind = luminance_of(background);
#endif
#ifdef NEPHO_SEEN_DEPTH
  scattered.w = end_m;
#endif
  // Before the loop: llvmpipe runs what is in its branches at every turn.
  begin_lights();
  int ended = t < end_m ? 0 : 1;
  while (ended == 0) {
    enter_walks(t);
    march.fresh = true;  // a volume that begins or ends here need not begin with nothing
    int inside = 1;
    while (inside == 1) {
      bool empty, smooth_, enters;
      float leave;
      int looking = 1;
      while (looking == 1) {
        leave = settle_walks(t, empty, smooth_, enters);
        if (empty) march.fresh = true;
        if (empty && !enters && leave < FAR) t = min(max(t, leave), end_m);
        if (enters || leave >= FAR || t >= end_m || (!empty && leave > t)) looking = 0;
      }
      if (leave >= FAR || t >= end_m) {
        ended = 1;
        inside = 0;
      } else if (enters) {
        inside = 0;
      } else {
        march_segment(seen, t, min(leave, end_m), smooth_);
        t = min(leave, end_m);
        if (t >= end_m || seen.transmittance < frame.least_transmittance) {
          ended = 1;
          inside = 0;
        }
      }
    }
  }
  count_overrun(ended);
  seen.radiance += seen.transmittance * background;
  return seen;
}
#endif

void main() {
  load_frame();
#ifdef NEPHO_GROUND
  load_planet();
#endif
  light_tiles = vec2(textureSize(light_atlas, 0).xy / 9);
  per_light_texel = 1.0 / vec3(textureSize(light_atlas, 0));
  int entry = 3 * int(gl_GlobalInvocationID.x);
  if (entry >= pixels.length()) return;
  vec4 asked = pixels[entry + 1];
  begin_camera_ray(ivec2(asked.xy));
#ifdef NEPHO_GROUND
  Seen seen = see(asked.z, asked.w, pixels[entry].rgb, pixels[entry + 2].rgb);
#ifdef NEPHO_SEEN_DEPTH
  scattered.w = asked.z;
#endif
  pixels[entry + 1] = vec4(seen.transmittance, asked.z);
#else
  Seen seen = see();
#endif
  pixels[entry] = vec4(seen.radiance, seen.optical_depth);
#ifdef NEPHO_SEEN_DEPTH
  dvec3 moved = ray_start - vec_of(frame.eye_m);
  scattered.z = float(sqrt(dot(moved, moved)));
  if (half_hidden_m >= 0.0) scattered.x = half_hidden_m * scattered.y;
  pixels[entry + 2] = scattered;
#endif
#ifdef NEPHO_COUNT_SAMPLES
  atomicAdd(rays, 1u);
  atomicAdd(extinction_samples, extinction_count);
  atomicAdd(source_samples, source_count);
#endif
}
