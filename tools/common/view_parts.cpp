#include "common/view_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace nepho {
namespace {

constexpr double kHorizonAt = 0.6;  // of the half picture below its middle
constexpr double kLeast_rad = glm::radians(40.0), kMost_rad = glm::radians(120.0);
constexpr double kOverhead_rad = glm::radians(75.0);

}  // namespace

double half_width_rad(const Lens& lens) {
  return std::atan(std::tan(lens.vertical_fov_rad / 2) * lens.aspect);
}

double standing_pitch_rad(const Lens& lens) {
  return std::atan(kHorizonAt * std::tan(lens.vertical_fov_rad / 2));
}

double turn_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, glm::two_pi<double>()));
}

glm::dvec3 heading_of(const LocalAxes& axes, double azimuth_rad) {
#ifdef NEPHO_MUTANT_HEADING_EAST_WEST
  azimuth_rad = -azimuth_rad;
#endif
  return std::sin(azimuth_rad) * axes.east + std::cos(azimuth_rad) * axes.north;
}

double azimuth_rad(const LocalAxes& axes, const glm::dvec3& direction) {
  return std::atan2(glm::dot(direction, axes.east), glm::dot(direction, axes.north));
}

bool lit_from_the_side(const LocalAxes& axes, double heading_rad,
                       const std::optional<glm::dvec3>& to_sun) {
#ifdef NEPHO_MUTANT_SUN_ANYWHERE
  return true;
#endif
  if (!to_sun || glm::dot(*to_sun, axes.up) > std::sin(kOverhead_rad)) return true;
  const double aside_rad = turn_between(azimuth_rad(axes, *to_sun), heading_rad);
  return aside_rad >= kLeast_rad && aside_rad <= kMost_rad;
}

double lit_well(const LocalAxes& axes, double heading_rad,
                const std::optional<glm::dvec3>& to_sun) {
#ifdef NEPHO_MUTANT_SUN_ANYWHERE
  return 1;
#endif
  if (!to_sun) return 1;
  const double aside_rad = turn_between(azimuth_rad(axes, *to_sun), heading_rad);
  const double off = (aside_rad - kSideOfSun_rad) / glm::radians(45.0);
  return 0.25 + std::exp(-0.5 * off * off);
}

CloudLayer layer_near(const CloudMap& map, const glm::dvec3& direction, double radius_m,
                      const Ellipsoid& body) {
  std::vector<double> tops_m;
  double weight = 0, middle_m = 0;
  for (const CloudColumn& c : map.columns) {
    if (glm::length(c.direction - direction) * body.equatorial_m > radius_m) continue;
    tops_m.push_back(c.top_m);
    weight += c.cloudiness() * c.area_m2;
    middle_m += c.cloudiness() * c.area_m2 * c.middle_m();
  }
  if (tops_m.empty()) return {};
  const auto high = tops_m.begin() + std::ptrdiff_t(0.98 * double(tops_m.size() - 1));
  std::nth_element(tops_m.begin(), high, tops_m.end());
  return {*high, middle_m / weight};
}

}  // namespace nepho
