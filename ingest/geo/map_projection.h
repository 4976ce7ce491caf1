#pragma once

#include <glm/glm.hpp>
#include <memory>

namespace nepho {

// Maps that models are computed on, by GeographicLib. Coordinates in m, or in degrees for kRotated.
enum class MapKind {
  kLambertConformal,
  kMercator,
  kPolarStereographic,
  kTransverseMercator,
  kRotated
};

struct MapSpec {
  MapKind kind = MapKind::kLambertConformal;
  double equatorial_m = 6370000, polar_m = 6370000;  // a sphere unless they differ
  // Latitudes where the scale is 1 (Lambert: both; Mercator and polar: the first).
  double true_latitude1_deg = 0, true_latitude2_deg = 0;
  double central_longitude_deg = 0;
  double origin_latitude_deg = 0;  // where y is false_northing_m, on the central meridian
  double scale = 1;                // on the central meridian (transverse Mercator)
  double false_easting_m = 0, false_northing_m = 0;
  double pole_latitude_deg = 90, pole_longitude_deg = 180;  // rotated north pole
};

class MapProjection {
 public:
  // Throws Error on latitudes of which there is no such map.
  explicit MapProjection(const MapSpec& spec);
  glm::dvec2 map_m(glm::dvec2 lat_lon_deg) const;
  glm::dvec2 lat_lon_deg(glm::dvec2 map_m) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace nepho
