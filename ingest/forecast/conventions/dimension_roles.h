#pragma once

#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Which of a variable's dimensions is time, level, y and x; -1: none. Told by the coordinate
// variable of the dimension (units, axis, standard_name, positive), then by the dimensions of
// two-dimensional latitudes and longitudes, then by name.
struct DimensionRoles {
  int time = -1, z = -1, y = -1, x = -1;
  int cells = -1;  // x, where cells are in a row
  // Fields of latitude and longitude over y and x, where there are any.
  const FileVariable *latitude = nullptr, *longitude = nullptr;
};

// Cells in a row (triangles) have x only. Throws Error where the variable has no level but needs
// one, or no horizontal grid.
enum class Levels { kNeeded, kNone };
DimensionRoles dimension_roles(const DataFile& file, const FileVariable& variable,
                               Levels levels = Levels::kNeeded);

}  // namespace nepho::forecast
