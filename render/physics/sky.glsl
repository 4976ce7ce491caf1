// A background sky: three radiances and a smooth gradient between them, not an atmosphere. It also
// lights clouds, by the interim rule below.

// Zenith to horizon over the upper half, horizon to below over the 3 degrees under it.
Radiance sky_radiance(Number sin_elevation, Radiance zenith, Radiance horizon, Radiance below) {
  if (sin_elevation >= Number(0.0)) {
    Number left = Number(1.0) - min(sin_elevation, Number(1.0));
    return horizon + (zenith - horizon) * (Number(1.0) - left * left * left);
  }
  Number f = min(-sin_elevation / Number(0.052), Number(1.0));
  return horizon + (below - horizon) * (f * f * (Number(3.0) - Number(2.0) * f));
}

// Light of a wide sky goes round corners and scatters forward: it fades as if the cloud had this
// part of its optical depth. Interim, like the octaves.
Number sky_extinction_scale() {
  return Number(0.2);
}
Number sky_visibility(Number tau) {
  return exp(-(sky_extinction_scale() * tau));
}

// Mean sky radiance at a point, as six equal directions: up, four sides, down. visible_*: in [0,
// 1].
Radiance sky_source(Number visible_up, Number visible_side, Number visible_down, Radiance zenith,
                    Radiance horizon, Radiance below) {
  return (visible_up * zenith + Number(4.0) * visible_side * horizon + visible_down * below) *
         Number(1.0 / 6.0);
}
