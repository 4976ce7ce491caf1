#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forecast/conventions/dimension_roles.h"
#include "forecast/conventions/field_reader.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// The horizontal grid of a CF variable: axes of a map with its grid_mapping (cf_map.h); fields of
// latitude and longitude, which also win over a map that lies elsewhere; axes of latitude and
// longitude. Axes in metres without a mapping are laid around 0 N 0 E. What was assumed is said in
// `assumptions`, what was found in `how`. Throws Error on all else.
std::shared_ptr<const HorizontalGrid> cf_grid(const DataFile& file, const DimensionRoles& roles,
                                              const FieldReader& reader, const FileVariable& water,
                                              std::vector<std::string>& assumptions,
                                              std::string& how);

}  // namespace nepho::forecast
