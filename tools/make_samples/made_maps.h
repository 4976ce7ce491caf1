#pragma once

#include <glm/glm.hpp>

namespace nepho::samples {

// From a map's coordinates (m) to latitude and longitude (deg). Snyder (1987).

struct MapOrigin {
  double radius_m = 6371000, latitude_deg = 0, longitude_deg = 0;
};
glm::dvec2 from_mercator(const MapOrigin& map, double parallel_deg, glm::dvec2 m);  // eq. 7-4, 7-5
glm::dvec2 from_equal_area(const MapOrigin& map, glm::dvec2 m);                     // eq. 24-16
glm::dvec2 from_stereographic(const MapOrigin& map, double scale, glm::dvec2 m);    // eq. 21-15
glm::dvec2 from_transverse(const MapOrigin& map, double scale, glm::dvec2 m);       // eq. 8-6, 8-7
// Polar, on an ellipsoid: true at a latitude, or of a scale at the pole (eq. 21-39, 21-40, 7-9).
struct PolarMap {
  double equatorial_m, flattening, longitude_deg, true_latitude_deg, scale_at_pole;
  bool south;
};
glm::dvec2 from_polar(const PolarMap& map, glm::dvec2 m);
// A rotated system's (longitude, latitude), by vectors.
glm::dvec2 from_rotated(glm::dvec2 pole_lat_lon_deg, double north_longitude_deg,
                        glm::dvec2 rotated_deg);
// A satellite's angles of view (rad), over GRS 80; sweep about x or y.
glm::dvec2 from_view(double longitude_deg, double height_m, bool sweep_x, glm::dvec2 angle_rad);

}  // namespace nepho::samples
