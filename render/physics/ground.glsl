// What a ray meets at the planet's surface, one colour. Cosines are of zenith angles at that place:
// mu of the direction to the eye, mu_sun of that to the sun.

// Fresnel reflectance of water (n = 1.34), unpolarised. cos_incidence in [0, 1].
Number water_fresnel(Number cos_incidence) {
  Number n = Number(1.34);
  Number c = min(max(cos_incidence, Number(0.0)), Number(1.0));
  Number g = sqrt(n * n - (Number(1.0) - c) * (Number(1.0) + c));
  Number s = (c - g) / (c + g);
  Number p = (g - n * n * c) / (g + n * n * c);
  return Number(0.5) * (s * s + p * p);
}

// Variance of the sea's slope, both axes together (Cox and Munk 1954, doi:10.1364/JOSA.44.000838).
Number water_slope_variance(Number wind_m_per_s) {
  return Number(0.003) + Number(0.00512) * max(wind_m_per_s, Number(0.0));
}

// Of the slopes of both axes: its integral over the plane of slopes is 1. cos_tilt > 0: of a wave.
Number water_slope_density(Number cos_tilt, Number slope_variance) {
  Number slope2 = (Number(1.0) - cos_tilt) * (Number(1.0) + cos_tilt) / (cos_tilt * cos_tilt);
#ifdef NEPHO_MUTANT_SLOPES_OF_ONE_AXIS
  slope2 = slope2 / Number(2.0);
#endif
  return exp(-(slope2 / slope_variance)) / (pi * slope_variance);
}

// Smith's Lambda for Gaussian slopes as a rational curve (Walter et al. 2007): what waves hide of
// each other, seen at this cosine.
Number water_hiding(Number mu, Number slope_variance) {
  Number c = max(mu, Number(1e-6));
  Number a = c / sqrt(max((Number(1.0) - c) * (Number(1.0) + c) * slope_variance, Number(1e-12)));
  if (a >= Number(1.6)) return Number(0.0);
  return (Number(1.0) - Number(1.259) * a + Number(0.396) * a * a) /
         (Number(3.535) * a + Number(2.181) * a * a);
}

// The sun's glint: BRDF times mu_sun. cos_tilt: of the wave that mirrors the sun to the eye, cos_half
// of the angle between the sun and that wave's normal. Finite for mu -> 0 by Smith's Lambda; no wave
// is as steep as 1000.
InverseSolidAngle water_glint(Number mu, Number mu_sun, Number cos_tilt, Number cos_half,
                              Number slope_variance) {
  if (!(mu > Number(0.0)) || !(mu_sun > Number(0.0)) || !(cos_tilt > Number(1e-3)))
    return InverseSolidAngle(0.0);
  Number c2 = cos_tilt * cos_tilt;
  Number density = water_slope_density(cos_tilt, slope_variance);
  Number seen = Number(1.0) + water_hiding(mu, slope_variance) + water_hiding(mu_sun, slope_variance);
#ifdef NEPHO_MUTANT_NO_HIDING
  seen = Number(1.0);
#endif
  Number value = water_fresnel(cos_half) * density /
                 (Number(4.0) * max(mu, Number(1e-6)) * c2 * c2 * seen);
  return value * InverseSolidAngle(1.0);
}

// Mean reflectance of a rough sea towards the eye (Bruneton, Neyret, Holzschuch 2010,
// doi:10.1111/j.1467-8659.2009.01618.x): a sea of waves shines less at its horizon than a mirror.
Number water_mean_fresnel(Number mu, Number slope_variance) {
  Number sigma = sqrt(slope_variance);
  Number least = water_fresnel(Number(1.0));
  Number left = min(max(Number(1.0) - mu, Number(0.0)), Number(1.0));
  Number rise = pow(left, Number(5.0) * exp(-(Number(2.69) * sigma)));
  return least + (Number(1.0) - least) * rise / (Number(1.0) + Number(22.7) * sigma * sqrt(sigma));
}

// Radiance of the sky at this height over the horizon, through the means of its upper and lower
// halves (over and under 45 degrees; their mean sines are 0.854 and 0.354).
Radiance sky_towards(Number sin_elevation, Radiance sky_up, Radiance sky_low) {
  Number along = min(max(Number(2.0) * (sin_elevation - Number(0.354)), Number(-0.5)), Number(1.0));
  return max(sky_low + along * (sky_up - sky_low), Radiance(0.0));
}

// Irradiance of the sky on level ground: over and under 45 degrees weigh the same.
Irradiance ground_sky_irradiance(Radiance sky_up, Radiance sky_low) {
  return Number(0.5) * pi * SolidAngle(1.0) * (sky_up + sky_low);
}

// sun: what arrives perpendicular to the beam, through air, cloud and over the horizon. sky_up,
// sky_low: behind clouds already.
Radiance land_radiance(Number albedo, Irradiance sun, Number mu_sun, Radiance sky_up,
                       Radiance sky_low) {
  Irradiance light = max(mu_sun, Number(0.0)) * sun + ground_sky_irradiance(sky_up, sky_low);
  return albedo / pi * InverseSolidAngle(1.0) * light;
}

// albedo: of the body of water under its surface.
Radiance water_radiance(Number albedo, Irradiance sun, Number mu, Number mu_sun, Number cos_tilt,
                        Number cos_half, Number slope_variance, Radiance sky_up,
                        Radiance sky_low) {
  Number mirror = water_mean_fresnel(mu, slope_variance);
  Number mirror_sun = water_mean_fresnel(mu_sun, slope_variance);
  Irradiance entering = (Number(1.0) - mirror_sun) * max(mu_sun, Number(0.0)) * sun +
                        ground_sky_irradiance(sky_up, sky_low);
  Radiance body = (Number(1.0) - mirror) * albedo / pi * InverseSolidAngle(1.0) * entering;
  return body + mirror * sky_towards(mu, sky_up, sky_low) +
         water_glint(mu, mu_sun, cos_tilt, cos_half, slope_variance) * sun;
}

// To be added to water_radiance under clouds, where sky_up and sky_low hold daylight that clouds scatter
// down: it comes from all sides and lights the water's body, but is no image in the mirror. What the
// water mirrors is never brighter than the sky without clouds, free_up and free_low. (Mirrored in
// full, it showed as a pale patch with sharp edges under a small cloud.)
Radiance water_mirror_excess(Number mu, Number slope_variance, Radiance sky_up, Radiance sky_low,
                             Radiance free_up, Radiance free_low) {
  Radiance even = sky_towards(mu, sky_up, sky_low);
  Radiance clear = sky_towards(mu, free_up, free_low);
  return water_mean_fresnel(mu, slope_variance) * (min(even, clear) - even);
}
