#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/forecast.h"

namespace nepho::forecast {

// Grids of one row, one column or one cell, which say nothing of how wide that is: cells are as
// wide as they are long, and a cell alone 10 km; each is said in `assumptions`.

inline constexpr double kLoneCell_m = 10000;

// Edges of a pair of axes. `known`: it has more than one centre, or bounds of its own.
struct AxisWalls {
  std::vector<double> edges;
  bool known = true;
};
// Lengths of both axes are metres where they are multiplied by x_m and y_m.
void widen_lone(AxisWalls& x, AxisWalls& y, double x_m, double y_m,
                std::vector<std::string>& assumptions);

// Centres (deg) of a curvilinear grid with nx or ny 1, without corners.
std::unique_ptr<HorizontalGrid> line_grid(int nx, int ny, const std::vector<double>& latitude_deg,
                                          const std::vector<double>& longitude_deg,
                                          const std::string& where,
                                          std::vector<std::string>& assumptions);

}  // namespace nepho::forecast
