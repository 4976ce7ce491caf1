// The ray of this invocation over a planet: heights and angles along it, in scaled space.
#include "planet.layout.h"
layout(std430, binding = 7) restrict readonly buffer PlanetBuffer { PlanetData planet_in; };
PlanetData planet;  // as frame.glsl's copies; set by load_planet()
void load_planet() { planet = planet_in; }

struct PlanetRay {
  float radius_m;   // of the start, from the centre
  float height_m;   // of the start
  float true_height;  // altitude over the ellipsoid per scaled height, at the start's latitude
  float mu;         // cosine of the ray's zenith angle there
  float stretch;    // scaled metres per metre
  float sun_up_m;   // part of the start towards the sun
  float sun_along;  // cosine between ray and sun
};
PlanetRay planet_ray;

dvec3 planet_scaled(dvec3 p) { return dvec3(p.xy, p.z * planet.z_scale); }

// Sets planet_ray. A start outside of all air and cloud is moved there in fp64, so that a float of
// metres along the ray is enough; false where the ray passes by.
bool begin_planet_ray() {
  dvec3 d = planet_scaled(ray_direction), s = planet_scaled(vec_of(frame.to_sun));
  double stretch = sqrt(dot(d, d));
  d /= stretch;
  s /= sqrt(dot(s, s));
  dvec3 p = planet_scaled(ray_start);
  double r = sqrt(dot(p, p)), mu = dot(p, d) / r;
  if (r > planet.outer_m) {
    double enter = sphere_entry(r, mu, planet.outer_m, false);
    if (enter < 0.0LF) return false;
    ray_start += ray_direction * (enter / stretch);
    p = planet_scaled(ray_start);
    r = sqrt(dot(p, p));
    mu = dot(p, d) / r;
  }
  planet_ray.radius_m = float(r);
  planet_ray.height_m = float(r - planet.radius_m);
  planet_ray.true_height = 1.0;
#ifndef NEPHO_MUTANT_SCALED_HEIGHT
  const float high_m = 1e4;
  float a = float(planet.radius_m);
  planet_ray.true_height = geodetic_height(high_m, a, a / float(planet.z_scale), float(p.z / r)) / high_m;
#endif
  planet_ray.mu = float(mu);
  planet_ray.stretch = float(stretch);
  planet_ray.sun_up_m = float(dot(p, s));
  planet_ray.sun_along = float(dot(d, s));
  return true;
}

float planet_height(float t_m) {
  return planet_ray.height_m + height_along_ray(planet_ray.radius_m, t_m * planet_ray.stretch, planet_ray.mu);
}

// Altitude, and the cosines of the zenith angles of ray and sun, after t_m.
void planet_place(float t_m, out float height_m, out float mu, out float mu_sun) {
  float t = t_m * planet_ray.stretch;
  float rise = height_along_ray(planet_ray.radius_m, t, planet_ray.mu), r = planet_ray.radius_m + rise;
  height_m = planet_ray.true_height * (planet_ray.height_m + rise);
  mu = clamp((planet_ray.radius_m * planet_ray.mu + t) / r, -1.0, 1.0);
  mu_sun = clamp((planet_ray.sun_up_m + t * planet_ray.sun_along) / r, -1.0, 1.0);
}

// Part of the sun's disc that the planet leaves free.
float planet_sun_part(float height_m, float mu_sun) {
#ifdef NEPHO_MUTANT_SUN_GONE
  if (mu_sun < -0.05) return 0.0;
#endif
  return sun_above_horizon(float(planet.radius_m), height_m, mu_sun);
}
