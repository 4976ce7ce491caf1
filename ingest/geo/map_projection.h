#pragma once

#include <glm/glm.hpp>
#include <memory>

namespace nepho {

// Maps that models are computed on, by GeographicLib; all others by PROJ (proj_map.h). Coordinates
// in m, or in degrees for kRotated.
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
  // On the central meridian (transverse Mercator), on the true latitudes (all others).
  double scale = 1;
  double false_easting_m = 0, false_northing_m = 0;
  double pole_latitude_deg = 90, pole_longitude_deg = 180;  // rotated north pole
  double pole_grid_longitude_deg = 0;  // the planet's north pole, seen from the rotated system
};

// Any other map. Thread-safe; NaN where a point is not on the map, or the map's not on the planet.
class MapFormula {
 public:
  virtual ~MapFormula() = default;
  virtual glm::dvec2 map_m(glm::dvec2 lat_lon_deg) const = 0;
  virtual glm::dvec2 lat_lon_deg(glm::dvec2 map_m) const = 0;
};

class MapProjection {
 public:
  // Throws Error on latitudes of which there is no such map.
  explicit MapProjection(const MapSpec& spec);
  explicit MapProjection(std::shared_ptr<const MapFormula> formula)
      : formula_(std::move(formula)) {}
  glm::dvec2 map_m(glm::dvec2 lat_lon_deg) const { return formula_->map_m(lat_lon_deg); }
  glm::dvec2 lat_lon_deg(glm::dvec2 map_m) const { return formula_->lat_lon_deg(map_m); }

 private:
  std::shared_ptr<const MapFormula> formula_;
};

}  // namespace nepho
