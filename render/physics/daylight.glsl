// Light that clouds let through in all directions, for ground and air under them.

// Part of a flux from zenith cosine mu0 that a plane-parallel cloud lets through, direct and
// scattered, without absorption: delta-Eddington (Joseph, Wiscombe and Weinman 1976), conservative.
// Within 5 % of adding-doubling for mu0 >= 0.5, 16 % for 0.2 (g = 0.85).
Number cloud_flux_transmittance(Number tau, Number mu0, Number g) {
  Number mu = max(mu0, Number(0.05));
  Number beam = exp(-((Number(1.0) - g) * (Number(1.0) + g) * tau / mu));
  Number flux = Number(2.0 / 3.0) + mu + (Number(2.0 / 3.0) - mu) * beam;
  return flux / (Number(4.0 / 3.0) + (Number(1.0) - g) * tau);
}

// Daylight under clouds, as a part of the flux that would arrive without them: the direct beam, and
// what the cloud overhead scatters down of that which clouds take from the beam. Nothing is added in
// the sun beside a cloud, nor in a shadow with nothing overhead.
Number cloud_daylight(Number tau_direct, Number tau_above, Number mu0, Number g) {
  Number beam = exp(-tau_direct);
  Number beam_above = exp(-(tau_above / max(mu0, Number(0.05))));
  Number scattered = max(cloud_flux_transmittance(tau_above, mu0, g) - beam_above, Number(0.0));
  Number taken = (Number(1.0) - beam) / max(Number(1.0) - beam_above, Number(1e-6));
  return min(beam + scattered * min(taken, Number(1.0)), Number(1.0));
}
