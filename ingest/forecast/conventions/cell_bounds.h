#pragma once

#include <optional>
#include <vector>

#include "forecast/conventions/line_grid.h"
#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Where cells end, by CF's `bounds` (CF 1.11, section 7.1).

// Edges (n + 1) of an axis' cells by its bounds, which are multiplied by `factor` as `centres` have
// been; empty where there are no bounds, or where they do not join or do not hold their centres.
// `turns`: values are degrees of longitude, continuous in `centres`.
std::optional<std::vector<double>> axis_bounds(const DataFile& file, const FileVariable& axis,
                                               const std::vector<double>& centres, double factor,
                                               bool turns);
// The same, or else edges_between(); not known of one centre without bounds.
AxisWalls axis_walls(const DataFile& file, const FileVariable& axis,
                     const std::vector<double>& centres, double factor, bool turns);

// Half way between centres; half a step beyond both ends. One centre: a cell of one unit.
std::vector<double> edges_between(const std::vector<double>& centres);

// Corners [(nx + 1) * j + i] of a grid of nx x ny cells whose latitudes and longitudes have bounds
// of four corners a cell, in any order around it; values times `factor`. Empty where there are
// none, or where neighbours do not share theirs.
struct CellCorners {
  std::vector<double> latitude, longitude;
};
std::optional<CellCorners> cell_corners(const DataFile& file, const FileVariable& latitude,
                                        const FileVariable& longitude, int nx, int ny,
                                        double factor);

// The variable that `bounds` names; null where there is none of numbers.
const FileVariable* bounds_of(const DataFile& file, const FileVariable& variable);

}  // namespace nepho::forecast
