#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 1) uniform sampler3D light_atlas;
layout(binding = 0, rgba32f) uniform writeonly image2D picture;
#ifdef NEPHO_GROUND
// For the ground pass: what is seen of the ground, and where the ray meets it.
layout(binding = 1, rgba32f) uniform writeonly image2D met;
#endif
uniform ivec2 first_pixel;
#include "head.glsl"
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
#include "surface.glsl"
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

// Halves a step until its optical depth is under `most`: the source is linear in optical depth within
// a step, and where a voxel is thick it falls off exponentially. T bounds how many steps there are.
void limit_step(float t, inout float step_m, float k0, inout float k_mid, inout float k1, float most) {
  while (simpson_optical_depth(k0, k_mid, k1, step_m) > most && step_m > 2.0 * least_step(t)) {
    step_m *= 0.5;
    k1 = k_mid;
    k_mid = total_extinction_at(t + 0.5 * step_m);
  }
}

// One segment in which no volume changes its leaf.
void march_segment(inout Seen seen, float t, float end, bool smooth_, inout vec3 s0) {
  float k0 = total_extinction_at(t), voxel = cell_length(0.5 * (t + end));
#ifdef NEPHO_CELL_EXACT
  const float thickest = 0.05;
#elif defined(NEPHO_ADAPTIVE)
  float thickest = clamp(1.6 * sqrt(frame.tolerance), 0.05, 1.0), h = 2.0 * voxel;
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
    float k_mid = total_extinction_at(t + 0.5 * step_m), k1 = total_extinction_at(t + step_m);
#ifdef NEPHO_ADAPTIVE
    // Simpson against the trapezium: what the step leaves to its shape, as seen from the eye.
    float doubt = passed(seen) * step_m * abs(k0 - 2.0 * k_mid + k1) * (1.0 / 6.0);
    if (doubt > 0.6 * frame.tolerance && step_m > 1.01 * voxel) {
      step_m *= 0.5;
      k1 = k_mid;
      k_mid = total_extinction_at(t + 0.5 * step_m);
    } else {
      h = doubt < 0.08 * frame.tolerance ? 3.0 * voxel : 2.0 * voxel;
    }
#endif
    limit_step(t, step_m, k0, k_mid, k1, thickest);
    // The last step ends on the wall itself: no remainder by rounding.
    float next_t = end - (t + step_m) < 1e-4 * step_m ? end : t + step_m;
    vec3 s1 = total_source_at(next_t);
    add_step(seen, s0, s1, simpson_optical_depth(k0, k_mid, k1, step_m), t, step_m);
    s0 = s1;
    k0 = k1;
    // A float cannot hold a step below its own spacing: then the ray is done with this segment.
    if (next_t <= t) break;
    t = next_t;
    if (passed(seen) < frame.least_transmittance) break;
  }
}

#ifdef NEPHO_GROUND
#include "see_planet.glsl"
#else
Seen see() {
  Seen seen = Seen(vec3(0.0), 1.0, 0.0);
  float end_m, t = begin_walks(end_m);
  vec3 s0 = vec3(0.0);
  float end = 0.0;
  // Before the loop: llvmpipe runs what is in its branches at every turn.
  begin_lights();
  int ended = t < end_m ? 0 : 1;
  while (end < FAR && t < end_m && seen.transmittance >= frame.least_transmittance) {
    bool empty, smooth_;
    end = settle_walks(t, empty, smooth_);
    float stop = min(end, end_m);
    if (!empty && end < FAR) {
      s0 = total_source_at(t);
      march_segment(seen, t, stop, smooth_, s0);
    }
    t = stop;
    if (end >= FAR || t >= end_m || seen.transmittance < frame.least_transmittance) ended = 1;
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
  ivec2 pixel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= frame.width || pixel.y >= frame.height) return;
  begin_camera_ray(pixel);
#ifdef NEPHO_GROUND
  float ground_m;
  Seen seen = see(ground_m);
  if (ground_m >= FAR) add_sky_beyond(seen);
  imageStore(met, pixel, vec4(seen.transmittance, ground_m));
#else
  Seen seen = see();
#endif
  imageStore(picture, pixel, vec4(seen.radiance, seen.optical_depth));
}
