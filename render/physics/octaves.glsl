// Octaves of multiple scattering, the interim light model (Wrenninge, Kulla, Lundqvist 2013). Order
// n scatters a^n as much, sees b^n of the optical depth towards the sun, with an asymmetry g c^n.
// Not physical: reflected radiance of slabs is off by a factor of 2.2 rms with these constants, the
// best fit of 8 octaves to radiances by adding-doubling (Hansen and Travis 1974; tests/data/truth).
// octaves_test measures it again.
const Number octave_a = Number(0.651);
const Number octave_b = Number(0.400);
const Number octave_c = Number(0.684);

// base^n by products: pow() of a GPU is only good to 1e-6.
Number octave_power(Number base, int n) {
  Number power = Number(1.0);
  for (int i = 0; i < n; ++i) power = power * base;
  return power;
}

Number octave_scattering(int n) {
  return octave_power(octave_a, n);
}
Number octave_extinction(int n) {
  return octave_power(octave_b, n);
}
Number octave_transmittance(int n, Number tau_sun) {
  return exp(-(octave_extinction(n) * tau_sun));
}
Number octave_asymmetry(int n, Number g) {
  return g * octave_power(octave_c, n);
}
