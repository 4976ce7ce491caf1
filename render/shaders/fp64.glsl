// What rays over a planet need in fp64, once each.

// Taylor at a quarter of the angle (|angle| <= pi, rest < 5e-17), doubled twice: GLSL has no fp64
// trigonometry.
void sin_cos_fp64(double angle, out double s, out double c) {
  double x = 0.25LF * angle, z = x * x;
  s = x * (1.0LF + z * (-1.0LF / 6.0LF + z * (1.0LF / 120.0LF + z * (-1.0LF / 5040.0LF +
      z * (1.0LF / 362880.0LF + z * (-1.0LF / 39916800.0LF + z * (1.0LF / 6227020800.0LF +
      z * (-1.0LF / 1307674368000.0LF))))))));
  c = 1.0LF + z * (-0.5LF + z * (1.0LF / 24.0LF + z * (-1.0LF / 720.0LF + z * (1.0LF / 40320.0LF +
      z * (-1.0LF / 3628800.0LF + z * (1.0LF / 479001600.0LF +
      z * (-1.0LF / 87178291200.0LF + z * (1.0LF / 20922789888000.0LF))))))));
  for (int doubling = 0; doubling < 2; ++doubling) {
    double twice = 2.0LF * s * c;
    c = 1.0LF - 2.0LF * s * s;
    s = twice;
  }
}

// The float result, turned back in fp64: what is left is too small for a third order.
double atan_fp64(double y, double x) {
  double guess = double(atan(float(y / max(abs(x), abs(y))), float(x / max(abs(x), abs(y)))));
  double s, c;
  sin_cos_fp64(guess, s, c);
  double rest = (y * c - x * s) / (x * c + y * s);
  return guess + rest * (1.0LF - rest * rest / 3.0LF);
}

// Distance to a sphere about the centre, fp64; negative where it is missed or behind.
double sphere_entry(double r0, double mu, double radius, bool far) {
  double b = r0 * mu, c = (r0 - radius) * (r0 + radius), discriminant = b * b - c;
  if (discriminant < 0.0LF) return -1.0LF;
  double q = -(b + (b < 0.0LF ? -1.0LF : 1.0LF) * sqrt(discriminant));
  double other = q == 0.0LF ? 0.0LF : c / q;
  return far ? max(q, other) : min(q, other);
}
