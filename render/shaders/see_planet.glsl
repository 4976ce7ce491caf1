// The view ray over a planet: clouds within spans of air, to the ground.

Seen see(out float ground_m) {
  Seen seen = Seen(vec3(0.0), vec3(1.0), 0.0);
  ground_m = FAR;
  if (!begin_planet_ray()) return seen;
  ground_m = surface_distance();
#ifdef NEPHO_SUN_MAP
  begin_sun_map();
#endif
#define NEPHO_DO(v) walks[v] = begin_walk(v);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
#ifdef NEPHO_AIR
  begin_air(ground_m);
#endif
  bool lit = false;
  vec3 s0 = vec3(0.0);
  // Accounted for up to t; without extinction of clouds up to `clear`.
  float t = 0.0, clear = 0.0;
  int ended = 0;
  while (ended == 0) {
#ifdef NEPHO_AIR
    if (t >= span.end_m) next_span();
    float span_end = span.end_m;
#else
    float span_end = FAR;
#endif
    bool empty, smooth_;
    float leave = settle_walks(clear, empty, smooth_);
    float stop = min(min(leave, span_end), ground_m);
    if (empty || leave >= FAR) {
      lit = false;
      if (stop >= min(span_end, ground_m)) {
#ifdef NEPHO_AIR
        add_air(seen, t, min(stop, air_leave_m));
#endif
        t = stop;
      }
    } else {
#ifdef NEPHO_AIR
      add_air(seen, t, clear);
#endif
      if (!lit) {
        begin_lights();
        lit = true;
      }
      s0 = total_source_at(clear);
      march_segment(seen, clear, stop, smooth_, s0);
      t = stop;
    }
    clear = stop;
    if (stop >= FAR || stop >= ground_m || passed(seen) < frame.least_transmittance) ended = 1;
  }
  count_overrun(ended);
  return seen;
}

// Where the ray meets no ground: the night sky, and the sun's disc, whose edge is a pixel wide.
void add_sky_beyond(inout Seen seen) {
  const float radius_rad = 0.004675;
  vec3 apart = vec3(vec_of(frame.to_sun) - ray_direction);
  float angle = 2.0 * arc_tangent(0.5 * length(apart), sqrt(max(1.0 - 0.25 * dot(apart, apart), 0.0)));
  float width = max(planet.pixel_rad, 1e-5);
  float part = clamp((radius_rad - angle) / width + 0.5, 0.0, 1.0);
  // A pixel wider than the disc holds no more light than the disc.
  part *= min(1.0, pi * radius_rad * radius_rad / (width * width));
  float beyond = part / (pi * radius_rad * radius_rad);
#ifdef NEPHO_AIR
  beyond += night_sky;
#endif
  seen.radiance += seen.transmittance * beyond * vec_of(frame.sun_irradiance);
}
