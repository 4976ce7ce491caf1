#include "oracle.h"

#include <openvdb/openvdb.h>

#include <cmath>

namespace nepho::test {
namespace {

template <class Grid>
std::vector<OracleVoxel> voxels(const openvdb::GridBase::Ptr& base) {
  std::vector<OracleVoxel> result;
  const auto grid = openvdb::gridPtrCast<Grid>(base);
  if (!grid) return result;
  grid->tree().voxelizeActiveTiles();
  for (auto it = grid->cbeginValueOn(); it; ++it) {
    const openvdb::Vec3d p = grid->indexToWorld(it.getCoord());
    const double value = double(*it);
    result.push_back({{p.x(), p.y(), p.z()}, std::isfinite(value) && value > 0 ? value : 0});
  }
  return result;
}

}  // namespace

std::vector<OracleVoxel> active_voxels(const std::string& file, const std::string& name) {
  openvdb::initialize();
  openvdb::io::File in(file);
  in.open(false);
  const auto grid = in.readGrid(name);
  auto result = voxels<openvdb::FloatGrid>(grid);
  return result.empty() ? voxels<openvdb::DoubleGrid>(grid) : result;
}

void write_frustum(const std::string& file) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 5));
  grid->tree().setValueOn({3, 3, 3}, 1.0f);
  openvdb::io::File(file).write({grid});
}

}  // namespace nepho::test
