#pragma once

#include <memory>

#include "bricks/surface_map.h"
#include "sources/netcdf/grid_search.h"

namespace nepho::netcdf {

// A forecast's ground as a SurfaceMap: on a grid about as fine as the model's, in a frame centred
// on the domain and turned to its rows (a globe: longitude and parametric latitude), bilinear
// between the model's cell centres. Null where the data have no ground.
std::shared_ptr<const SurfaceMap> surface_of(const GridSearch& search,
                                             const ForecastGround& ground);

}  // namespace nepho::netcdf
