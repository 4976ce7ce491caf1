// Angles with a relative error bound. Built-in sin, asin and atan have none in OpenGL, and an
// absolute one in Vulkan: a wall 10 m away is at 2e-6 rad.

const Number pi = Number(3.14159265358979323846);

// |angle| <= pi. Doubled from angle / 2, so that 1 - cos keeps its digits too. s: relative error
// 3e-7 up to pi / 2; beyond, s and c: 6e-7 absolute. (Double: 2e-7, the polynomial's own.)
void sin_cos_small(Number angle, OUT(Number) s, OUT(Number) c) {
  Number x = Number(0.5) * angle;
  Number z = x * x;
  Number p = Number(1.0 / 362880.0) - z * Number(1.0 / 39916800.0);
  p = Number(-1.0 / 5040.0) + z * p;
  p = Number(1.0 / 120.0) + z * p;
  p = Number(-1.0 / 6.0) + z * p;
  Number sin_x = x + x * z * p;
  Number q = Number(-1.0 / 3628800.0) + z * Number(1.0 / 479001600.0);
  q = Number(1.0 / 40320.0) + z * q;
  q = Number(-1.0 / 720.0) + z * q;
  q = Number(1.0 / 24.0) + z * q;
  q = Number(-0.5) + z * q;
  Number cos_x = Number(1.0) + z * q;
  s = Number(2.0) * sin_x * cos_x;
  c = Number(1.0) - Number(2.0) * sin_x * sin_x;
}

// tan(pi / 8): where the angle's quotient is folded.
Number steep_tangent() {
  return Number(0.41421356237309504880);
}
// pi / 4, where it was folded, and the arc tangent of |t| <= tan(pi/8): the interpolant of atan(t) / t
// at Chebyshev nodes in t^2 (9e-11).
Number folded_angle(Number t, bool folded) {
  Number z = t * t;
  Number p = Number(-0.0862467614) + z * Number(0.0504813851);
  p = Number(0.1107136502) + z * p;
  p = Number(-0.1428415119) + z * p;
  p = Number(0.1999997726) + z * p;
  p = Number(-0.3333333328) + z * p;
  Number angle = t + t * z * p;
  return folded ? angle + Number(0.25) * pi : angle;
}

// The angle of the point (x, y), in (-pi, pi]; 0 at the origin. One division: of what is folded, not
// of the fold. Relative error 3e-7.
Number arc_tangent(Number y, Number x) {
  Number a = abs(y);
  Number b = abs(x);
  Number large = max(a, b);
  Number small = min(a, b);
  if (!(large > Number(0.0))) return Number(0.0);
  bool steep = small > steep_tangent() * large;
  Number angle = folded_angle((steep ? small - large : small) / (steep ? small + large : large), steep);
  if (a > b) angle = Number(0.5) * pi - angle;
  if (x < Number(0.0)) angle = pi - angle;
  return y < Number(0.0) ? -angle : angle;
}
// The same of lengths.
Number angle_of_point(Length y, Length x) {
  Length a = abs(y);
  Length b = abs(x);
  Length large = max(a, b);
  Length small = min(a, b);
  if (!(large > Length(0.0))) return Number(0.0);
  bool steep = small > steep_tangent() * large;
  Number angle = folded_angle((steep ? small - large : small) / (steep ? small + large : large), steep);
  if (a > b) angle = Number(0.5) * pi - angle;
  if (x < Length(0.0)) angle = pi - angle;
  return y < Length(0.0) ? -angle : angle;
}
