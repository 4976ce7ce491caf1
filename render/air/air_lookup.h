#pragma once

#include "air/air_tables.h"

namespace nepho {

// The tables as shaders read them, in double: bilinear between texels' centres, clamped at the
// ends. Heights over the ellipsoid, m; mu are cosines of zenith angles.

// Scattering and extinction of the air at one height, r g b.
struct AirDensity {
  glm::dvec3 rayleigh_per_m{0.0}, aerosol_per_m{0.0};  // scattering
  glm::dvec3 extinction_per_m{0.0};
};
AirDensity air_density(const Air& air, double height_m);

// What of the tables lights a place: radiances per unit of the sun's irradiance outside the air.
struct AirLight {
  glm::dvec3 multiple{0.0}, multiple_p2{0.0};
};
struct SkyLight {
  glm::dvec3 up{0.0}, side{0.0}, down{0.0}, low{0.0};
};

// AirLookup::light at one height, for many suns.
class AirLightRow {
 public:
  AirLightRow(const AirTables& tables, double top_m, double height_m);
  AirLight operator()(double mu_sun) const;

 private:
  double top_m_, height_m_;
  std::vector<AirLight> texels_;
};

class AirLookup {
 public:
  AirLookup(const Air& air, double radius_m, const AirTables& tables)
      : air_(air), radius_m_(radius_m), tables_(tables) {}

  // To the top of the air; meaningless below the horizon.
  glm::dvec3 depth(double height_m, double mu) const;
  AirLight light(double height_m, double mu_sun) const;
  AirLightRow light_row(double height_m) const { return {tables_, air_.top_m, height_m}; }
  SkyLight sky(double height_m, double mu_sun) const;

 private:
  const Air air_;
  double radius_m_;
  const AirTables& tables_;  // outlives this
};

}  // namespace nepho
