// Structs that C++ fills and shaders read (std430). Scalars and arrays of scalars only: both sides
// then lay them out alike; sizes and offsets are asserted in gl/frame_data.h.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace nepho {
using uint = std::uint32_t;
#endif

struct FrameData {
  double eye_m[3];      // ECEF
  double right[3];      // camera basis; right and up reach the picture's edge
  double up[3];
  double forward[3];
  double to_sun[3];     // unit
  double sky_axes[9];   // unit rows: up, and two horizontal directions
  double ground_radius_m;  // scaled space; rays end there; 0 = no ground
  double ground_z_scale;   // a/b of that ground's ellipsoid
  float sun_irradiance[3];
  float zenith[3];
  float horizon[3];
  float below[3];
  float step_voxels;
  float tolerance;
  float least_transmittance;
  int width;
  int height;
  int pad;
};

struct VolumeData {
  double origin_m[3];    // box: ECEF of q = 0
  double to_cells[9];    // box: rows, finest cells per metre
  double from_cells[9];  // box: columns, metres per finest cell
  double radius_m;       // shell: of the sphere in scaled space, at height 0
  double z_scale;        // shell: a/b
  double bottom_m;
  double cell_rad;
  double cell_height_m;
  int chart;             // 0 box, 1 shell
  int periodic;          // bit 0 x, bit 1 y
  int first_node;        // of this volume, in the node buffer
  int max_level;
  int cells[3];          // finest, per root
  int phase_row;
  int levels[32];        // split mask << 24 | log2 of a cell's size in finest cells: z << 16 | y << 8 | x
  float albedo[3];
  float asymmetry;
  int ice_phase_row;  // of the part that is ice, where the volume tells it apart
  float ice_asymmetry;
  int first_grid;     // in the node buffer: gl/node_grid.h
  int pad;
};

// 16 bytes. Inner: first_child. Leaf: lit = its light tile. flags: from bit 0 the kind (NODE_*, 3
// bits), the axes that its split halves (3), log2 of its sides in finest cells (x, y, z, 5 each).
// An empty box (EMPTY_BOX) has its ends in place of the other three: for each axis low | high << 16,
// counted in cells of the grid from 1 at its begin; 0 and EMPTY_BOX_BEYOND are the chart's own.
struct NodeRecord {
  uint first_child_or_lit;
  uint flags;
  uint brick_or_constant;  // slot in the atlas, or the constant's float bits (1/m)
  uint cloud_box;          // brick: first and last samples that are not 0: x, y, z, x, y, z, 4 bits each
};

struct BrickRecord {
  float range_per_m;   // scale * 65535
  float offset_per_m;
};

// A leaf that has a light tile.
struct LitRecord {
  int volume;
  int root;
  int level;
  int i, j, k;
};

#ifdef __cplusplus
inline constexpr uint NODE_INNER = 0, NODE_EMPTY = 1, NODE_CONSTANT = 2, NODE_BRICK = 3, EMPTY_BOX = 1u << 21, EMPTY_BOX_BEYOND = 65535,
                      GRID_IS_WHOLE = 1u << 15;
}  // namespace nepho
#else
const uint NODE_INNER = 0u, NODE_EMPTY = 1u, NODE_CONSTANT = 2u, NODE_BRICK = 3u, EMPTY_BOX = 1u << 21, EMPTY_BOX_BEYOND = 65535u,
           GRID_IS_WHOLE = 1u << 15;
#endif
