// Light that clouds let through in all directions, for ground and air under them.

// Part of a flux from zenith cosine mu0 that a plane-parallel cloud lets through, direct and
// scattered, without absorption: (2/3 + mu0) / (4/3 + (1 - g) tau), within 4 % of adding-doubling for
// mu0 >= 0.5 and tau >= 8 (delta-Eddington's limit).
Number cloud_flux_transmittance(Number tau, Number mu0, Number g) {
  return min((Number(2.0 / 3.0) + max(mu0, Number(0.0))) / (Number(4.0 / 3.0) + (Number(1.0) - g) * tau), Number(1.0));
}

// Daylight under clouds, as a part of the flux that would arrive without them: the direct beam, and
// what the cloud overhead scatters down. A gap in the cloud overhead scatters nothing.
Number cloud_daylight(Number tau_direct, Number tau_above, Number mu0, Number g) {
  Number cover = Number(1.0) - exp(-tau_above);
  return min(exp(-tau_direct) + cover * cloud_flux_transmittance(tau_above, mu0, g), Number(1.0));
}
