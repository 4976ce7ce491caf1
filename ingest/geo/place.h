#pragma once

#include <glm/glm.hpp>

#include "api/source_module.h"
#include "bricks/shell_chart.h"
#include "scene/scene.h"

namespace nepho {

// Degrees, as people and files give them: multiples of 90 then keep their exact sines.
struct GeodeticPoint {
  double latitude_deg = 0, longitude_deg = 0, height_m = 0;
};

// On any ellipsoid, by GeographicLib (Karney 2011, doi:10.1007/s00190-011-0445-3, closed form).
// Errors on planets up to the Earth's size, heights from -500 m to 100 km: position 5 nm, there and
// back 5 nm, height 7 nm.
// Longitude of the answer is in [-180, 180]; at the poles it is that of the given point's y and x.
// About 0.2 us each. Throws Error on what is not finite or a latitude beyond 90 degrees.
glm::dvec3 ecef_m(const Ellipsoid& body, const GeodeticPoint& point);
GeodeticPoint geodetic_point(const Ellipsoid& body, glm::dvec3 ecef_m);

// Directions on the sphere of latitudes and longitudes, in degrees.
glm::dvec3 unit_vector(glm::dvec2 lat_lon_deg);
glm::dvec2 lat_lon_deg_of(const glm::dvec3& unit_vector);

// A local frame on WGS 84: z up along the ellipsoid's normal; y horizontal, towards the azimuth
// heading_deg (clockwise from north); x to the right of y. At heading 0: east, north, up. The axes
// are orthonormal to 1e-15; origin as ecef_m(). Throws Error as above.
Placement placement_of(const GeodeticPlace& place);

}  // namespace nepho
