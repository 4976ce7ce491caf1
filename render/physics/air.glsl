// Clear air around a sphere of radius a (scaled space): profiles, and where its tables hold a place.
// A height is over the planet, never the difference of two radii; mu is the cosine of a zenith
// angle. Heights under 0 count as 0.

// Molecules and aerosol: part of what is at height 0.
Number air_exponential(Length height, Length scale) {
  return exp(-(max(height, Length(0.0)) / scale));
}
// Ozone: part of its peak, a tent.
Number air_ozone(Length height, Length low, Length peak, Length high) {
  Number rise = (height - low) / (peak - low);
  Number fall = (high - height) / (high - peak);
  return max(min(rise, fall), Number(0.0));
}

// From `height` to the sphere `top` high, upwards along mu. Products, not differences of squares.
Length air_distance_to_top(Length radius, Length top, Length height, Number mu) {
  Length along = (radius + height) * mu;
  Area above = max(top - height, Length(0.0)) * (Number(2.0) * radius + top + height);
  Length root = sqrt(along * along + above);
  if (mu > Number(0.0)) return above / (along + root);
  return root - along;
}

// Optical depth to the top, as Bruneton and Neyret 2008 (doi:10.1111/j.1467-8659.2008.01245.x) hold
// transmittance: x by the distance to the top, between the shortest one and that along the horizon,
// y by the distance to the horizon. In thin shells depth is linear in that distance. x, y in [0, 1].
void air_depth_coordinates(Length radius, Length top, Length height, Number mu, OUT(Number) x,
                           OUT(Number) y) {
  Length h = min(max(height, Length(0.0)), top);
  Length whole = sqrt(top * (Number(2.0) * radius + top));
  Length horizon = sqrt(h * (Number(2.0) * radius + h));
  Length least = top - h;
  Length most = horizon + whole;
  Length d = air_distance_to_top(radius, top, h, mu);
  x = min(max((d - least) / (most - least), Number(0.0)), Number(1.0));
  y = horizon / whole;
}
// Back: the height and mu that a place of the table stands for.
void air_depth_place(Length radius, Length top, Number x, Number y, OUT(Length) height,
                     OUT(Number) mu) {
  Length whole = sqrt(top * (Number(2.0) * radius + top));
  Length horizon = y * whole;
  Length h = horizon * horizon / (radius + sqrt(radius * radius + horizon * horizon));
  Length least = max(top - h, Length(0.0));
  Length d = least + x * (horizon + whole - least);
  height = h;
  mu = Number(1.0);
  if (d > Length(0.0)) {
    Area rise = least * (Number(2.0) * radius + top + h) - d * d;
    mu = min(max(rise / (Number(2.0) * (radius + h) * d), Number(-1.0)), Number(1.0));
  }
}

// Multiple scattering and sky light: x by the sun's mu, even below the horizon, down to where all is
// darker than the night sky, dense above it; y dense near the ground. x, y in [0, 1].
const Number air_lowest_sun = Number(-0.45);
const Number air_sun_bend = Number(0.2);
void air_light_coordinates(Length top, Length height, Number mu_sun, OUT(Number) x,
                           OUT(Number) y) {
  Number mu = min(max(mu_sun, air_lowest_sun), Number(1.0));
  Number low = air_lowest_sun / air_sun_bend;
  Number high = Number(1.0) / (Number(1.0) + air_sun_bend);
  Number bent = mu / (max(mu, Number(0.0)) + air_sun_bend);
  x = (bent - low) / (high - low);
  y = sqrt(min(max(height / top, Number(0.0)), Number(1.0)));
}
void air_light_place(Length top, Number x, Number y, OUT(Length) height, OUT(Number) mu_sun) {
  Number low = air_lowest_sun / air_sun_bend;
  Number high = Number(1.0) / (Number(1.0) + air_sun_bend);
  Number bent = low + x * (high - low);
  height = top * y * y;
  mu_sun = air_sun_bend * bent / (Number(1.0) - max(bent, Number(0.0)));
}

// Texture coordinate of x in [0, 1] in a table of n texels, whose ends are texels' centres.
Number air_texture_coordinate(Number x, Number n) {
  return (x * (n - Number(1.0)) + Number(0.5)) / n;
}

// Light that air sends towards the eye per metre, one colour. rayleigh, aerosol: scattering
// coefficients there; sun: what arrives perpendicular to the beam; multiple and its second moment:
// the tables' (mean radiance, and half its mean times P2) times the sun's irradiance outside the
// air; mu: of the view ray. For molecules this is exact in the mean over azimuths: 1 + cos^2 = 4/3 +
// 2/3 P2, and P2 of the angle between two rays is P2 P2 on that mean. Aerosol: even.
Emission air_emission(InverseLength rayleigh, InverseLength aerosol, Irradiance sun,
                      InverseSolidAngle rayleigh_part, InverseSolidAngle aerosol_part,
                      Radiance multiple, Radiance multiple_p2, Number mu) {
  Number p2 = Number(1.5) * mu * mu - Number(0.5);
  return rayleigh * (sun * rayleigh_part + multiple + p2 * multiple_p2) +
         aerosol * (sun * aerosol_part + multiple);
}

// Airglow and stars of a moonless night, 22 mag per square second of arc = 1.7e-4 cd m-2 (Patat 2008,
// doi:10.1051/0004-6361:20079279), over the sun's 1.28e5 lx: radiance from beyond the air per unit of
// the sun's irradiance. What is left of light at the end of twilight.
const InverseSolidAngle night_sky = InverseSolidAngle(1.3e-9);
