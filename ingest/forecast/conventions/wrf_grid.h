#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/conventions/field_reader.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// Where a WRF file's cells lie: XLAT and XLONG; the map of MAP_PROJ with its attributes, where
// those are absent or the same for all cells; a plane around 0 N 0 E for idealised runs (MAP_PROJ
// 0).
struct WrfGrid {
  std::shared_ptr<const HorizontalGrid> cells;
  bool placed = true;  // false: the plane
  std::vector<std::string> assumptions = {};
};

// Of one time of the file; `whole` reads all its columns. Throws Error where there is none of
// these.
WrfGrid wrf_grid(const FieldReader& whole, std::size_t time);

// "XLAT and XLONG agree with the map of the attributes: 4.3e-06 deg." or DIFFER; "" where the file
// lacks either.
std::string compare_with_map(const DataFile& file, const HorizontalGrid& cells);

}  // namespace nepho::forecast
