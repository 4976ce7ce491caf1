#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"
#include "sources/grib/message.h"

namespace nepho::grib {

// The horizontal grid of a field, as CF tells grids: axes that rise, whatever way the message is
// scanned, and a grid_mapping.
struct Grid {
  enum class Kind {
    kLatLon,   // x: degrees east, y: degrees north
    kRotated,  // likewise of a rotated pole
    kMap,      // m
    kPlaces,   // latitude_deg and longitude_deg for each cell
    kCells,    // triangles and the like: no rows; x holds nothing
    kUnknown   // not to be read: `why`
  };
  Kind kind = Kind::kUnknown;
  std::string type;  // ecCodes's gridType
  std::size_t nx = 0, ny = 0;
  std::vector<double> x, y;
  std::vector<double> latitude_deg, longitude_deg;  // [j * nx + i], kPlaces only
  std::vector<forecast::FileAttribute> mapping;     // with grid_mapping_name
  std::vector<long> row_points;                     // of reduced grids, from row 0 of the message
  std::string why;                                  // not, or how else: the cure

  // How the message is scanned (flag table 3.4).
  bool x_falls = false, y_falls = false, columns_first = false, alternating = false;

  std::string text() const;  // "regular_ll, 144 x 73 from 90 N 0 E"
  bool same_places(const Grid& other) const;
};

// `message` is of headers alone, but for grids that only ecCodes knows the places of; `whole` reads
// it all then. Throws Error on numbers that contradict each other.
Grid grid_of(const Message& message, const std::function<Message*()>& whole);

// A message's values as [j * nx + i] on the axes. Rows of reduced grids are spread over nx cells by
// the overlap of cells, which keeps the sum of each row. Throws Error, naming `where`, where the
// count is not the grid's.
std::vector<float> arranged(const Grid& grid, const std::vector<double>& values,
                            const std::string& where);

}  // namespace nepho::grib
