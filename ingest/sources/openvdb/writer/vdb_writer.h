#pragma once

#include <cstddef>
#include <cstdint>

namespace nepho {

// C entry of nepho_vdb_writer.so, which is loaded by whoever writes a .vdb file; no program links
// it. Grids are handed over block by block, so that nothing dense is needed.

enum class VdbValue : std::int32_t { kFloat, kHalf, kDouble, kVec3, kPoints };
enum class VdbClass : std::int32_t { kUnknown, kFog, kLevelSet };

// One block of voxels whose corner is a multiple of its size.
struct VdbBlock {
  std::int32_t origin[3];
  std::int32_t size;     // 8: `values`, 8^3, x fastest; 8, 128 or 4096 without: one active tile
  const double* values;  // null: a tile. Written active where not 0 (NaN included)
  double tile;
  bool all_active;  // zeros too
};

struct VdbMetadatum {
  const char* name;
  const char* text;  // null: `ijk`, as bounding boxes are stored
  std::int32_t ijk[3];
};

struct VdbGridSpec {
  const char* name;
  VdbValue value;
  VdbClass grid_class;
  double columns[3][3];   // one index step along i, j, k, in the file's world units
  double translation[3];  // of voxel (0, 0, 0)
  double background;
  const VdbMetadatum* metadata;
  std::size_t metadata_count;
  // Fills in the next block, or returns false. A vector grid gets each value three times; a points
  // grid none.
  bool (*next)(void* context, VdbBlock* block);
  void* context;
};

struct VdbFileSpec {
  const char* path;  // written beside it, then renamed over it
  const VdbGridSpec* grids;
  std::size_t grid_count;
  const char* creator;    // file metadata; null: none
  bool write_statistics;  // grid bounding boxes as OpenVDB computes them
};

// 0, or 1 with a zero-terminated text in `error`.
using vdb_write_fn = int(const VdbFileSpec* file, char* error, std::size_t error_size);

}  // namespace nepho

extern "C" int nepho_vdb_write(const nepho::VdbFileSpec* file, char* error, std::size_t error_size);
