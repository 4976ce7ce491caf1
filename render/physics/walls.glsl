// Distances from a camera to the walls of cells, in float. The camera's frame on each axis comes
// from the CPU in double: `nearest` is the lattice index nearest to the camera, offset_cells the
// camera minus it, within [-1/2, 1/2], so that a wall close by keeps its relative precision
// whichever side it is on. Lengths are in scaled space. eps = 2^-24 below, kappa the condition
// number of lattice.md 5.

// Farther than anything, and finite: min, max and comparisons are safe.
Length no_hit() {
  return Length(1e30);
}

// Wall minus camera, in cells. The integer difference is exact up to 2^24 cells.
Number wall_cells(int wall, int nearest, Number offset_cells) {
  return Number(wall - nearest) - offset_cells;
}
// The same as an angle (spacing in rad) ...
Number wall_offset(int wall, int nearest, Number offset_cells, Number spacing) {
  return wall_cells(wall, nearest, offset_cells) * spacing;
}
// ... and as a length.
Length wall_height(int wall, int nearest, Number offset_cells, Length spacing) {
  return wall_cells(wall, nearest, offset_cells) * spacing;
}

// Signed distance along the ray to the half-plane of an angular wall at `angle` from the camera
// around the wall's axis. radius: of the camera from that axis; radial, tangential: the ray's
// direction in the plane across the axis, towards the camera's own radius and towards growing
// index. no_hit() if the ray meets only the wall's other half. Error 2.1 eps kappa; the plane
// equation is metres off.
Length angular_wall_distance(Length radius, Number angle, Number radial, Number tangential) {
  Number s;
  Number c;
  sin_cos_small(angle, s, c);
  Number across = tangential * c - radial * s;
  if (across == Number(0.0)) return no_hit();
  Length t = radius * s / across;
  Length along_wall = radius * c + t * (radial * c + tangential * s);
  return along_wall > Length(0.0) && abs(t) < no_hit() ? t : no_hit();
}

// a = high + low, each with half of the digits.
void dekker_split(Length a, OUT(Length) high, OUT(Length) low) {
  PRECISE Length big = dekker_splitter * a;
  PRECISE Length over = big - a;
  PRECISE Length top = big - over;
  PRECISE Length rest = a - top;
  high = top;
  low = rest;
}
// a * b = product + error, exactly (Dekker 1971). fma() is not fused everywhere.
void dekker_product(Length a, Length b, OUT(Area) product, OUT(Area) error) {
  Length a1;
  Length a2;
  Length b1;
  Length b2;
  dekker_split(a, a1, a2);
  dekker_split(b, b1, b2);
  PRECISE Area p = a * b;
  PRECISE Area e = a1 * b1 - p;
  PRECISE Area e2 = e + a1 * b2;
  PRECISE Area e3 = e2 + a2 * b1;
  PRECISE Area e4 = e3 + a2 * b2;
  product = p;
  error = e4;
}

// b^2 - c of the quadratic for a sphere that lies `above` below the camera, of exact products.
Area sphere_discriminant(Length radius, Length above, Length b, OUT(Area) c) {
  PRECISE Length sum = Number(2.0) * radius - above;
  Area c_error;
  Area b_squared;
  Area b_error;
  dekker_product(above, sum, c, c_error);
  dekker_product(b, b, b_squared, b_error);
  PRECISE Area coarse = b_squared - c;
  PRECISE Area fine = b_error - c_error;
  PRECISE Area discriminant = coarse + fine;
  return discriminant;
}

// Both distances to a sphere that lies `above` below the camera (camera minus sphere, from
// wall_height), ascending and signed; no_hit() twice if missed. radius: of the camera. b^2 - c is
// taken of exact products, because that difference decides rays that graze. Error 2.7 eps kappa.
void sphere_wall_distances(Length radius, Length above, Number cos_zenith, OUT(Length) first,
                           OUT(Length) second) {
  PRECISE Length b = radius * cos_zenith;
  Area c;
  Area discriminant = sphere_discriminant(radius, above, b, c);
  first = no_hit();
  second = no_hit();
  if (discriminant < Area(0.0)) return;
  Length root = sqrt(discriminant);
  Length q = b < Length(0.0) ? root - b : -(b + root);
  Length other = q == Length(0.0) ? Length(0.0) : c / q;
  first = min(q, other);
  second = max(q, other);
}

// The wall ahead of a ray between two spheres that lie `above_low` and `above_high` below the camera
// (that over it: negative): the lower one if the ray falls and meets it, else the upper one's far
// side; `lower` tells which. The sphere that the ray goes for is met as above. Where a ray misses the
// lower one, its discriminant grows by the difference of their squared radii, a sum without
// cancellation: heights are then as good as a float of the layer's thickness.
void layer_wall_distance(Length radius, Length above_low, Length above_high, Number cos_zenith,
                         bool falls, OUT(Length) distance, OUT(bool) lower) {
  PRECISE Length b = radius * cos_zenith;
  PRECISE Length above = falls ? above_low : above_high;
  Area c;
  Area discriminant = sphere_discriminant(radius, above, b, c);
  lower = falls && !(discriminant < Area(0.0));
  if (falls && !lower) {
    Area wider = (above_low - above_high) * (Number(2.0) * radius - above_low - above_high);
#ifndef NEPHO_MUTANT_ONE_SPHERE
    discriminant = discriminant + wider;
#endif
    c = c - wider;
  }
  distance = no_hit();
  if (discriminant < Area(0.0)) return;
  Length root = sqrt(discriminant);
  Length q = b < Length(0.0) ? root - b : -(b + root);
  Length other = q == Length(0.0) ? Length(0.0) : c / q;
  distance = lower ? min(q, other) : max(q, other);
}

// Box: what box_wall_distance takes. A ray along the wall never meets it.
Length box_spacing_over_direction(Length spacing, Number direction) {
  return direction == Number(0.0) ? no_hit() : spacing / direction;
}
// Signed distance to a plane wall of a box. Error 2 eps.
Length box_wall_distance(int wall, int nearest, Number offset_cells,
                         Length spacing_over_direction) {
  if (abs(spacing_over_direction) >= no_hit()) return no_hit();
  return wall_cells(wall, nearest, offset_cells) * spacing_over_direction;
}

// Angle around a wall's axis that the ray has swept after t: the inverse of angular_wall_distance.
// Relative error 3e-7 * kappa.
Number angle_along_ray(Length radius, Length t, Number radial, Number tangential) {
  return angle_of_point(t * tangential, radius + t * radial);
}

// How it grows around t: by turn * u - turn * fade * u^2 within `reach` to either side. `turn` is the
// derivative and three quarters of reach^2 times the third order's coefficient: of the cubic a quarter
// is left.
void angle_growth_along_ray(Length radius, Length t, Number radial, Number tangential, Length reach,
                            OUT(InverseLength) turn, OUT(InverseLength) fade) {
  Length along = radius + t * radial;
  Length across = t * tangential;
  Area squared = along * along + across * across;
  fade = (radial * along + tangential * across) / squared;
  Number bent = reach * fade;
  Number third = bent * bent -
                 Number(0.25) * (radial * radial + tangential * tangential) * (reach * reach / squared);
  turn = radius * tangential / squared * (Number(1.0) + third);
}
