#include "vdb_writer.h"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace {

using namespace nepho;
using openvdb::Coord;

template <class Tree>
void fill_leaf(Tree& tree, const VdbBlock& block) {
  using Value = typename Tree::ValueType;
  typename Tree::LeafNodeType* leaf = nullptr;
  const Coord origin(block.origin[0], block.origin[1], block.origin[2]);
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const double value = block.values[x + 8 * (y + 8 * z)];
        if (value == 0 && !block.all_active) continue;
        if (!leaf) leaf = tree.touchLeaf(origin);
        leaf->setValueOn(origin.offsetBy(x, y, z),
                         Value(typename openvdb::VecTraits<Value>::ElementType(value)));
      }
}

template <class Grid>
openvdb::GridBase::Ptr make_grid(const VdbGridSpec& spec) {
  using Value = typename Grid::ValueType;
  using Element = typename openvdb::VecTraits<Value>::ElementType;
  auto grid = Grid::create(Value(Element(spec.background)));
  auto& tree = grid->tree();
  VdbBlock block{};
  while (spec.next && spec.next(spec.context, &block)) {
    const Coord low(block.origin[0], block.origin[1], block.origin[2]);
    if (block.values && block.size != 8) throw std::invalid_argument("a block of values is 8^3");
    if (block.values)
      fill_leaf(tree, block);
    else
      // level of the node whose slot has this size: 1, 2 or 3 for 8, 128 or 4096
      tree.addTile(block.size == 8     ? 1
                   : block.size == 128 ? 2
                                       : 3,
                   low, Value(Element(block.tile)), true);
  }
  return grid;
}

openvdb::GridBase::Ptr make_grid_of_type(const VdbGridSpec& spec) {
  switch (spec.value) {
    case VdbValue::kFloat:
      return make_grid<openvdb::FloatGrid>(spec);
    case VdbValue::kHalf: {
      auto grid = make_grid<openvdb::FloatGrid>(spec);
      grid->setSaveFloatAsHalf(true);
      return grid;
    }
    case VdbValue::kDouble:
      return make_grid<openvdb::DoubleGrid>(spec);
    case VdbValue::kVec3:
      return make_grid<openvdb::Vec3SGrid>(spec);
    case VdbValue::kPoints:
      return openvdb::points::PointDataGrid::create();
  }
  throw std::invalid_argument("unknown kind of values");
}

openvdb::GridBase::Ptr finished(const VdbGridSpec& spec) {
  const auto grid = make_grid_of_type(spec);
  grid->setName(spec.name);
  if (spec.grid_class == VdbClass::kFog) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  if (spec.grid_class == VdbClass::kLevelSet) grid->setGridClass(openvdb::GRID_LEVEL_SET);
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int row = 0; row < 3; ++row)
    for (int a = 0; a < 3; ++a) matrix(row, a) = spec.columns[row][a];
  for (int a = 0; a < 3; ++a) matrix(3, a) = spec.translation[a];
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  for (std::size_t at = 0; at < spec.metadata_count; ++at) {
    const VdbMetadatum& m = spec.metadata[at];
    if (m.text)
      grid->insertMeta(m.name, openvdb::StringMetadata(m.text));
    else
      grid->insertMeta(m.name, openvdb::Vec3IMetadata({m.ijk[0], m.ijk[1], m.ijk[2]}));
  }
  return grid;
}

void write(const VdbFileSpec& spec) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (std::size_t at = 0; at < spec.grid_count; ++at) grids.push_back(finished(spec.grids[at]));
  openvdb::MetaMap metadata;
  if (spec.creator) metadata.insertMeta("creator", openvdb::StringMetadata(spec.creator));
  const std::string path = spec.path, temporary = path + ".part";
  try {
    openvdb::io::File file(temporary);
    file.setGridStatsMetadataEnabled(spec.write_statistics);
    file.write(grids, metadata);
    file.close();
    std::filesystem::rename(temporary, path);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace

__attribute__((visibility("default"))) int nepho_vdb_write(const VdbFileSpec* file, char* error,
                                                           std::size_t error_size) {
  const auto failed = [&](const char* text) {
    std::snprintf(error, error_size, "%s", text);
    return 1;
  };
  try {
    return write(*file), 0;
  } catch (const std::exception& e) {
    return failed(e.what());
  } catch (...) {
    return failed("an unknown failure");
  }
}
