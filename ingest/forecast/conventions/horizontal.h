#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/forecast.h"
#include "geo/map_projection.h"

namespace nepho::forecast {

// Grids on the planet. Centres in degrees, [i] and [j] or [j * nx + i].

// Longitudes of one row made continuous: each within half a turn of the one before.
void unwrap_deg(std::vector<double>& longitude_deg);

// How many of these longitudes are columns of their own: one less where the last repeats the first
// after a whole turn. `around`: they go all the way round, to 1 % of a step.
struct Turn {
  int columns = 0;
  bool around = false;
};
Turn turn_of(const std::vector<double>& unwrapped_longitude_deg);

// Regular or uneven axes. Cells end half way to the next centre; those next to a pole end there if
// the grid goes around and the pole is within a step. Throws Error, naming `where`, on latitudes
// beyond 90 degrees and axes that neither rise nor fall.
std::unique_ptr<HorizontalGrid> axes_grid(std::vector<double> latitude_deg,
                                          std::vector<double> longitude_deg,
                                          const std::string& where);

// Centres in two dimensions, on the sphere of directions: bilinear between unit vectors, half a
// cell beyond the outermost. Needs 2 x 2 cells. Throws Error as above, and
// where more than 1 % of the cells turn to the other side or have no area.
std::unique_ptr<HorizontalGrid> points_grid(int nx, int ny, std::vector<double> latitude_deg,
                                            std::vector<double> longitude_deg,
                                            const std::string& where);

// A plane that touches the planet at 0 N 0 E, for data in metres without a place.
std::unique_ptr<HorizontalGrid> plane_grid(std::vector<double> x_m, std::vector<double> y_m);
inline constexpr const char* kNoPlace =
    "The grid has no place on the planet: it is laid around 0 N 0 E.";

// A map: centres of cells at x_m[i], y_m[j] of the projection.
std::unique_ptr<HorizontalGrid> map_grid(std::vector<double> x_m, std::vector<double> y_m,
                                         const MapProjection& projection);

}  // namespace nepho::forecast
