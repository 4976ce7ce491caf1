#include "image/colour.h"

#include <cmath>

namespace nepho {
namespace {

constexpr double kDelta = 6.0 / 29;  // below its cube CIELAB's cube root is a line

// Exact fractions of the chromaticities of IEC 61966-2-1; columns are red, green, blue.
glm::dmat3 to_xyz() {
  const glm::dvec3 red(10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382);
  const glm::dvec3 green(8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382);
  const glm::dvec3 blue(4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382);
  const glm::dvec3 white = red + green + blue;
  return {red / white, green / white, blue / white};
}

}  // namespace

double srgb_decode(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

glm::dvec3 xyz_of(const glm::dvec3& linear) {
  static const glm::dmat3 matrix = to_xyz();
  return matrix * linear;
}

glm::dvec3 linear_of_xyz(const glm::dvec3& xyz) {
  static const glm::dmat3 matrix = glm::inverse(to_xyz());
  return matrix * xyz;
}

glm::dvec3 lab_of(const glm::dvec3& linear) {
  const glm::dvec3 xyz = xyz_of(linear);
  glm::dvec3 f;
  for (int c = 0; c < 3; ++c)
    f[c] = xyz[c] > kDelta * kDelta * kDelta ? std::cbrt(xyz[c])
                                             : xyz[c] / (3 * kDelta * kDelta) + 4.0 / 29;
  return {116 * f.y - 16, 500 * (f.x - f.y), 200 * (f.y - f.z)};
}

glm::dvec3 linear_of_lab(const glm::dvec3& lab) {
  const double y = (lab.x + 16) / 116;
  glm::dvec3 f(y + lab.y / 500, y, y - lab.z / 200);
  for (int c = 0; c < 3; ++c)
    f[c] = f[c] > kDelta ? f[c] * f[c] * f[c] : 3 * kDelta * kDelta * (f[c] - 4.0 / 29);
  return linear_of_xyz(f);
}

}  // namespace nepho
