// Clear air along the view ray: spans with three knots each, between which extinction and emission
// are quadratic. Spans grow with height and distance alone, smoothly, and the last one ends where the
// air does: pictures show no knots. Clouds are marched within the spans.

#ifndef NEPHO_AIR_FINENESS
#define NEPHO_AIR_FINENESS 1.0
#endif

struct Span {
  float begin_m, end_m;
  bool has_air;
  vec3 k0, k1, k2;  // extinction, 1/m
  vec3 j0, j1, j2;  // emission, W m-3 sr-1 nm-1; with a sun map: of the sun's own light
#ifdef NEPHO_SUN_MAP
  vec3 m0, m1, m2;     // of all other light
  float lit_a, lit_b;  // part of the sun's light that clouds leave, mean over each half
#endif
};
Span span;
float air_enter_m, air_leave_m;            // where the ray is in the air
float rayleigh_to_eye, aerosol_to_eye;  // phase functions

void air_knot(float t_m, out vec3 k, out vec3 j, out vec3 more) {
  float height_m, mu, mu_sun;
  planet_place(t_m, height_m, mu, mu_sun);
  float molecules = air_exponential(height_m, planet.rayleigh_scale_m);
  float aerosol = air_exponential(height_m, planet.aerosol_scale_m);
  float ozone = air_ozone(height_m, planet.ozone_low_m, planet.ozone_peak_m, planet.ozone_high_m);
#ifdef NEPHO_MUTANT_HALF_AIR
  molecules *= 0.5;
#endif
  vec3 rayleigh = molecules * vec_of(planet.rayleigh_per_m);
  k = rayleigh + aerosol * vec_of(planet.aerosol_per_m) + ozone * vec_of(planet.ozone_per_m);
  vec3 sun = sun_in_air(height_m, mu_sun);
  vec2 place = light_place(height_m, mu_sun);
  vec3 multiple = air_light(place, LIGHT_MULTIPLE), p2 = air_light(place, LIGHT_MULTIPLE_P2);
  for (int c = 0; c < 3; ++c) {
    float a = aerosol * planet.aerosol_scattering_per_m[c];
    j[c] = air_emission(rayleigh[c], a, sun[c], rayleigh_to_eye, aerosol_to_eye, 0.0, 0.0, mu);
    more[c] = air_emission(rayleigh[c], a, 0.0, rayleigh_to_eye, aerosol_to_eye, multiple[c], p2[c], mu);
  }
}

#ifdef NEPHO_SUN_MAP
float lit_mean(float begin_m, float length_m) {
  return (sun_visible(begin_m + length_m * (1.0 / 6.0)) + sun_visible(begin_m + length_m * 0.5) +
          sun_visible(begin_m + length_m * (5.0 / 6.0))) * (1.0 / 3.0);
}
#endif

// Length of the span that begins at t_m: three knots resolve the scale heights, the curvature of a
// level ray, and 1.2 of optical depth; where clouds cast shadows, also the distance to the eye.
float span_length(float t_m) {
  float height_m, mu, mu_sun;
  planet_place(t_m, height_m, mu, mu_sun);
  float up_m = max(height_m, 0.0), above = (up_m + 1000.0) / (1.0 + up_m * (1.0 / 30e3));
  const float growth = 0.4;
  float steep = mu * (mu > 0.0 ? 1.0 : 1.0 + growth) / (growth * above);
  float thick = (planet.rayleigh_per_m[2] * air_exponential(height_m, planet.rayleigh_scale_m) +
                 planet.aerosol_per_m[2] * air_exponential(height_m, planet.aerosol_scale_m)) / 1.2;
  float inverse2 = steep * steep + 1.0 / (2.0 * growth * planet_ray.radius_m * above) + thick * thick;
  // Under a sun below the horizon, also the height at which its beam passed over the ground.
  float level = sqrt(max(1.0 - mu_sun * mu_sun, 1e-4));
  float passed_m = height_m - planet_ray.radius_m * mu_sun * mu_sun / (1.0 + level);
  float edge = (mu - mu_sun * planet_ray.sun_along) / (level * growth * (abs(passed_m) + 5000.0));
  inverse2 += clamp(-50.0 * mu_sun, 0.0, 1.0) * edge * edge;
#ifdef NEPHO_SUN_MAP
  if (height_m < planet.cloud_top_m) {
    float near = 1.0 / (0.25 * t_m + 400.0);
    inverse2 += near * near;
  }
#endif
  return inversesqrt(inverse2) / (planet_ray.stretch * NEPHO_AIR_FINENESS);
}

// The span behind this one. Before and behind the air there is nothing, in one span.
void next_span() {
  float t = span.end_m;
  bool first = !span.has_air;
  span.begin_m = t;
  span.has_air = t >= air_enter_m && t < air_leave_m;
  if (!span.has_air) {
    span.end_m = t < air_enter_m ? air_enter_m : FAR;
    return;
  }
  span.end_m = min(t + span_length(t), air_leave_m);
  span.k0 = span.k2;
  span.j0 = span.j2;
#ifdef NEPHO_SUN_MAP
  span.m0 = span.m2;
#endif
  for (int knot = first ? 0 : 1; knot < 3; ++knot) {  // a loop: one copy of the look-ups to compile
    vec3 k, j, m;
    air_knot(t + 0.5 * float(knot) * (span.end_m - t), k, j, m);
#ifndef NEPHO_SUN_MAP
    j += m;
#endif
    if (knot == 0) {
      span.k0 = k;
      span.j0 = j;
    } else if (knot == 1) {
      span.k1 = k;
      span.j1 = j;
    } else {
      span.k2 = k;
      span.j2 = j;
    }
#ifdef NEPHO_SUN_MAP
    if (knot == 0)
      span.m0 = m;
    else if (knot == 1)
      span.m1 = m;
    else
      span.m2 = m;
#endif
  }
#ifdef NEPHO_SUN_MAP
  float half_m = 0.5 * (span.end_m - t);
  span.lit_a = lit_mean(t, half_m);
  span.lit_b = lit_mean(t + half_m, half_m);
#endif
}

// Starts the spans of the ray of begin_planet_ray(), which ends at end_m at the latest.
void begin_air(float end_m) {
  vec3 apart = vec3(vec_of(frame.to_sun) - ray_direction);
  float one_minus_cos = 0.5 * dot(apart, apart);
  rayleigh_to_eye = rayleigh_phase(one_minus_cos);
  aerosol_to_eye = cornette_shanks_phase(one_minus_cos, planet.aerosol_asymmetry);
  air_enter_m = air_leave_m = FAR;
  double r = double(planet_ray.radius_m), mu = double(planet_ray.mu);
  double top = planet.radius_m + double(planet.air_top_m);
  double enter = 0.0LF;
  if (r > top) enter = mu < 0.0LF ? sphere_entry(r, mu, top, false) : -1.0LF;
  double leave = sphere_entry(r, mu, top, true);
  if (enter >= 0.0LF && leave > enter) {
    air_enter_m = float(enter) / planet_ray.stretch;
    air_leave_m = min(float(leave) / planet_ray.stretch, end_m);
  }
  span.begin_m = span.end_m = 0.0;
  span.has_air = false;
  if (air_leave_m <= air_enter_m) air_enter_m = air_leave_m = FAR;
}

// Weights of the three knots after the part u of the span.
vec3 span_weights(float t_m) {
  float u = clamp((t_m - span.begin_m) / max(span.end_m - span.begin_m, 1e-3), 0.0, 1.0);
  return vec3((1.0 - u) * (1.0 - 2.0 * u), 4.0 * u * (1.0 - u), u * (2.0 * u - 1.0));
}
vec3 air_extinction(vec3 w) { return max(w.x * span.k0 + w.y * span.k1 + w.z * span.k2, vec3(0.0)); }
vec3 air_emission_at(vec3 w, float lit) {
  vec3 j = max(w.x * span.j0 + w.y * span.j1 + w.z * span.j2, vec3(0.0));
#ifdef NEPHO_SUN_MAP
  j = lit * j + max(w.x * span.m0 + w.y * span.m1 + w.z * span.m2, vec3(0.0));
#endif
  return j;
}
float span_middle() { return 0.5 * (span.begin_m + span.end_m); }
float lit_at(float t_m) {
#ifdef NEPHO_SUN_MAP
  return t_m < span_middle() ? span.lit_a : span.lit_b;
#else
  return 1.0;
#endif
}

// Air alone, within one half of the span: Simpson on emission times transmittance.
void add_air_part(inout Seen seen, float t0, float t1, float lit) {
  float d = t1 - t0;
  vec3 w0 = span_weights(t0), w1 = span_weights(0.5 * (t0 + t1)), w2 = span_weights(t1);
  vec3 k0 = air_extinction(w0), k1 = air_extinction(w1), k2 = air_extinction(w2);
  vec3 half_way = exp(-(d * (1.0 / 24.0)) * (5.0 * k0 + 8.0 * k1 - k2));
  vec3 through = exp(-(d * (1.0 / 6.0)) * (k0 + 4.0 * k1 + k2));
  seen.radiance += seen.transmittance * (d * (1.0 / 6.0)) *
                   (air_emission_at(w0, lit) + 4.0 * half_way * air_emission_at(w1, lit) +
                    through * air_emission_at(w2, lit));
  seen.transmittance *= through;
}
void add_air(inout Seen seen, float t0, float t1) {
  if (!span.has_air || t1 <= t0) return;
#ifdef NEPHO_SUN_MAP
  float middle = span_middle();
  if (t0 < middle) add_air_part(seen, t0, min(t1, middle), span.lit_a);
  if (t1 > middle) add_air_part(seen, max(t0, middle), t1, span.lit_b);
#else
  add_air_part(seen, t0, t1, 1.0);
#endif
}
