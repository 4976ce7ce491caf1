#pragma once

#include <functional>
#include <glm/glm.hpp>

namespace nepho {

// Height (m) of the geoid EGM96 over WGS 84 at a latitude and longitude (deg), bilinear in a grid
// of 15 minutes: PROJ's egm96_15.gtx (Debian: proj-data). Off the model itself by 1 m at most,
// where the geoid is steep. Thread-safe. Throws Error in a build without PROJ and where the grid is
// not installed.
using GeoidHeight = std::function<double(glm::dvec2 lat_lon_deg)>;
GeoidHeight egm96_m();

}  // namespace nepho
