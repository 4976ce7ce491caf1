#pragma once

#include <string>

#include "geo/map_projection.h"

namespace nepho {

// A map by PROJ (https://proj.org): of a PROJ string ("+proj=laea +lat_0=52 ..."), or of a
// coordinate reference system as WKT. Coordinates in m, or in degrees of systems without a map.
// Latitudes and longitudes are those of the system's own ellipsoid: no datum is changed. Throws
// Error, naming `where`, on what PROJ does not understand, and in a build without PROJ.
MapProjection proj_map(const std::string& crs, const std::string& where);

}  // namespace nepho
