// Look-ups in the tables of air/air_tables.h.
layout(binding = 3) uniform sampler2D depth_table;
layout(binding = 4) uniform sampler2DArray light_table;  // layers: LIGHT_*
const float LIGHT_MULTIPLE = 0.0, LIGHT_MULTIPLE_P2 = 1.0, LIGHT_UP = 2.0, LIGHT_SIDE = 3.0, LIGHT_DOWN = 4.0,
            LIGHT_LOW = 5.0;

vec2 table_place(vec2 at, ivec2 size) {
  return vec2(air_texture_coordinate(at.x, float(size.x)), air_texture_coordinate(at.y, float(size.y)));
}

// Optical depth to the top of the air; along the horizon for a direction below it.
vec3 depth_to_top(float height_m, float mu) {
  vec2 at;
  air_depth_coordinates(float(planet.radius_m), planet.air_top_m, height_m, mu, at.x, at.y);
  return textureLod(depth_table, table_place(at, textureSize(depth_table, 0)), 0.0).rgb;
}

// Irradiance across the sun's beam, behind the air and over the horizon.
vec3 sun_in_air(float height_m, float mu_sun) {
  float part = planet_sun_part(height_m, mu_sun);
  if (part <= 0.0) return vec3(0.0);
  return part * exp(-depth_to_top(height_m, mu_sun)) * vec_of(frame.sun_irradiance);
}

vec2 light_place(float height_m, float mu_sun) {
  vec2 at;
  air_light_coordinates(planet.air_top_m, height_m, mu_sun, at.x, at.y);
  return table_place(at, textureSize(light_table, 0).xy);
}
vec3 air_light(vec2 place, float layer) {
  return textureLod(light_table, vec3(place, layer), 0.0).rgb * vec_of(frame.sun_irradiance);
}
