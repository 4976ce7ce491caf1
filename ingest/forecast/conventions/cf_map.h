#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// The variable that a water variable's `grid_mapping` names, or else the file's only one that has a
// `grid_mapping_name`; null where there is none, or where it is latitude_longitude.
const FileVariable* map_of(const DataFile& file, const FileVariable& water);

// Rows and columns of a map (CF 1.11, appendix F): by grid_mapping_name and its attributes, or by
// WKT or a PROJ string where that name is not known. Axes in lengths; in degrees where the pole is
// rotated; in angles of view, or metres, where it is geostationary. Cells end at the axes' bounds,
// or half way between centres. Says what was assumed. Throws Error on what is not known, and on
// axes without usable units.
std::unique_ptr<HorizontalGrid> cf_map_grid(const DataFile& file, const FileVariable& mapping,
                                            const FileVariable& x, const FileVariable& y,
                                            std::vector<std::string>& assumptions);

}  // namespace nepho::forecast
