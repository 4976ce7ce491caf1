// Optical depth and emission of one step, its source linear in optical depth:
//   L = T x (S0 e0(x) + (S1 - S0) w1(x)),  e0 = (1 - e^-x) / x,  w1 = (1 - (1 + x) e^-x) / x^2.
// S0 = S1 is the step of Hillaire 2016 (Physically Based Sky, Atmosphere and Cloud Rendering in
// Frostbite, SIGGRAPH course).

// (1 - e^-x) / x for x >= 0: the mean transmittance of a step of optical depth x. The quotient
// loses all digits for small x, so there the series; it reaches to 1 because exp() of a GPU may be
// 1e-6 off, which the quotient would multiply by 1/x. Relative error 2e-6.
Number exp_e0(Number x) {
  if (x >= Number(1.0)) return (Number(1.0) - exp(-x)) / x;
  Number s = Number(1.0) - x * Number(1.0 / 12.0);
  s = Number(1.0) - x * Number(1.0 / 11.0) * s;
  s = Number(1.0) - x * Number(1.0 / 10.0) * s;
  s = Number(1.0) - x * Number(1.0 / 9.0) * s;
  s = Number(1.0) - x * Number(1.0 / 8.0) * s;
  s = Number(1.0) - x * Number(1.0 / 7.0) * s;
  s = Number(1.0) - x * Number(1.0 / 6.0) * s;
  s = Number(1.0) - x * Number(1.0 / 5.0) * s;
  s = Number(1.0) - x * Number(1.0 / 4.0) * s;
  s = Number(1.0) - x * Number(1.0 / 3.0) * s;
  return Number(1.0) - x * Number(0.5) * s;
}

// (1 - (1 + x) e^-x) / x^2 for x >= 0: the weight of the source's rise over the step. Series
// sum (n + 1) (-x)^n / (n + 2)!, as above. Relative error 2e-6.
// `through` is e^-x, where it is known.
Number exp_w1_through(Number x, Number through) {
  if (x >= Number(1.0)) return (Number(1.0) - (Number(1.0) + x) * through) / x / x;
  Number s = Number(1.0) - x * Number(12.0 / 143.0);
  s = Number(1.0) - x * Number(11.0 / 120.0) * s;
  s = Number(1.0) - x * Number(10.0 / 99.0) * s;
  s = Number(1.0) - x * Number(9.0 / 80.0) * s;
  s = Number(1.0) - x * Number(8.0 / 63.0) * s;
  s = Number(1.0) - x * Number(7.0 / 48.0) * s;
  s = Number(1.0) - x * Number(6.0 / 35.0) * s;
  s = Number(1.0) - x * Number(5.0 / 24.0) * s;
  s = Number(1.0) - x * Number(4.0 / 15.0) * s;
  s = Number(1.0) - x * Number(3.0 / 8.0) * s;
  return Number(0.5) - x * Number(1.0 / 3.0) * s;
}
Number exp_w1(Number x) {
  return exp_w1_through(x, exp(-x));
}

// Optical depth between two samples and the one half-way: exact where extinction is a cubic along
// the ray, as it is inside a cell of a box.
Number simpson_optical_depth(InverseLength k0, InverseLength k_mid, InverseLength k1, Length d) {
  return d * (k0 + Number(4.0) * k_mid + k1) * Number(1.0 / 6.0);
}

// Light that leaves a step of optical depth tau towards the eye, for a source function (emission
// over extinction) that goes from s0 at the near end to s1 at the far end, linear in tau.
Radiance step_radiance(Radiance s0, Radiance s1, Number tau) {
  return tau * (s0 * exp_e0(tau) + (s1 - s0) * exp_w1(tau));
}
