// The view ray over a planet: clouds within spans of air, to the ground (surface.comp).

const float BEHIND_FRONT = 1.0, FRONT_ONLY = 2.0;  // gl/front_air.h
const float FRONT_MISSED = -1.0;

// `front`, `front_passed`: of the air before that, where it is known.
Seen see(float ground_m, float part, vec3 front, vec3 front_passed) {
  Seen seen = Seen(vec3(0.0), vec3(1.0), part == FRONT_ONLY ? FRONT_MISSED : 0.0);
  if (!begin_planet_ray()) return seen;
#ifdef NEPHO_SUN_MAP
  begin_sun_map();
#endif
#define NEPHO_DO(v) walks[v] = begin_walk(v);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
#ifdef NEPHO_AIR
  begin_air(ground_m);
#endif
  begin_lights();
  float last_m = min(ground_m, FAR);
  // Accounted for up to t; no cloud before `clear`.
  float t = 0.0, clear = 0.0, span_end = last_m;
  int ended = 0;
#ifdef NEPHO_AIR
  if (part == FRONT_ONLY) {
    last_m = air_front_m;
    ended = air_front_m < 0.0 ? 1 : 0;
    seen.optical_depth = air_front_m < 0.0 ? FRONT_MISSED : 0.0;
  }
  if (part == BEHIND_FRONT && air_front_m > 0.0 && air_front_m < ground_m) {
    seen = Seen(front, front_passed, 0.0);
    t = clear = air_front_m;
    resume_air(t);
  }
#endif
  // Loops within loops: llvmpipe runs what is in branches at every turn. A new frame (fp64) costs most,
  // then a span of air, then a step of cloud, then a leaf.
  while (ended == 0) {
    enter_walks(clear);
    int entered = 1;
    while (entered == 1) {
#ifdef NEPHO_AIR
      if (t >= span.end_m) next_span();
      span_end = min(span.end_m, last_m);
#endif
      int inside = 1;
      while (inside == 1) {
        bool empty, smooth_, enters;
        float leave;
        int looking = 1;
        while (looking == 1) {
          leave = settle_walks(clear, empty, smooth_, enters);
          march.fresh = march.fresh || empty;
          if (empty && !enters) clear = min(max(clear, leave), span_end);
          if (enters || clear >= span_end || (!empty && leave > clear)) looking = 0;
        }
#ifdef NEPHO_AIR
        add_air(seen, t, clear);
#endif
        t = clear;
        if (!enters && t < span_end) {
          float stop = min(leave, span_end);
          march_segment(seen, t, stop, smooth_);
          t = clear = stop;
        }
        if (t >= last_m || passed(seen) < frame.least_transmittance) ended = 1;
        if (enters || ended == 1) entered = 0;
        if (entered == 0 || t >= span_end) inside = 0;
      }
    }
  }
  count_overrun(ended);
  return seen;
}
