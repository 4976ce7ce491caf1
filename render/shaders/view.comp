#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D atlas;
layout(binding = 1) uniform sampler3D light_atlas;
layout(binding = 0, rgba32f) uniform writeonly image2D picture;
uniform ivec2 first_pixel;
#include "head.glsl"
#include "walk.glsl"
#include "march.glsl"
#include "lights.glsl"

struct Seen {
  vec3 radiance;
  float transmittance, optical_depth;
};

void add_step(inout Seen seen, vec3 s0, vec3 s1, float tau) {
  float e0 = exp_e0(tau), w1 = exp_w1(tau);
  seen.radiance += seen.transmittance * tau * (s0 * e0 + (s1 - s0) * w1);
  seen.transmittance *= exp(-tau);
  seen.optical_depth += tau;
}

// One segment in which no volume changes its leaf.
void march_segment(inout Seen seen, float t, float end, bool smooth_, inout vec3 s0) {
  float k0 = total_extinction_at(t), voxel = cell_length(0.5 * (t + end));
#if !defined(NEPHO_CELL_EXACT)
#ifdef NEPHO_ADAPTIVE
  float h = 2.0 * voxel;
#else
  float h = frame.step_voxels * voxel;
#endif
#endif
  for (int guard = 0; guard < 65536 && t < end; ++guard) {
#ifdef NEPHO_CELL_EXACT
    int sub_steps;
    float next = smooth_ ? min(t + voxel, end) : cell_end(t, end, sub_steps);
    if (smooth_) sub_steps = 1;
    float sub = (next - t) / float(sub_steps);
    for (int s = 0; s < sub_steps; ++s) {
      float k_mid = total_extinction_at(t + 0.5 * sub), k1 = total_extinction_at(t + sub);
      vec3 s1 = total_source_at(t + sub);
      add_step(seen, s0, s1, simpson_optical_depth(k0, k_mid, k1, sub));
      s0 = s1;
      k0 = k1;
      t += sub;
    }
    t = next;
#else
    float next = end - t < 1.25 * h ? end : t + h;
    float step_m = next - t;
    float k1 = total_extinction_at(next), k_mid = total_extinction_at(0.5 * (t + next));
#ifdef NEPHO_ADAPTIVE
    // Simpson against the trapezium: what the step leaves to its shape, as seen from the eye.
    float doubt = seen.transmittance * step_m * abs(k0 - 2.0 * k_mid + k1) * (1.0 / 6.0);
    if (doubt > 2.0 * frame.tolerance && step_m > 1.01 * voxel) {
      h = max(0.5 * step_m, voxel);
      next = t + h;
      k1 = h == 0.5 * step_m ? k_mid : total_extinction_at(next);
      k_mid = total_extinction_at(0.5 * (t + next));
      step_m = h;
    } else if (doubt < 0.25 * frame.tolerance) {
      h = 3.0 * voxel;
    } else {
      h = 2.0 * voxel;
    }
#endif
    vec3 s1 = total_source_at(next);
    add_step(seen, s0, s1, simpson_optical_depth(k0, k_mid, k1, step_m));
    s0 = s1;
    k0 = k1;
    t = next;
#endif
    if (seen.transmittance < frame.least_transmittance) break;
  }
}

Seen see() {
  Seen seen = Seen(vec3(0.0), 1.0, 0.0);
  float t = begin_walks(), end_m = ground_distance();
  bool lit = false;
  vec3 s0 = vec3(0.0);
  for (int guard = 0; guard < 1000000 && t < end_m; ++guard) {
    bool empty, smooth_;
    float end = min(settle_walks(t, empty, smooth_), end_m);
    if (end >= FAR) break;
    if (empty) {
      lit = false;
    } else {
      if (!lit) {
        begin_lights();
        lit = true;
      }
      s0 = total_source_at(t);
      march_segment(seen, t, end, smooth_, s0);
      if (seen.transmittance < frame.least_transmittance) break;
    }
    t = end;
  }
  float sine = float(dot(ray_direction, dvec3(frame.sky_axes[0], frame.sky_axes[1], frame.sky_axes[2])));
  for (int c = 0; c < 3; ++c)
    seen.radiance[c] += seen.transmittance * (end_m < FAR ? frame.below[c]
                        : sky_radiance(sine, frame.zenith[c], frame.horizon[c], frame.below[c]));
  return seen;
}

void main() {
  ivec2 pixel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= frame.width || pixel.y >= frame.height) return;
  double x = (2.0LF * double(pixel.x) + 1.0LF) / double(frame.width) - 1.0LF;
  double y = 1.0LF - (2.0LF * double(pixel.y) + 1.0LF) / double(frame.height);
  ray_start = vec_of(frame.eye_m);
  ray_direction = vec_of(frame.forward) + x * vec_of(frame.right) + y * vec_of(frame.up);
  ray_direction /= sqrt(dot(ray_direction, ray_direction));
  Seen seen = see();
  imageStore(picture, pixel, vec4(seen.radiance, seen.optical_depth));
}
