// Clear air along the view ray: spans with three knots each, between which extinction and emission
// are quadratic. Spans grow with height and distance alone, smoothly, and the last one ends where the
// air does: pictures show no knots. Clouds are marched within the spans.

// Spans are as short as the tolerance asks for: what they miss goes with their length to the power of 1.7,
// and is below 1e-2 on 99 % of the pixels at 1e-2, about the tolerance at 1e-3, and twice that at 1e-4.
float air_fineness() {
#ifdef NEPHO_MUTANT_LONG_SPANS
  return 0.1 * sqrt(1e-2 / frame.tolerance);
#endif
#ifdef NEPHO_CELL_EXACT
  const float least = 1.5;
#elif defined(NEPHO_ADAPTIVE)
  const float least = 0.7;
#else
  const float least = 1.0;  // --step: no tolerance is given
#endif
  return clamp(0.7 * sqrt(1e-2 / frame.tolerance), least, 6.0);
}

struct Span {
  float begin_m, end_m;
  bool has_air;
  vec3 k0, k1, k2;  // extinction, 1/m
  vec3 j0, j1, j2;  // emission, W m-3 sr-1 nm-1; with a sun map: of the sun's own light
#ifdef NEPHO_SUN_MAP
  vec3 m0, m1, m2;  // of all other light
  vec2 lit;         // part of the sun's light that clouds leave, mean over either half
#endif
#ifdef NEPHO_CLOUDS
  vec3 sun0, sun1, sun2;  // across its beam
  vec3 up0, up2, side0, side2, down0, down2;  // sky light on clouds, linear
#endif
};
Span span;
float air_enter_m, air_leave_m;            // where the ray is in the air
float air_front_m;  // where a ray from above all clouds comes to the sphere around them; else negative
float rayleigh_to_eye, aerosol_to_eye;  // phase functions

struct Knot {
  vec3 k, j, m, sun;
  vec2 light;  // place in light_table
};
Knot air_knot(float t_m) {
  Knot knot;
  float height_m, mu, mu_sun;
  planet_place(t_m, height_m, mu, mu_sun);
  float molecules = air_exponential(height_m, planet.rayleigh_scale_m);
  float aerosol = air_exponential(height_m, planet.aerosol_scale_m);
  float ozone = air_ozone(height_m, planet.ozone_low_m, planet.ozone_peak_m, planet.ozone_high_m);
#ifdef NEPHO_MUTANT_HALF_AIR
  molecules *= 0.5;
#endif
  vec3 rayleigh = molecules * vec_of(planet.rayleigh_per_m);
  knot.k = rayleigh + aerosol * vec_of(planet.aerosol_per_m) + ozone * vec_of(planet.ozone_per_m);
  knot.sun = sun_in_air(height_m, mu_sun);
  knot.light = light_place(height_m, mu_sun);
  vec3 multiple = air_light(knot.light, LIGHT_MULTIPLE), p2 = air_light(knot.light, LIGHT_MULTIPLE_P2);
  for (int c = 0; c < 3; ++c) {
    float a = aerosol * planet.aerosol_scattering_per_m[c];
    knot.j[c] = air_emission(rayleigh[c], a, knot.sun[c], rayleigh_to_eye, aerosol_to_eye, 0.0, 0.0, mu);
    knot.m[c] = air_emission(rayleigh[c], a, 0.0, rayleigh_to_eye, aerosol_to_eye, multiple[c], p2[c], mu);
  }
#ifndef NEPHO_SUN_MAP
  knot.j += knot.m;
#endif
  return knot;
}

#ifdef NEPHO_SUN_MAP
// Means over the halves of a span: where it ends in a cloud, the air in front is lit all the same.
// Six places, so that an edge that comes near shows no steps. None where no cloud is above the span: its
// lowest place is not under a chord's by more than the square of its length over 8 radii.
vec2 lit_halves(float begin_m, float length_m) {
  float scaled_m = length_m * planet_ray.stretch;
  float lowest_m = min(planet_height(begin_m), planet_height(begin_m + length_m)) -
                   scaled_m * scaled_m / (8.0 * float(planet.radius_m));
  int places = lowest_m > planet.cloud_top_m ? 0 : 6;
  vec2 sum = vec2(0.0);
  for (int place = 0; place < places; ++place)
    sum[place / 3] += sun_visible(begin_m + length_m * (1.0 / 6.0) * (float(place) + 0.5));
  return places == 0 ? vec2(1.0) : sum * (1.0 / 3.0);
}
#endif

// Length of the span that begins at t_m: three knots resolve the scale heights, the curvature of a
// level ray, and 1.2 of optical depth; where clouds cast shadows, also the distance to the eye.
float span_length(float t_m) {
  float height_m, mu, mu_sun;
  planet_place(t_m, height_m, mu, mu_sun);
  float up_m = max(height_m, 0.0), above = (up_m + 1000.0) / (1.0 + up_m * (1.0 / 30e3));
  const float growth = 0.5;
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
    float near = 1.0 / (0.3 * t_m + 500.0);
    inverse2 += near * near;
  }
#endif
  return inversesqrt(inverse2) / (planet_ray.stretch * air_fineness());
}

// The span behind this one. Before and behind the air there is nothing, in one span.
void next_span() {
  float t = span.end_m;
  bool first = !span.has_air;
  span.begin_m = t;
  span.has_air = t >= air_enter_m && t < air_leave_m;
  if (!span.has_air) {
    span.end_m = t < air_enter_m ? air_enter_m : FAR;
    span.k0 = span.k1 = span.k2 = span.j0 = span.j1 = span.j2 = vec3(0.0);
#ifdef NEPHO_SUN_MAP
    span.m0 = span.m1 = span.m2 = vec3(0.0);
    span.lit = vec2(1.0);
#endif
#ifdef NEPHO_CLOUDS
    // Over the air, if ever.
    float height_m, mu, mu_sun;
    planet_place(t, height_m, mu, mu_sun);
    span.sun0 = span.sun1 = span.sun2 = planet_sun_part(height_m, mu_sun) * vec_of(frame.sun_irradiance);
    vec2 place = light_place(height_m, mu_sun);
    span.up0 = span.up2 = air_light(place, LIGHT_UP);
    span.side0 = span.side2 = air_light(place, LIGHT_SIDE);
    span.down0 = span.down2 = air_light(place, LIGHT_DOWN);
#endif
    return;
  }
  span.end_m = min(t + span_length(t), air_leave_m);
  if (t < air_front_m) span.end_m = min(span.end_m, air_front_m);
  span.k0 = span.k2;
  span.j0 = span.j2;
#ifdef NEPHO_SUN_MAP
  span.m0 = span.m2;
#endif
#ifdef NEPHO_CLOUDS
  span.sun0 = span.sun2;
  span.up0 = span.up2;
  span.side0 = span.side2;
  span.down0 = span.down2;
#endif
  vec2 last_light;
  for (int at = first ? 0 : 1; at < 3; ++at) {  // a loop: one copy of the look-ups to compile
    Knot knot = air_knot(t + 0.5 * float(at) * (span.end_m - t));
    if (at == 0) {
      span.k0 = knot.k;
      span.j0 = knot.j;
    } else if (at == 1) {
      span.k1 = knot.k;
      span.j1 = knot.j;
    } else {
      span.k2 = knot.k;
      span.j2 = knot.j;
    }
#ifdef NEPHO_SUN_MAP
    if (at == 0)
      span.m0 = knot.m;
    else if (at == 1)
      span.m1 = knot.m;
    else
      span.m2 = knot.m;
#endif
#ifdef NEPHO_CLOUDS
    if (at == 0)
      span.sun0 = knot.sun;
    else if (at == 1)
      span.sun1 = knot.sun;
    else
      span.sun2 = knot.sun;
    last_light = knot.light;
#endif
  }
#ifdef NEPHO_CLOUDS
  // Of its far end; the first span is short.
  span.up2 = air_light(last_light, LIGHT_UP);
  span.side2 = air_light(last_light, LIGHT_SIDE);
  span.down2 = air_light(last_light, LIGHT_DOWN);
  if (first) {
    span.up0 = span.up2;
    span.side0 = span.side2;
    span.down0 = span.down2;
  }
#endif
#ifdef NEPHO_SUN_MAP
  span.lit = lit_halves(t, span.end_m - t);
#endif
}

// Goes on at t_m, as behind a span that ends there.
void resume_air(float t_m) {
  span.end_m = t_m;
  span.has_air = t_m >= air_enter_m && t_m < air_leave_m;
  Knot knot = air_knot(t_m);
  span.k2 = knot.k;
  span.j2 = knot.j;
#ifdef NEPHO_SUN_MAP
  span.m2 = knot.m;
#endif
#ifdef NEPHO_CLOUDS
  span.sun2 = knot.sun;
  span.up2 = air_light(knot.light, LIGHT_UP);
  span.side2 = air_light(knot.light, LIGHT_SIDE);
  span.down2 = air_light(knot.light, LIGHT_DOWN);
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
  double clouds = planet.radius_m + double(planet.cloud_top_m) + 1.0LF;
  air_front_m = r > clouds ? float(sphere_entry(r, mu, clouds, false)) / planet_ray.stretch : -1.0;
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
vec3 air_emission_at(vec3 w) {
  vec3 j = max(w.x * span.j0 + w.y * span.j1 + w.z * span.j2, vec3(0.0));
#ifdef NEPHO_SUN_MAP
  // Linear between the middles of the halves, and a little beyond: an edge is not drawn on over a span.
  float u = w.z + 0.5 * w.y;
  float lit = clamp(mix(span.lit.x, span.lit.y, clamp(2.0 * u - 0.5, -0.25, 1.25)), 0.0, 1.0);
  j = lit * j + max(w.x * span.m0 + w.y * span.m1 + w.z * span.m2, vec3(0.0));
#endif
  return j;
}

// Air alone, within the span: Simpson on emission times transmittance.
void add_air(inout Seen seen, float t0, float t1) {
  if (!span.has_air) return;
  float d = t1 - t0;
  vec3 w0 = span_weights(t0), w1 = span_weights(0.5 * (t0 + t1)), w2 = span_weights(t1);
  vec3 k0 = air_extinction(w0), k1 = air_extinction(w1), k2 = air_extinction(w2);
  vec3 half_way = exp(-(d * (1.0 / 24.0)) * (5.0 * k0 + 8.0 * k1 - k2));
  vec3 through = exp(-(d * (1.0 / 6.0)) * (k0 + 4.0 * k1 + k2));
  seen.radiance += seen.transmittance * (d * (1.0 / 6.0)) *
                   (air_emission_at(w0) + 4.0 * half_way * air_emission_at(w1) + through * air_emission_at(w2));
  seen.transmittance *= through;
}
