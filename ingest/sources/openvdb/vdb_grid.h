#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tile_boxes.h"

namespace nepho::vdb {

using Coord3 = std::array<std::int32_t, 3>;

// Voxels low..high in index space, both included; 64 bits, because a file may claim any 32.
struct IndexBox {
  std::array<std::int64_t, 3> low{0, 0, 0}, high{-1, -1, -1};
  bool empty() const { return high[0] < low[0]; }
  void add(const IndexBox& other);
};

// A block of 8^3 voxels that is not zero throughout. Bit b of `reach`: it has a value on its lower
// faces of the axes in b at once, where it is part of the bricks below (bit 0: always set).
struct Block {
  Coord3 origin;
  std::uint8_t reach;
};

// Sums over index columns along one axis, for the default density scale.
struct ColumnSum {
  double values = 0;   // sum of all active values
  double columns = 0;  // columns with an active voxel
};

struct Tally {
  std::uint64_t active = 0, non_finite = 0, negative = 0, inactive_not_zero = 0;
  double max = 0;
};

// One frame's grid in memory, cleaned: active values are finite and not negative, all others 0.
// Const calls are thread-safe. Values are the file's own, unscaled.
class VdbGrid {
 public:
  virtual ~VdbGrid() = default;

  const Tally& tally() const { return tally_; }
  const std::vector<Block>& blocks() const { return blocks_; }  // leaves and tiles of 8^3
  // Larger active tiles, in index space; they are no part of `blocks`.
  const std::vector<TileBox>& tiles() const { return tiles_; }
  // The 9^3 values from a corner that is a multiple of 8, x fastest; larger tiles only if asked.
  virtual void samples(const Coord3& corner, bool with_tiles, double* values) const = 0;
  virtual double value(const Coord3& voxel) const = 0;
  virtual ColumnSum columns(std::size_t axis) const = 0;
  virtual std::uint64_t bytes() const = 0;

 protected:
  Tally tally_;
  std::vector<Block> blocks_;
  std::vector<TileBox> tiles_;
};

// What a file says of the chosen grid. The active box is evaluated from the tree.
struct VdbHeader {
  std::string grid, value_type;
  glm::dmat3 linear{1.0};       // columns: one index step, in VDB world units
  glm::dvec3 translation{0.0};  // of voxel (0, 0, 0)
  IndexBox active;
  bool from_blender = false;
  bool has_grid = false;  // false: a file without any grid, an empty frame
  std::vector<std::string> remarks;
};

// `grid` empty: the rule of Options::grid. The header costs no voxel value. Both throw Error, never
// an exception of OpenVDB.
VdbHeader read_header(const std::string& file, const std::string& grid);
std::unique_ptr<VdbGrid> read_grid(const std::string& file, const std::string& grid);

}  // namespace nepho::vdb
