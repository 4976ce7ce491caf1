#version 450
// Rays of the pixels that the buffer names, in its order: neighbours side by side.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 1) uniform sampler3D light_atlas;
// Three for each ray. Before: the second holds its pixel, the distance of the ground (planets) and
// whether the air in front of the clouds is known (first and third: its light and what it leaves) or
// asked for. After: radiance and optical depth; transmittance, and that distance.
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

// A step of cloud; air in front of and behind it, half each (Strang's splitting).
void add_step(inout Seen seen, vec3 s0, vec3 s1, float tau, float t, float step_m) {
  float e0 = exp_e0(tau), w1 = exp_w1(tau);
#ifdef NEPHO_AIR
  vec3 weights = span_weights(t + 0.5 * step_m);
  vec3 half_way = exp(-(0.5 * step_m) * air_extinction(weights));
  seen.transmittance *= half_way;
  seen.radiance += seen.transmittance * step_m * e0 * air_emission_at(weights);
#endif
  seen.radiance += seen.transmittance * tau * (s0 * e0 + (s1 - s0) * w1);
#ifdef NEPHO_MUTANT_EULER
  seen.transmittance *= max(1.0 - tau, 0.0);
#else
  seen.transmittance *= exp(-tau);
#endif
#ifdef NEPHO_AIR
  seen.transmittance *= half_way;
#endif
  seen.optical_depth += tau;
}

// Where the march through cloud is: extinction and source at its last place, and the step that is
// tried next. `fresh` where that place was outside of cloud: the first step then has no length.
struct March {
  float k0;
  vec3 s0;
  float longest;
  bool fresh;
};
March march = March(0.0, vec3(0.0), FAR, true);

// One segment in which no volume changes its leaf. A step is halved until its optical depth is under
// `thickest`: the source is linear in optical depth within a step, and where a voxel is thick it falls
// off exponentially. What lies behind more of the cloud may be coarser, as less of it is seen. Leaves
// side by side share their faces: what was found at the end of one holds for the next.
void march_segment(inout Seen seen, float t, float end, bool smooth_) {
  float voxel = cell_length(0.5 * (t + end));
  begin_segment(t, end);
#ifdef NEPHO_CELL_EXACT
  const float thickest = 0.05;
  march.fresh = true;
#elif defined(NEPHO_ADAPTIVE)
  float thinnest = clamp(1.6 * sqrt(frame.tolerance), 0.05, 1.0), h = 2.0 * voxel;
#else
  const float thickest = 1.0;
  float h = frame.step_voxels * voxel;
#endif
  while (t < end) {
#ifdef NEPHO_CELL_EXACT
    int sub_steps = 1;
    float next = smooth_ ? min(t + voxel, end) : cell_end(t, end, sub_steps);
    float step_m = (next - t) / float(sub_steps);
#else
    float step_m = end - t < 1.25 * h ? end - t : max(h, least_step(t));
#endif
#ifdef NEPHO_ADAPTIVE
    float thickest = min(thinnest * clamp(0.7 * inversesqrt(max(passed(seen), 1e-9)), 1.0, 8.0), 1.0);
#endif
    step_m = march.fresh ? 0.0 : min(step_m, march.longest);
    // The last step ends on the wall itself: no remainder by rounding.
    float next_t = end - (t + step_m) < 1e-4 * step_m ? end : t + step_m;
    float k_mid = total_extinction_at(t + 0.5 * step_m), k1 = total_extinction_at(next_t);
    float tau = simpson_optical_depth(march.k0, k_mid, k1, step_m);
    bool refused = tau > thickest;
#ifdef NEPHO_ADAPTIVE
    // Simpson against the trapezium: what the step leaves to its shape, as seen from the eye.
    float doubt = passed(seen) * step_m * abs(march.k0 - 2.0 * k_mid + k1) * (1.0 / 6.0);
    refused = refused || (doubt > 0.6 * frame.tolerance && step_m > 1.01 * voxel);
    h = doubt < 0.08 * frame.tolerance ? 3.0 * voxel : 2.0 * voxel;
#endif
    if (refused && step_m > 2.0 * least_step(t)) {
      march.longest = 0.5 * step_m;
    } else {
      vec3 s1 = total_source_at(next_t);
      if (!march.fresh) add_step(seen, march.s0, s1, tau, t, step_m);
      // No more than what would be refused were extinction to stay; not where it is about to begin.
      march.longest = 2.0 * step_m;
      if (march.fresh) march.longest = FAR;
      march.longest = min(march.longest, k1 > 0.0 ? 1.4 * thickest / k1 : FAR);
      march.s0 = s1;
      march.k0 = k1;
      // A float cannot hold a step below its own spacing: then the ray is done with this segment.
      if (next_t <= t && !march.fresh) break;
      march.fresh = false;
      t = next_t;
      if (passed(seen) < frame.least_transmittance) break;
    }
  }
}

#ifdef NEPHO_GROUND
#include "see_planet.glsl"
#else
Seen see() {
  Seen seen = Seen(vec3(0.0), 1.0, 0.0);
  float end_m, t = begin_walks(end_m);
  // Before the loop: llvmpipe runs what is in its branches at every turn.
  begin_lights();
  int ended = t < end_m ? 0 : 1;
  while (ended == 0) {
    enter_walks(t);
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
  float sine = float(dot(ray_direction, dvec3(frame.sky_axes[0], frame.sky_axes[1], frame.sky_axes[2])));
  for (int c = 0; c < 3; ++c)
    seen.radiance[c] += seen.transmittance * (end_m < FAR ? frame.below[c]
                        : sky_radiance(sine, frame.zenith[c], frame.horizon[c], frame.below[c]));
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
  pixels[entry + 1] = vec4(seen.transmittance, asked.z);
#else
  Seen seen = see();
#endif
  pixels[entry] = vec4(seen.radiance, seen.optical_depth);
}
