#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace nepho::samples {

// Lambert's conformal conic projection of a sphere with two standard parallels (Snyder 1987,
// Map Projections: A Working Manual, eq. 15-1 to 15-5), as WRF uses it: sphere of 6370 km, x along
// the grid's east at the standard longitude. The origin is the reference latitude there.
class Lambert {
 public:
  Lambert(double parallel1_deg, double parallel2_deg, double reference_lat_deg,
          double standard_lon_deg)
      : lon0_rad_(radians(standard_lon_deg)) {
    const double a = radians(parallel1_deg), b = radians(parallel2_deg);
    cone_ = a == b ? std::sin(a)
                   : std::log(std::cos(a) / std::cos(b)) / std::log(half_tan(b) / half_tan(a));
    scale_m_ = kSphere_m * std::cos(a) * std::pow(half_tan(a), cone_) / cone_;
    rho0_m_ = scale_m_ / std::pow(half_tan(radians(reference_lat_deg)), cone_);
  }
  // Latitude, longitude (deg) of a point of the map (m).
  glm::dvec2 lat_lon_deg(double x_m, double y_m) const {
    const double north = rho0_m_ - y_m, rho_m = std::hypot(x_m, north);
    const double lat = 2 * std::atan(std::pow(scale_m_ / rho_m, 1 / cone_)) - kPi / 2;
    return glm::degrees(glm::dvec2(lat, lon0_rad_ + std::atan2(x_m, north) / cone_));
  }
  // Scale of the map against the sphere at a latitude.
  double map_factor(double lat_deg) const {
    const double lat = radians(lat_deg);
    return cone_ * scale_m_ / (std::pow(half_tan(lat), cone_) * kSphere_m * std::cos(lat));
  }
  // From the grid's axes to east and north: the angle by which the grid is turned (rad).
  double turn_rad(double lon_deg) const { return cone_ * (lon0_rad_ - radians(lon_deg)); }

#ifdef NEPHO_MUTANT_ANOTHER_SPHERE
  static constexpr double kSphere_m = 6378137;
#else
  static constexpr double kSphere_m = 6370e3;
#endif

 private:
  static constexpr double kPi = 3.14159265358979323846;
  static double radians(double deg) {
    return deg * kPi / 180;
  }
  static double half_tan(double lat_rad) {
    return std::tan(kPi / 4 + lat_rad / 2);
  }
  double lon0_rad_, cone_, scale_m_, rho0_m_;
};

}  // namespace nepho::samples
