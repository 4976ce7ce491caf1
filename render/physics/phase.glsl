// Phase functions, normalised to 1 over the sphere. They take 1 - cos(theta) = |a - b|^2 / 2 of the
// unit vectors of travel a, b: cos itself has lost the forward peak's digits.

// (1 - |g|)^2 + 2 |g| (1 -+ cos), which is 1 + g^2 - 2 g cos without its cancellation (at g = 0.999
// the usual form is 16 % off in float).
Number hg_denominator(Number one_minus_cos, Number g) {
  Number a = abs(g);
  Number from_peak = g < Number(0.0) ? Number(2.0) - one_minus_cos : one_minus_cos;
  return (Number(1.0) - a) * (Number(1.0) - a) + Number(2.0) * a * from_peak;
}

// Henyey & Greenstein (1941). Relative error 4e-7 up to |g| = 0.999.
InverseSolidAngle hg_phase(Number one_minus_cos, Number g) {
  Number k = hg_denominator(one_minus_cos, g);
  Number shape = (Number(1.0) - g) * (Number(1.0) + g) / (k * sqrt(k));
  return shape * InverseSolidAngle(0.079577471545947667884);  // 1 / (4 pi)
}

// Cornette & Shanks (1992), doi 10.1364/AO.31.003152: HG with Rayleigh's limit at g = 0.
InverseSolidAngle cornette_shanks_phase(Number one_minus_cos, Number g) {
  Number k = hg_denominator(one_minus_cos, g);
  Number mu = Number(1.0) - one_minus_cos;
  Number shape = (Number(1.0) - g) * (Number(1.0) + g) / (Number(2.0) + g * g) *
                 (Number(1.0) + mu * mu) / (k * sqrt(k));
  return shape * InverseSolidAngle(0.119366207318921501827);  // 3 / (8 pi)
}

InverseSolidAngle rayleigh_phase(Number one_minus_cos) {
  Number mu = Number(1.0) - one_minus_cos;
  return (Number(1.0) + mu * mu) * InverseSolidAngle(0.059683103659460750913);  // 3 / (16 pi)
}

// Where the phase table holds this angle, in [0, 1]: sqrt(theta / pi), dense in the forward peak.
// tan(theta / 2) = sqrt((1 - cos) / (1 + cos)) is well-conditioned at both ends.
Number phase_table_coordinate(Number one_minus_cos) {
  Number up = max(one_minus_cos, Number(0.0));
  Number down = max(Number(2.0) - one_minus_cos, Number(0.0));
  return sqrt(Number(2.0) * arc_tangent(sqrt(up), sqrt(down)) / pi);
}
