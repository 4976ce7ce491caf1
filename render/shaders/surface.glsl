// Where a ray meets the planet: the ellipsoid, or the heights of a surface map over it (under the
// ellipsoid they count as 0).
#ifdef NEPHO_TERRAIN
layout(binding = 6) uniform sampler2D surface_map;  // height in m, part of water

// The ray in the map: angles from the start, in fp64, and what their change along the ray needs.
struct SurfaceRay {
  vec2 node;         // of the start
  float about_m;     // its distance from the axis of x
  float about_rise;  // radial and tangential parts of the ray in the plane across that axis
  float about_turn;
  float north_m, north_along;
};
SurfaceRay surface_ray;

void begin_surface_ray() {
  dvec3 p = planet_scaled(ray_start), d = planet_scaled(ray_direction);
  d /= sqrt(dot(d, d));
  dvec3 at, along;
  for (int row = 0; row < 3; ++row) {
    dvec3 axis = dvec3(planet.surface_axes[3 * row], planet.surface_axes[3 * row + 1], planet.surface_axes[3 * row + 2]);
    at[row] = dot(axis, p);
    along[row] = dot(axis, d);
  }
  double about = sqrt(at.x * at.x + at.y * at.y);
  dvec2 angle = dvec2(atan_fp64(at.y, at.x), atan_fp64(at.z, about));
  for (int a = 0; a < 2; ++a)
    surface_ray.node[a] = float((angle[a] - planet.surface_low_rad[a]) * planet.surface_per_rad[a]);
  surface_ray.about_m = float(about);
  surface_ray.about_rise = float((at.x * along.x + at.y * along.y) / about);
  surface_ray.about_turn = float((at.x * along.y - at.y * along.x) / about);
  surface_ray.north_m = float(at.z);
  surface_ray.north_along = float(along.z);
}

// Node coordinates after t_m.
vec2 surface_node(float t_m) {
  float t = t_m * planet_ray.stretch;
  float x = angle_along_ray(surface_ray.about_m, t, surface_ray.about_rise, surface_ray.about_turn);
  // |across|^2 grows by t (2 rise about + t (1 - north^2)).
  float level = 1.0 - surface_ray.north_along * surface_ray.north_along;
  float rise = t * (2.0 * surface_ray.about_m * surface_ray.about_rise + t * level);
  float about = sqrt(max(surface_ray.about_m * surface_ray.about_m + rise, 0.0));
  float change = rise / max(about + surface_ray.about_m, 1.0);
  float north = surface_ray.north_m + t * surface_ray.north_along;
  float y = arc_tangent(t * surface_ray.north_along * surface_ray.about_m - surface_ray.north_m * change,
                        about * surface_ray.about_m + north * surface_ray.north_m);
  return surface_ray.node + vec2(x, y) * vec2(planet.surface_per_rad[0], planet.surface_per_rad[1]);
}

// The middle of the four nodes around a place, as texture coordinates, and where the place is between
// them; false outside of the map.
bool surface_cell(vec2 node, out vec2 middle, out vec2 between) {
  vec2 size = vec2(planet.surface_nx, planet.surface_ny);
  bool around = planet.surface_around != 0;
  if (around) node.x -= floor(node.x / size.x) * size.x;
  vec2 last = vec2(around ? size.x : size.x - 1.0, size.y - 1.0);
  vec2 low = min(floor(node), last - 1.0);
  between = node - low;
  middle = (low + 1.0) / size;  // a map all around repeats
  return all(greaterThanEqual(node, vec2(0.0))) && all(lessThanEqual(node, last));
}
// Filters of GPUs have steps: the four nodes are gathered. Their order is that of textureGather.
float surface_mix(vec4 four, vec2 between) {
  vec2 low_high = mix(four.wx, four.zy, between.x);
  return mix(low_high.x, low_high.y, between.y);
}
// All is sea outside of the map.
float surface_height(vec2 node) {
  vec2 middle, between;
  bool inside = surface_cell(node, middle, between);
  float height_m = surface_mix(textureGather(surface_map, middle, 0), between);
  return inside ? max(height_m, 0.0) : 0.0;
}
// With the part of water.
vec2 surface_at(vec2 node) {
  vec2 middle, between;
  bool inside = surface_cell(node, middle, between);
  float water = surface_mix(textureGather(surface_map, middle, 1), between);
  return vec2(surface_height(node), inside ? water : 1.0);
}

float height_over_surface(float t_m) { return planet_height(t_m) - surface_height(surface_node(t_m)); }

// Where the ray goes under the map's heights, between two distances; FAR where it does not. A step is
// never longer than the steepest slope allows, but for cells' third parts.
float terrain_distance(float begin_m, float end_m) {
  float t = begin_m, before = begin_m, gap = 0.0, gap_before = 1.0;
  int ended = 0;
  bool under = false;
  while (ended == 0) {
    float height_m, mu, mu_sun;
    planet_place(t, height_m, mu, mu_sun);
    gap = height_over_surface(t);
    under = gap <= 0.0;
    if (under || t >= end_m) {
      ended = 1;
    } else {
      before = t;
      gap_before = gap;
      float least = max(0.3 * planet.surface_cell_m, planet.pixel_rad * t);
      t = min(t + max(gap / (max(-mu, 0.0) + planet.surface_slope), least), end_m);
    }
  }
  if (!under) return FAR;
  // Behind the loop: llvmpipe would run it at every turn. Regula falsi, Illinois: an end that stays
  // counts half. To a centimetre: what is left is interpolated.
  float low = before, high = t, gap_low = gap_before, gap_high = gap, gap_at = 1.0;
  for (int turn = 0; turn < 6 && high > low && abs(gap_at) > 0.01; ++turn) {
    float at = clamp(low + (high - low) * gap_low / max(gap_low - gap_high, 1e-6), low, high);
    gap_at = height_over_surface(at);
    if (gap_at > 0.0) {
      low = at;
      gap_low = gap_at;
      gap_high *= 0.5;
    } else {
      high = at;
      gap_high = gap_at;
      gap_low *= 0.5;
    }
  }
  float met_m = clamp(low + (high - low) * gap_low / max(gap_low - gap_high, 1e-6), low, high);
  // At a wall, where the map ends, nothing lies between: before it is the sea, behind it the ground.
#ifndef NEPHO_MUTANT_TORN_WALL
  if (height_over_surface(met_m) > 1.0) met_m = high;
#endif
  return met_m;
}
#endif

// Where the ray of begin_planet_ray() meets the ground, or FAR.
float surface_distance() {
  float sea_m = ground_distance();
#ifdef NEPHO_TERRAIN
  float begin_m = 0.0, end_m = sea_m;
  double r = double(planet_ray.radius_m), mu = double(planet_ray.mu);
  double top = planet.radius_m + double(planet.surface_top_m) + 1.0LF;
  if (r > top) {
    double enter = mu < 0.0LF ? sphere_entry(r, mu, top, false) : -1.0LF;
    if (enter < 0.0LF) return sea_m;
    begin_m = float(enter) / planet_ray.stretch;
  }
  end_m = min(end_m, float(sphere_entry(r, mu, top, true)) / planet_ray.stretch);
  begin_surface_ray();
  return min(sea_m, terrain_distance(begin_m, end_m));
#else
  return sea_m;
#endif
}
