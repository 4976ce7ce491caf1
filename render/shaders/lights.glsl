// In-scattered light per unit of optical depth, from the light tiles. One sun, octaves or single
// scattering, and the sky seen along six directions (interim models: docs/accuracy.md).

// Phase function towards the eye times a^n, per octave: the sun is distant, so once per ray.
// Orders above 0 are grey.
vec3 first_phase[NEPHO_VOLUMES];
float octave_phase[NEPHO_VOLUMES * NEPHO_OCTAVES];
float octave_rate[NEPHO_OCTAVES];  // b^n, once per ray
#ifdef NEPHO_ICE
layout(binding = 2) uniform sampler3D ice_atlas;
vec3 first_ice[NEPHO_VOLUMES];  // the same of ice
float octave_ice[NEPHO_VOLUMES * NEPHO_OCTAVES];
#endif

layout(std430, binding = 4) readonly buffer PhaseBuffer { float phase_log[]; };  // rows of 1024 x 3

vec3 table_phase(int row, float one_minus_cos) {
  float at = phase_table_coordinate(one_minus_cos) * 1023.0;
  int i = clamp(int(at), 0, 1022);
  float f = at - float(i);
  vec3 value;
  for (int c = 0; c < 3; ++c) {
    float a = phase_log[(row * 1024 + i) * 3 + c], b = phase_log[(row * 1024 + i + 1) * 3 + c];
    value[c] = exp(a + (b - a) * f);
  }
  return value;
}

#ifdef NEPHO_ICE
// Part of a volume's extinction that is ice.
float ice_part(int volume, float t_m) {
  if (walks[volume].kind != NODE_BRICK || walks[volume].ice_range_per_m + walks[volume].ice_offset_per_m <= 0.0) return 0.0;
  vec3 at = walks[volume].tile + leaf_cells_at(volume, walks[volume], t_m);
#ifdef NEPHO_TEXELS8
  float code = texel8(ice_atlas, at);
#else
  float code = textureLod(ice_atlas, (at + 0.5) * per_atlas_texel, 0.0).r;
#endif
  float ice = walks[volume].ice_offset_per_m + walks[volume].ice_range_per_m * code;
  // Where extinction goes to 0, the brick's own part stands for the limit.
  float most = walks[volume].range_per_m + walks[volume].offset_per_m, least = 1e-5 * most;
  float whole = clamp((walks[volume].ice_range_per_m + walks[volume].ice_offset_per_m) / most, 0.0, 1.0);
  return clamp((ice + least * whole) / (last_extinction[volume] + least), 0.0, 1.0);
}

void set_ice_octaves(int volume, float one_minus_cos) {
  first_ice[volume] = table_phase(volumes[volume].ice_phase_row, one_minus_cos);
#define NEPHO_DO_OCTAVE(n)                \
  octave_ice[volume * NEPHO_OCTAVES + n] = \
      octave_scattering(n) * hg_phase(one_minus_cos, octave_asymmetry(n, volumes[volume].ice_asymmetry));
  NEPHO_EACH_OCTAVE
#undef NEPHO_DO_OCTAVE
}
#endif

// Octaves are written out too (NEPHO_EACH_OCTAVE, from 1): powers of literals fold.
void set_octaves(int volume, float one_minus_cos) {
#define NEPHO_DO_OCTAVE(n)                    \
  octave_phase[volume * NEPHO_OCTAVES + n] =  \
      octave_scattering(n) * hg_phase(one_minus_cos, octave_asymmetry(n, volumes[volume].asymmetry));
  NEPHO_EACH_OCTAVE
#undef NEPHO_DO_OCTAVE
}

void begin_lights() {
  vec3 apart = vec3(vec_of(frame.to_sun) - ray_direction);
  float one_minus_cos = 0.5 * dot(apart, apart);
#define NEPHO_DO_OCTAVE(n) octave_rate[n] = octave_extinction(n);
  NEPHO_EACH_OCTAVE
#undef NEPHO_DO_OCTAVE
#define NEPHO_DO(v)                                                                              \
  first_phase[v] = table_phase(volumes[v].phase_row, one_minus_cos);                              \
  set_octaves(v, one_minus_cos);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
#ifdef NEPHO_ICE
#define NEPHO_DO(v) set_ice_octaves(v, one_minus_cos);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
#endif
}

#ifdef NEPHO_GROUND
// What arrives at the last place asked for: across the sun's beam, and from the sky.
vec3 sun_light, light_up, light_side, light_down;
void light_at(float t_m) {
#if defined(NEPHO_AIR) && defined(NEPHO_CLOUDS)
  vec3 w = span_weights(t_m);
  sun_light = max(w.x * span.sun0 + w.y * span.sun1 + w.z * span.sun2, vec3(0.0));
  float u = w.z + 0.5 * w.y;  // the part of the span that is behind
  light_up = mix(span.up0, span.up2, u);
  light_side = mix(span.side0, span.side2, u);
  light_down = mix(span.down0, span.down2, u);
#else
  float height_m, mu, mu_sun;
  planet_place(t_m, height_m, mu, mu_sun);
  sun_light = planet_sun_part(height_m, mu_sun) * vec_of(frame.sun_irradiance);
#endif
}
#else
float sun_part;  // of the sun's disc that the planet leaves free; set by total_source_at
#endif

#if defined(NEPHO_SHELL) && !defined(NEPHO_GROUND)
float sun_part_at(float t_m) {
  dvec3 stretch = dvec3(1.0LF, 1.0LF, frame.ground_z_scale);
  dvec3 p = stretch * (ray_start + ray_direction * double(t_m)), s = stretch * vec_of(frame.to_sun);
  double r = sqrt(dot(p, p));
  float sine = float(dot(p, s) / (r * sqrt(dot(s, s))));
  return sun_above_horizon(float(frame.ground_radius_m), float(r - frame.ground_radius_m), sine);
}
#endif

#ifdef NEPHO_TEXELS8
// Of eight texels by weights of float: filters have weights of 8 bits.
vec4 light_texel8(vec3 at) {
  vec3 f = fract(at);
  ivec3 p = ivec3(at);
  ivec3 n = ivec3(greaterThan(f, vec3(0.0)));  // never beyond the tile
  vec4 low = mix(mix(texelFetch(light_atlas, p, 0), texelFetch(light_atlas, p + ivec3(n.x, 0, 0), 0), f.x),
                 mix(texelFetch(light_atlas, p + ivec3(0, n.y, 0), 0), texelFetch(light_atlas, p + ivec3(n.x, n.y, 0), 0), f.x), f.y);
  vec4 high = mix(mix(texelFetch(light_atlas, p + ivec3(0, 0, n.z), 0), texelFetch(light_atlas, p + ivec3(n.x, 0, n.z), 0), f.x),
                  mix(texelFetch(light_atlas, p + ivec3(0, n.y, n.z), 0), texelFetch(light_atlas, p + n, 0), f.x), f.y);
  return mix(low, high, f.z);
}
#endif

// Radiance of one volume at t_m: J / extinction, W m-2 sr-1 nm-1.
vec3 source_at(int volume, float t_m) {
  vec3 at = walks[volume].light_tile + leaf_cells_at(volume, walks[volume], t_m);
#ifdef NEPHO_TEXELS8
  vec4 light = light_texel8(at);
#else
  vec4 light = textureLod(light_atlas, (at + 0.5) * per_light_texel, 0.0);
#endif
  float first = exp(-light.r), higher = 0.0;
#ifdef NEPHO_ICE
  // k S = (k - k_ice) S_liquid + k_ice S_ice.
  float ice = ice_part(volume, t_m), higher_ice = 0.0;
#define NEPHO_DO_OCTAVE(n) {                                    \
  float through = exp(-(octave_rate[n] * light.r));             \
  higher += octave_phase[volume * NEPHO_OCTAVES + n] * through; \
  higher_ice += octave_ice[volume * NEPHO_OCTAVES + n] * through; }
  NEPHO_EACH_OCTAVE
#undef NEPHO_DO_OCTAVE
  vec3 scattered = mix(first_phase[volume] * first + higher, first_ice[volume] * first + higher_ice, ice);
#else
#define NEPHO_DO_OCTAVE(n) higher += octave_phase[volume * NEPHO_OCTAVES + n] * exp(-(octave_rate[n] * light.r));
  NEPHO_EACH_OCTAVE
#undef NEPHO_DO_OCTAVE
  vec3 scattered = first_phase[volume] * first + higher;
#endif
#ifdef NEPHO_GROUND
  vec3 radiance = scattered * sun_light;
#else
  vec3 radiance = sun_part * scattered * vec_of(frame.sun_irradiance);
#endif
#if defined(NEPHO_SKY_LIGHT) && defined(NEPHO_GROUND)
  for (int c = 0; c < 3; ++c)
    radiance[c] += sky_source(light.g, light.b, light.a, light_up[c], light_side[c], light_down[c]);
#elif defined(NEPHO_SKY_LIGHT)
  for (int c = 0; c < 3; ++c)
    radiance[c] += sky_source(light.g, light.b, light.a, frame.zenith[c], frame.horizon[c], frame.below[c]);
#endif
#ifdef NEPHO_ABSORPTION
  radiance *= vec_of(volumes[volume].albedo);
#endif
  return radiance;
}

// Source of all volumes at t_m, where total_extinction_at was asked last, weighted by their
// extinctions; where there is none, the mean of those that a neighbouring sample could bring in:
// finite, and continuous as extinction goes to 0.
vec3 total_source_at(float t_m) {
#ifdef NEPHO_GROUND
  light_at(t_m);
#elif defined(NEPHO_SHELL)
  sun_part = sun_part_at(t_m);
#else
  sun_part = 1.0;
#endif
#if NEPHO_VOLUMES == 1
  return source_at(0, t_m);
#else
  vec3 sum = vec3(0.0);
  float weight = 0.0;
#define NEPHO_DO(v)                                                        \
  if (walks[v].kind == NODE_BRICK || walks[v].kind == NODE_CONSTANT) {     \
    float k = max(last_extinction[v], 1e-30);                              \
    sum += k * source_at(v, t_m);                                          \
    weight += k;                                                           \
  }
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return weight > 0.0 ? sum / weight : vec3(0.0);
#endif
}
