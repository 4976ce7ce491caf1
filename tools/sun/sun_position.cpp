#include "sun/sun_position.h"

#include <libnova/dynamical_time.h>
#include <libnova/nutation.h>
#include <libnova/precession.h>
#include <libnova/sidereal_time.h>
#include <libnova/solar.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace nepho {
namespace {

constexpr double kJulianDayOf1970 = 2440587.5;
constexpr double kNanosecondsPerDay = 86400e9;
constexpr double kAberration_deg = 20.49552 / 3600;  // at 1 au
constexpr double kObliquityOf2000_deg = 23.4392911;

glm::dvec3 direction(double longitude_rad, double latitude_rad) {
  return {std::cos(latitude_rad) * std::cos(longitude_rad),
          std::cos(latitude_rad) * std::sin(longitude_rad), std::sin(latitude_rad)};
}

// From the ecliptic's axes to the equator's; a negative obliquity goes back.
glm::dvec3 tilted(const glm::dvec3& v, double obliquity_rad) {
  const double c = std::cos(obliquity_rad), s = std::sin(obliquity_rad);
  return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}

// From the mean equator and equinox of 2000 to those of the date.
glm::dvec3 precessed(const glm::dvec3& v, double dynamical_day) {
  ln_equ_posn of_2000{glm::degrees(std::atan2(v.y, v.x)), glm::degrees(std::asin(v.z))}, of_date{};
  ln_get_equ_prec(&of_2000, dynamical_day, &of_date);
  return direction(glm::radians(of_date.ra), glm::radians(of_date.dec));
}

}  // namespace

SunPosition sun_position(std::int64_t utc_ns) {
  // Half a double's last digit of a Julian day is 20 us: 1e-7 degrees of the Earth's turn.
  const double julian_day = kJulianDayOf1970 + double(utc_ns) / kNanosecondsPerDay;
  const double dynamical_day = ln_get_jde(julian_day);

  // Not ln_get_solar_equ_coords: it stays at the ecliptic of 2000 (0.7 degrees off in 1950), and
  // its aberration is 360 times too small.
  ln_helio_posn geometric{};
  ln_get_solar_geom_coords(dynamical_day, &geometric);
  const glm::dvec3 equator_2000 =
      tilted(direction(glm::radians(geometric.L), glm::radians(geometric.B)),
             glm::radians(kObliquityOf2000_deg));
  const glm::dvec3 equator_of_date = precessed(equator_2000, dynamical_day);

  // Aberration and nutation turn along the ecliptic of the date; ln_nutation.ecliptic is the mean
  // obliquity.
  ln_nutation nutation{};
  ln_get_nutation(dynamical_day, &nutation);
  const glm::dvec3 mean_ecliptic = tilted(equator_of_date, -glm::radians(nutation.ecliptic));
  const double longitude_rad = std::atan2(mean_ecliptic.y, mean_ecliptic.x) +
                               glm::radians(nutation.longitude - kAberration_deg / geometric.R);
  const glm::dvec3 equator = tilted(direction(longitude_rad, std::asin(mean_ecliptic.z)),
                                    glm::radians(nutation.ecliptic + nutation.obliquity));

  // By the Earth's turn to what is fixed to it.
#ifdef NEPHO_MUTANT_SUN_HOURS_FOR_RADIANS
  const double turn_rad = ln_get_apparent_sidereal_time(julian_day);
#else
  const double turn_rad =
      ln_get_apparent_sidereal_time(julian_day) / 24 * glm::two_pi<double>();  // from hours
#endif
  const double ct = std::cos(turn_rad), st = std::sin(turn_rad);
#ifdef NEPHO_MUTANT_SUN_EAST_WEST
  const glm::dvec3 fixed = {ct * equator.x - st * equator.y, st * equator.x + ct * equator.y,
                            equator.z};
#else
  const glm::dvec3 fixed = {ct * equator.x + st * equator.y, ct * equator.y - st * equator.x,
                            equator.z};
#endif
  return {glm::normalize(fixed), geometric.R};
}

}  // namespace nepho
