#pragma once

#include <cmath>

namespace nepho::samples {

// To a multiple of a step: trailing zeros in the file, which pack. Powers of two keep the steps
// exact in float.
inline double rounded(double value, double step) {
  return std::round(value / step) * step;
}
// To so many bits after the first.
inline double kept_bits(double value, int bits) {
  if (value == 0) return 0;
  int exponent = 0;
  std::frexp(value, &exponent);
  return rounded(value, std::ldexp(1.0, exponent - 1 - bits));
}

}  // namespace nepho::samples
