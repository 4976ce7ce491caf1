#pragma once

#include "api/module_support.h"
#include "forecast/conventions/convention.h"

namespace nepho::forecast {

// What a module of forecasts is asked for, whatever the format. Parameters:
//   force   1 draws what is out of every cloud's range, and is else refused (0)
//   grid    a file with the places of the cells (triangles, Voronoi's cells); the data's own
//   names   a file of names of a model that the table does not know (docs/names.md); none
//   region  "SOUTH,WEST,NORTH,EAST" in degrees: only cells there are read (the whole file)
// `format` names the module in errors. Throws Error.
OpenRequest open_request(const SourceRequest& request, Parameters& parameters, const char* format);

}  // namespace nepho::forecast
