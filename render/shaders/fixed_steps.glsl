// Steps of a fixed length, or cell by cell.
//
// One segment in which no volume changes its leaf. A step is halved until its optical depth is under
// `thickest`: the source is linear in optical depth within a step, and where a voxel is thick it falls
// off exponentially.  Leaves
// side by side share their faces: what was found at the end of one holds for the next.
void march_segment(inout Seen seen, float t, float end, bool smooth_) {
  float voxel = cell_length(0.5 * (t + end));
  begin_segment(t, end);
#ifdef NEPHO_CELL_EXACT
  const float thickest = 0.05;
  march.fresh = true;
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
    step_m = march.fresh ? 0.0 : min(step_m, march.longest);
    // The last step ends on the wall itself: no remainder by rounding.
    float next_t = end - (t + step_m) < 1e-4 * step_m ? end : t + step_m;
#ifdef NEPHO_COUNT_SAMPLES
    extinction_count += 2u;
#endif
    float k_mid = total_extinction_at(t + 0.5 * step_m), k1 = total_extinction_at(next_t);
    float tau = simpson_optical_depth(march.k0, k_mid, k1, step_m);
    bool refused = tau > thickest;
    if (refused && step_m > 2.0 * least_step(t)) {
      march.longest = 0.5 * step_m;
    } else {
      vec3 s1 = total_source_at(next_t);
#ifdef NEPHO_COUNT_SAMPLES
      source_count += 1u;
#endif
      float through = exp(-tau), mean;
      vec3 light = linear_light(march.s0, s1, tau, through, mean);
      if (!march.fresh) add_step(seen, light, tau, through, mean, t, step_m);
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
