// Heights over a sphere or an ellipsoid, and the steps that a curved cell needs. Numbers near
// 6.4e6 m never stand where a difference is meant. "Scaled space": z stretched by a / b, where the
// ellipsoid is a sphere of radius a.

// |p| - radius of a point p = radius up + offset, from the offset's part along up and its square:
// (2 r z + q^2) / (|p| + r). |p| - r in float is 0.7 m off; this 3e-4 m within 20 km.
Length height_of_offset(Length radius, Length offset_up, Area offset_squared) {
  Area rise = Number(2.0) * radius * offset_up + offset_squared;
  Area squared = radius * radius + rise;
  return rise / (sqrt(max(squared, Area(0.0))) + radius);
}

// Change of |p| after t along a unit direction from a point at `radius`.
Length height_along_ray(Length radius, Length t, Number cos_zenith) {
  Area rise = t * (Number(2.0) * radius * cos_zenith + t);
  Area squared = radius * radius + rise;
  return rise / (sqrt(max(squared, Area(0.0))) + radius);
}

// Height over the ellipsoid from the scaled one, r' - a: q / (N + sqrt(N^2 + A q)) with
// q = r'^2 - a^2. 0.2 mm off at 10 km, 17 mm at 100 km (r' - a itself: 34 m at 10 km).
Length geodetic_height(Length scaled_height, Length equatorial, Length polar,
                       Number sin_scaled_latitude) {
  Area q = scaled_height * (Number(2.0) * equatorial + scaled_height);
  Number ratio = equatorial / polar;
  Number flat_part = (ratio - Number(1.0)) * (ratio + Number(1.0));  // e'^2
  Number s2 = sin_scaled_latitude * sin_scaled_latitude;
  Number sin2 = ratio * ratio * s2 / (Number(1.0) + flat_part * s2);  // of the geodetic latitude
  Length n = equatorial / sqrt(Number(1.0) - flat_part / (ratio * ratio) * sin2);
  Number stretch = Number(1.0) + flat_part * sin2;
  return q / (n + sqrt(max(n * n + stretch * q, Area(0.0))));
}

// Simpson sub-steps for a ray inside one cell of a shell (lattice.md 5): optical depth within 2e-4
// of (mean of the cell's corners) * length. Height is a parabola along the ray, so a trilinear
// field is a quartic, whose Simpson error is at most 32/120 s / n^4, s = sagitta / cell height. The
// 3 stands for the angles' own curvature, all that is left in cells as tall as wide.
int simpson_steps(Length ray_length, Length radius, Length cell_height) {
  Number s = ray_length * (ray_length / cell_height + Number(3.0)) / (Number(8.0) * radius);
  if (!(s > Number(7e-4))) return 1;
  return int(ceil(sqrt(sqrt(s / Number(7e-4)))));
}

// Part of the sun's disc above the horizon of a sphere, seen from `height` over it: 0 .. 1. The disc
// (angular radius 0.004675 rad) is crossed as a smoothstep: within 0.04 of the true area, monotone
// (Bruneton 2017, Precomputed Atmospheric Scattering: GetTransmittanceToSun has one in the cosine;
// this one is in the angle). Without it a terminator has the width of a voxel.
Number sun_above_horizon(Length radius, Length height, Number sin_elevation) {
  Length up = max(height, Length(0.0));
  Number dip = arc_tangent(sqrt(up * (Number(2.0) * radius + up)) / radius, Number(1.0));
  Number level = sqrt(max((Number(1.0) - sin_elevation) * (Number(1.0) + sin_elevation), Number(0.0)));
  Number x = Number(0.5) + Number(0.5 / 0.004675) * (arc_tangent(sin_elevation, level) + dip);
  Number t = min(max(x, Number(0.0)), Number(1.0));
  return t * t * (Number(3.0) - Number(2.0) * t);
}
