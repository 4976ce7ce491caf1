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

// Where the file says that its cells end, one more than it has; empty: half way between centres.
struct AxisEdges {
  std::vector<double> latitude_deg, longitude_deg;
};

// Regular or uneven axes. Cells next to a pole end there if the grid goes around and the pole is
// within a step. Throws Error, naming `where`, on latitudes beyond 90 degrees and axes that neither
// rise nor fall.
std::unique_ptr<HorizontalGrid> axes_grid(std::vector<double> latitude_deg,
                                          std::vector<double> longitude_deg,
                                          const std::string& where, AxisEdges edges = {});

// Centres in two dimensions, on the sphere of directions: bilinear between unit vectors, half a
// cell beyond the outermost. Needs 2 x 2 cells. A missing centre (off a satellite's disc) leaves
// its cell and those beside it without a place. Throws Error as above, where more than 1 % of the
// cells turn to the other side or have no area, and where all are missing.
std::unique_ptr<HorizontalGrid> points_grid(int nx, int ny, std::vector<double> latitude_deg,
                                            std::vector<double> longitude_deg,
                                            const std::string& where);

// The same of corners, [j * (nx + 1) + i] of nx x ny cells.
std::unique_ptr<HorizontalGrid> corners_grid(int nx, int ny, std::vector<double> latitude_deg,
                                             std::vector<double> longitude_deg,
                                             const std::string& where);

// A plane that touches the planet at 0 N 0 E, for data in metres without a place: of centres, or of
// edges.
std::unique_ptr<HorizontalGrid> plane_grid(const std::vector<double>& x_m,
                                           const std::vector<double>& y_m);
std::unique_ptr<HorizontalGrid> plane_edges_grid(std::vector<double> x_m, std::vector<double> y_m);
inline constexpr const char* kNoPlace =
    "The grid has no place on the planet: it is laid around 0 N 0 E.";

// A map: centres of cells at x_m[i], y_m[j] of the projection; or edges, one more than cells.
std::unique_ptr<HorizontalGrid> map_grid(const std::vector<double>& x_m,
                                         const std::vector<double>& y_m,
                                         const MapProjection& projection);
std::unique_ptr<HorizontalGrid> map_edges_grid(std::vector<double> x_m, std::vector<double> y_m,
                                               const MapProjection& projection);

}  // namespace nepho::forecast
