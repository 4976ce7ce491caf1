// Every shared equation behind one door, in the common subset: the same rows of numbers go through
// it as GLSL, float, double and dimension-checked C++. `which`: Case::which of cases.cpp.
// Mutants replace an equation by the usual form that the project must not use.

#ifdef NEPHO_MUTANT_NAIVE_E0
Number tested_e0(Number x) {
  return (Number(1.0) - exp(-x)) / x;
}
#else
Number tested_e0(Number x) {
  return exp_e0(x);
}
#endif

#ifdef NEPHO_MUTANT_NAIVE_W1
Number tested_w1(Number x) {
  return (Number(1.0) - (Number(1.0) + x) * exp(-x)) / x / x;
}
#else
Number tested_w1(Number x) {
  return exp_w1(x);
}
#endif

#ifdef NEPHO_MUTANT_USUAL_HG
InverseSolidAngle tested_hg(Number one_minus_cos, Number g) {
  Number mu = Number(1.0) - one_minus_cos;
  Number k = Number(1.0) + g * g - Number(2.0) * g * mu;
  return (Number(1.0) - g * g) / (k * sqrt(k)) * InverseSolidAngle(0.079577471545947667884);
}
#else
InverseSolidAngle tested_hg(Number one_minus_cos, Number g) {
  return hg_phase(one_minus_cos, g);
}
#endif

#ifdef NEPHO_MUTANT_FLOAT_INDICES
// Indices and altitudes as floats, then the difference: it loses a wall close by.
Number tested_offset(int wall, int nearest, Number offset_cells, Number spacing) {
  return (Number(wall) - (Number(nearest) + offset_cells)) * spacing;
}
Length tested_drop(int wall, int nearest, Number offset_cells, Length spacing) {
  return Number(wall) * spacing - (Number(nearest) + offset_cells) * spacing;
}
#else
Length tested_drop(int wall, int nearest, Number offset_cells, Length spacing) {
  return wall_height(wall, nearest, offset_cells, spacing);
}
Number tested_offset(int wall, int nearest, Number offset_cells, Number spacing) {
  return wall_offset(wall, nearest, offset_cells, spacing);
}
#endif

#ifdef NEPHO_MUTANT_ROUNDED_COSINE
Number tested_coordinate(Number one_minus_cos) {
  Number mu = Number(1.0) - one_minus_cos;
  return sqrt(arc_tangent(sqrt(max(Number(1.0) - mu * mu, Number(0.0))), mu) / pi);
}
#else
Number tested_coordinate(Number one_minus_cos) {
  return phase_table_coordinate(one_minus_cos);
}
#endif

#ifdef NEPHO_MUTANT_PLANE_EQUATION
// The wall's plane through the axis, the camera's position turned into its frame.
Length tested_angular(Length radius, Number angle, Number radial, Number tangential) {
  Number bearing = Number(0.7);  // of the camera, from the axis of the lattice
  Number wall = bearing + angle;
  Number s = Number(0.644217687237691);
  Number c = Number(0.764842187284489);
  Number wall_s;
  Number wall_c;
  sin_cos_small(wall, wall_s, wall_c);
  Length x = radius * c;
  Length y = radius * s;
  Number dx = radial * c - tangential * s;
  Number dy = radial * s + tangential * c;
  return (x * wall_s - y * wall_c) / (dy * wall_c - dx * wall_s);
}
#else
Length tested_angular(Length radius, Number angle, Number radial, Number tangential) {
  return angular_wall_distance(radius, angle, radial, tangential);
}
#endif

#ifdef NEPHO_MUTANT_ROUNDED_SQUARES
void tested_spheres(Length radius, Length above, Number cos_zenith, OUT(Length) first,
                    OUT(Length) second) {
  Length b = radius * cos_zenith;
  Area c = above * (Number(2.0) * radius - above);
  Area discriminant = b * b - c;
  first = no_hit();
  second = no_hit();
  if (discriminant < Area(0.0)) return;
  Length root = sqrt(discriminant);
  Length q = b < Length(0.0) ? root - b : -(b + root);
  first = min(q, c / q);
  second = max(q, c / q);
}
#else
void tested_spheres(Length radius, Length above, Number cos_zenith, OUT(Length) first,
                    OUT(Length) second) {
  sphere_wall_distances(radius, above, cos_zenith, first, second);
}
#endif

#ifdef NEPHO_MUTANT_RADIUS_DIFFERENCE
Length tested_height(Length radius, Length t, Number cos_zenith) {
  return sqrt(radius * radius + Number(2.0) * radius * t * cos_zenith + t * t) - radius;
}
#else
Length tested_height(Length radius, Length t, Number cos_zenith) {
  return height_along_ray(radius, t, cos_zenith);
}
#endif

void evaluate_geometry(int which, Number x0, Number x1, Number x2, Number x3, Number x4, int wall,
                       int nearest, OUT(Number) y0, OUT(Number) y1) {
  Length metre = Length(1.0);
  if (which == 20) y0 = tested_offset(wall, nearest, x0, x1);
  if (which == 21) {
    Number angle = tested_offset(wall, nearest, x1, x2);
    y0 = tested_angular(x0 * metre, angle, x3, x4) / metre;
  }
  if (which == 22) {
    Length first;
    Length second;
    Length below = tested_drop(wall, nearest, x1, x2 * metre);
    tested_spheres(x0 * metre, -below, x3, first, second);
    y0 = first / metre;
    y1 = second / metre;
  }
  if (which == 23) {
    Length scale = box_spacing_over_direction(x1 * metre, x2);
    y0 = box_wall_distance(wall, nearest, x0, scale) / metre;
  }
  if (which == 24) y0 = angle_along_ray(x0 * metre, x1 * metre, x2, x3);
  if (which == 25) y0 = tested_height(x0 * metre, x1 * metre, x2) / metre;
  if (which == 26) y0 = height_of_offset(x0 * metre, x1 * metre, x2 * metre * metre) / metre;
  if (which == 27) y0 = geodetic_height(x0 * metre, x1 * metre, x2 * metre, x3) / metre;
  if (which == 28) y0 = Number(simpson_steps(x0 * metre, x1 * metre, x2 * metre));
}

void evaluate(int which, Number x0, Number x1, Number x2, Number x3, Number x4, Number x5, int wall,
              int nearest, OUT(Number) y0, OUT(Number) y1, OUT(Number) y2) {
  Length metre = Length(1.0);
  Radiance light = Radiance(1.0);
  InverseSolidAngle per_sr = InverseSolidAngle(1.0);
  y0 = Number(0.0);
  y1 = Number(0.0);
  y2 = Number(0.0);
  if (which == 0) y0 = tested_e0(x0);
  if (which == 1) y0 = tested_w1(x0);
  if (which == 2) {
    y0 = simpson_optical_depth(x0 / metre, x1 / metre, x2 / metre, x3 * metre);
  }
  if (which == 3) y0 = step_radiance(x0 * light, x1 * light, x2) / light;
  if (which == 4) y0 = tested_hg(x0, x1) / per_sr;
  if (which == 5) y0 = cornette_shanks_phase(x0, x1) / per_sr;
  if (which == 6) y0 = rayleigh_phase(x0) / per_sr;
  if (which == 7) y0 = tested_coordinate(x0);
  if (which == 8) {
    y0 = octave_scattering(wall);
    y1 = octave_transmittance(wall, x0);
    y2 = octave_asymmetry(wall, x1);
  }
  if (which == 9) sin_cos_small(x0, y0, y1);
  if (which == 10) y0 = arc_tangent(x0, x1);
  if (which == 11) y0 = sky_radiance(x0, x1 * light, x2 * light, x3 * light) / light;
  if (which == 12) {
    y0 = sky_source(sky_visibility(x0), sky_visibility(x1), sky_visibility(x2), x3 * light,
                    x4 * light, x5 * light) /
         light;
  }
  if (which == 13) y0 = luminance(x0, x1, x2);
  if (which == 14) aces_tone(x0, x1, x2, y0, y1, y2);
  if (which == 15) y0 = srgb_encode(x0);
  if (which >= 20) evaluate_geometry(which, x0, x1, x2, x3, x4, wall, nearest, y0, y1);
}
