#pragma once

#include <openvdb/openvdb.h>

#include <memory>

#include "vdb_grid.h"

namespace nepho::vdb {

// Takes over and cleans a float or double grid (half grids are float in memory); null for others.
std::unique_ptr<VdbGrid> make_grid(const openvdb::GridBase::Ptr& grid);

}  // namespace nepho::vdb
