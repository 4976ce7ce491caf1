#version 450
// Light of what is behind all air and cloud: of the ground, by sun through air and clouds with a march
// of its own, and by the sky; where there is none, of the night sky and the sun's disc. Of the pixels
// that the buffer names, in its order: neighbours side by side.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D atlas;
// Three for each pixel. Before: the second holds its place and the distance of the ground. After: the
// first holds the radiance.
layout(std430, binding = 5) restrict buffer PixelBuffer { vec4 pixels[]; };
#include "head.glsl"
#include "walk.glsl"
#include "march.glsl"
#include "camera.glsl"
#include "planet.glsl"
#include "surface.glsl"
#ifdef NEPHO_AIR
#include "air_tables.glsl"
#endif

// Where the ray meets no ground: the night sky, and the sun's disc, whose edge is a pixel wide.
vec3 sky_beyond() {
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
  return beyond * vec_of(frame.sun_irradiance);
}

struct Place {
  dvec3 point;
  vec3 up, normal;  // of the ellipsoid, and of the ground
  float height_m, water, mu_sun;
};

Place place_at(float t_m) {
  Place place;
  place.point = ray_start + ray_direction * double(t_m);
  dvec3 gradient = planet_scaled(planet_scaled(place.point));
  place.up = place.normal = vec3(gradient / sqrt(dot(gradient, gradient)));
  place.height_m = 0.0;
  place.water = 1.0;
  float mu, height_m;
  planet_place(t_m, height_m, mu, place.mu_sun);
#ifdef NEPHO_TERRAIN
  vec2 node = surface_node(t_m);
  vec2 here = surface_at(node);
  // On a wall, where the map ends, as on its top: what is inside the ground sees no sun.
  if (here.x > height_m + 1.0) place.point += dvec3(place.up) * double(here.x - height_m);
  place.height_m = here.x;
  place.water = here.y;
  // Slope over one cell: bilinear heights then have a continuous normal.
  vec2 rise = vec2(surface_height(node + vec2(0.5, 0.0)) - surface_height(node - vec2(0.5, 0.0)),
                   surface_height(node + vec2(0.0, 0.5)) - surface_height(node - vec2(0.0, 0.5)));
  dvec3 scaled = planet_scaled(place.point);
  vec3 across = vec3(scaled / sqrt(dot(scaled, scaled)));
  vec3 north = vec3(planet.surface_axes[6], planet.surface_axes[7], planet.surface_axes[8]);
  vec3 east_here = cross(north, across);
  float level = max(length(east_here), 1e-4);
  east_here /= level;
  vec3 north_here = cross(across, east_here);
  float radius_m = float(planet.radius_m);
  vec2 slope = rise * vec2(planet.surface_per_rad[0] / level, planet.surface_per_rad[1]) / radius_m;
  place.normal = normalize(place.up - (1.0 - here.y) * (slope.x * east_here + slope.y * north_here));
#endif
#ifdef NEPHO_MUTANT_GROUND_FLIPPED
  place.normal = -place.normal;
#endif
  return place;
}

void main() {
  load_frame();
  load_planet();
  int entry = 3 * int(gl_GlobalInvocationID.x);
  if (entry >= pixels.length()) return;
  vec4 asked = pixels[entry + 1];
  pixels[entry + 1] = vec4(1.0, 1.0, 1.0, asked.z);
  begin_camera_ray(ivec2(asked.xy));
  if (!(asked.z < FAR)) {
    pixels[entry] = vec4(sky_beyond(), 0.0);
    return;
  }
  if (!begin_planet_ray()) return;
#ifdef NEPHO_TERRAIN
  begin_surface_ray();
#endif
  Place place = place_at(asked.z);
  vec3 to_eye = vec3(-ray_direction), to_sun = vec3(vec_of(frame.to_sun));
  vec3 sky_up = vec3(0.0), sky_low = vec3(0.0);
#ifdef NEPHO_AIR
  vec3 sun = sun_in_air(place.height_m, place.mu_sun);
  vec2 light = light_place(place.height_m, place.mu_sun);
  sky_up = air_light(light, LIGHT_UP);
  sky_low = air_light(light, LIGHT_LOW);
#else
  vec3 sun = planet_sun_part(place.height_m, place.mu_sun) * vec_of(frame.sun_irradiance);
#endif

  // Clouds above and towards the sun: one march, twice, so that it is compiled once.
  float tau_above = 0.0, tau_sun = 0.0;
#ifdef NEPHO_CLOUDS
  bool day = sun.r + sun.g + sun.b > 0.0;
  for (int towards_sun = 0; towards_sun < 2; ++towards_sun) {
    if (towards_sun == 1 && !day) continue;
    ray_start = place.point + dvec3(place.up) * 0.05LF;
    ray_direction = towards_sun == 1 ? vec_of(frame.to_sun) : dvec3(place.up);
    float tau = optical_depth_ahead(1e4);
    if (towards_sun == 1) tau_sun = tau; else tau_above = tau;
  }
#endif
  float cos_sun = dot(place.normal, to_sun);
#ifdef NEPHO_TERRAIN
  // Hills' shadows.
  if (sun.r + sun.g + sun.b > 0.0 && cos_sun > 0.0) {
    ray_start = place.point + dvec3(place.up) * 0.05LF + dvec3(place.normal) * double(0.02 * planet.surface_cell_m);
    ray_direction = vec_of(frame.to_sun);
    if (begin_planet_ray() && surface_distance() < FAR) cos_sun = -1.0;
  }
#endif
  float g = planet.cloud_asymmetry;
  float sky_part = cloud_daylight(2.0 * tau_above, tau_above, 0.5, g);  // as if from 60 degrees
  float direct = exp(-tau_sun);
  // What clouds overhead scatter down counts as the sun's light on level ground.
  float mu_sun = max(dot(place.up, to_sun), 0.0);
  float scattered = max(cloud_daylight(tau_sun, tau_above, mu_sun, g) - direct, 0.0);
  vec3 free_up = sky_up, free_low = sky_low;
  sky_up *= sky_part;
  sky_low *= sky_part;
  vec3 under = scattered * mu_sun / pi * sun;  // as the radiance of an even sky
  vec3 half_way = normalize(to_eye + to_sun);
  float mu = max(dot(place.up, to_eye), 1e-5);
  vec3 radiance;
  for (int c = 0; c < 3; ++c) {
    float land = land_radiance(planet.land_albedo[c], direct * sun[c], cos_sun, sky_up[c] + under[c], sky_low[c] + under[c]);
    float water = water_radiance(planet.water_albedo[c], direct * sun[c], mu, max(cos_sun, 0.0), dot(place.up, half_way),
                                 dot(half_way, to_sun), planet.slope_variance, sky_up[c] + under[c], sky_low[c] + under[c]);
#ifndef NEPHO_MUTANT_MIRRORED_DAYLIGHT
    water += water_mirror_excess(mu, planet.slope_variance, sky_up[c] + under[c], sky_low[c] + under[c],
                                 free_up[c], free_low[c]);
#endif
    radiance[c] = mix(land, water, place.water);
  }
  pixels[entry] = vec4(radiance, 0.0);
}
