// A straight ray through one volume's tree: from leaf to leaf by integer cell indices, so that a
// step can neither miss a leaf nor stay in one. All distances are metres along the ray from its
// start (world metres; a shell's scaled space differs by one constant factor, `stretch`).
//
// Precision (lattice.md 5): a frame holds the start as the nearest integer index of the finest
// lattice and a remainder in [-1/2, 1/2], both from fp64; walls are integer differences from it.

const float FAR = 1e30;
// A level ray in a periodic box would never leave. Towards a light, eight periods tell whether there
// is anything in its way; then it is without end.
const int MAX_WRAPS = 4096, MAX_LEVEL_WRAPS = 8;

struct Walk {
  // The ray in cells (box), or about the face's axes (shell).
  ivec3 index;       // nearest finest index to the start
  vec3 rest;         // start minus index, cells
  vec3 slope;        // box: finest cells per metre; shell: tangential parts of the unit direction
  vec3 radial;       // shell: radial parts for u, v; cosine of the zenith angle for z
  vec3 radius;       // shell: distance of the start from the u and v axes and from the centre, m
  float stretch;     // shell: scaled metres per metre
  float anchor_m;    // where on the ray the frame stands: 0, or the entry into the chart
  int root;
  uvec4 grid, grid_size;  // of the root: gl/node_grid.h
  // The leaf.
  ivec3 low, high;   // its box in finest cells, high excluded
  uint kind;
  float constant_per_m;
  float range_per_m, offset_per_m;
  uint cloud_box;    // NodeRecord
  vec3 per_cell;     // its own cells per finest cell
  vec3 tile;         // atlas texel of its first sample
  vec3 light_tile;
#ifdef NEPHO_ICE
  float ice_range_per_m, ice_offset_per_m;
#endif
  // Where it is left.
  float leave_m;
  int leave_axis;    // 0 x, 1 y, 2 z; -1: the start of the chart
  bool leave_up;
#ifdef NEPHO_LEAF_PARABOLA
  float segment_m;
  vec3 place, place_rise, place_bend;
#endif
  int wraps;
  bool endless;      // level, and out of wraps
};

// OUTSIDE and CROSSING: at leave_m the walk goes on in another frame, or through the planet (enter_chart).
const uint OUTSIDE = 4u, GONE = 5u, CROSSING = 6u;

// The ray of this invocation, world metres.
dvec3 ray_start, ray_direction;

// Texel of a tile's first sample. Exact up to 2^23 tiles; llvmpipe divides integers one by one.
vec3 tile_origin(uint slot, vec2 tiles) {
  float at = float(slot);
  float row = floor((at + 0.5) / tiles.x), layer = floor((row + 0.5) / tiles.y);
  return 9.0 * vec3(at - row * tiles.x, row - layer * tiles.y, layer);
}

uvec4 node_at(uint n) { return nodes[n]; }

ivec3 node_sides(uint flags) { return ivec3(flags >> 6 & 31u, flags >> 11 & 31u, flags >> 16 & 31u); }

// What lies over, under or beside the grid: nothing, as far as the chart reaches. Boxes over and under it
// are as wide as the chart, those beside it in x no higher than the grid, those in y no wider: no two
// share a cell, as a ray along an edge of both would go from one to the other and back.
uvec4 beyond_grid(ivec3 place, ivec3 size) {
  const uint all = EMPTY_BOX_BEYOND << 16;
  uvec4 node = uvec4(all, NODE_EMPTY | EMPTY_BOX, all, all);
  uvec3 within = 1u | uvec3(size + 1) << 16, over = uvec3(size + 1) | all;
  const uint under = 1u << 16;
  bool beside_z = place.z >= 0 && place.z < size.z, beside_x = place.x >= 0 && place.x < size.x;
  node.w = beside_z ? within.z : place.z < 0 ? under : over.z;
  if (beside_z) node.x = beside_x ? within.x : place.x < 0 ? under : over.x;
  if (beside_z && beside_x) node.z = place.y < 0 ? under : over.y;
  return node;
}

// The leaf that holds a finest cell of the walk's root, or what is empty around it.
void descend(int volume, inout Walk w, ivec3 cell) {
  ivec3 period = ivec3(0), cells = ivec3(volumes[volume].cells[0], volumes[volume].cells[1], volumes[volume].cells[2]);
#ifdef NEPHO_BOX
  if ((volumes[volume].periodic & 1) != 0) period.x = int(floor(float(cell.x) / float(cells.x))) * cells.x;
  if ((volumes[volume].periodic & 2) != 0) period.y = int(floor(float(cell.y) / float(cells.y))) * cells.y;
#endif
  ivec3 local = cell - period;
  ivec3 grid_side = ivec3(w.grid_size.w & 31u, w.grid_size.w >> 5 & 31u, w.grid_size.w >> 10 & 31u);
  ivec3 place = (local >> grid_side) - ivec3(w.grid.xyz), size = ivec3(w.grid_size.xyz);
  bool inside = all(greaterThanEqual(place, ivec3(0))) && all(lessThan(place, size));
  uint at = uint(volumes[volume].first_node + w.root);
  if (inside) {
    int n = (place.z * size.y + place.y) * size.x + place.x;
    uvec4 four = node_at(w.grid.w + uint(n >> 2));
    at = (n & 2) == 0 ? ((n & 1) == 0 ? four.x : four.y) : (n & 1) == 0 ? four.z : four.w;
  }
  uvec4 node = node_at(at);
  if (!inside && (w.grid_size.w & GRID_IS_WHOLE) != 0u) node = beyond_grid(place, size);
  while ((node.y & 7u) == NODE_INNER) {
    ivec3 split = ivec3(node.y >> 3 & 1u, node.y >> 4 & 1u, node.y >> 5 & 1u);
    ivec3 upper = local >> max(node_sides(node.y) - 1, 0) & split;
    node = node_at(node.x + uint(upper.x | upper.y << split.x | upper.z << (split.x + split.y)));
  }
  w.kind = node.y & 7u;
  ivec3 side = node_sides(node.y);
  w.low = local >> side << side;
  w.high = w.low + (ivec3(1) << side);
  if ((node.y & EMPTY_BOX) != 0u) {
    uvec3 ends = node.xzw;
    ivec3 first = ivec3(ends & 65535u), last = ivec3(ends >> 16), from = ivec3(w.grid.xyz) - 1;
    ivec3 begin = from + first << grid_side, end = from + last << grid_side;
    w.low = mix(begin, ivec3(0), equal(first, ivec3(0)));
    w.high = mix(end, cells, equal(last, ivec3(EMPTY_BOX_BEYOND)));
  }
  w.low += period;
  w.high += period;
  w.per_cell = 8.0 / vec3(w.high - w.low);
  w.constant_per_m = w.kind == NODE_CONSTANT ? uintBitsToFloat(node.z) : 0.0;
  if (w.kind == NODE_BRICK) {
    vec2 brick = bricks[node.z];
    w.range_per_m = brick.x;
    w.offset_per_m = brick.y;
    w.cloud_box = node.w;
    w.tile = tile_origin(node.z, atlas_tiles);
#ifdef NEPHO_ICE
    vec2 ice = ice_bricks[node.z];
    w.ice_range_per_m = ice.x;
    w.ice_offset_per_m = ice.y;
#endif
  }
#ifdef NEPHO_LIT
  if (w.kind != NODE_EMPTY) w.light_tile = tile_origin(node.x, light_tiles);
#endif
}

#if defined(NEPHO_SHELL) || defined(NEPHO_GROUND)
#include "fp64.glsl"
#endif
#include "walk_box.glsl"
#ifdef NEPHO_SHELL
#include "walk_shell.glsl"
#endif

bool is_shell(int volume) {
#if defined(NEPHO_SHELL) && defined(NEPHO_BOX)
  return volumes[volume].chart == 1;
#elif defined(NEPHO_SHELL)
  return true;
#else
  return false;
#endif
}

// Position in finest cells relative to w.index, at distance t_m.
vec3 cells_at(int volume, Walk w, float t_m) {
#ifdef NEPHO_SHELL
  if (is_shell(volume)) return shell_cells_at(volume, w, t_m);
#endif
  return w.rest + w.slope * (t_m - w.anchor_m);
}

vec3 curved_leaf_cells_at(int volume, Walk w, float t_m) {
  return (vec3(w.index - w.low) + cells_at(volume, w, t_m)) * w.per_cell;
}

// Position in the leaf's own cells, 0..8.
vec3 leaf_cells_at(int volume, Walk w, float t_m) {
#ifdef NEPHO_LEAF_PARABOLA
  float u = t_m - w.segment_m;
  return clamp(w.place + u * (w.place_rise + u * w.place_bend), 0.0, 8.0);
#else
  return clamp(curved_leaf_cells_at(volume, w, t_m), 0.0, 8.0);
#endif
}

// Before places in the leaf are asked for, between two distances. The parabola that meets the curved
// coordinates half-way and is nearest to their cubic stands for them: 0.13 angle^2 of a cell off, for a
// leaf that wide in rad (the third derivatives of angle and height along a ray, times (1/2)^3 / 24).
void begin_leaf_segment(int volume, inout Walk w, float begin_m, float end_m) {
#ifdef NEPHO_LEAF_PARABOLA
  w.segment_m = 0.5 * (begin_m + end_m);
  w.place = curved_leaf_cells_at(volume, w, w.segment_m);
#ifdef NEPHO_SHELL
  if (is_shell(volume)) {
    shell_cells_growth(volume, w, w.segment_m, 0.5 * (end_m - begin_m), w.place_rise, w.place_bend);
    w.place_rise *= w.per_cell;
    w.place_bend *= w.per_cell;
    return;
  }
#endif
  w.place_rise = w.slope * w.per_cell;
  w.place_bend = vec3(0.0);
#endif
}

// The next wall of the box [low, high) after t_m.
void next_wall(int volume, Walk w, ivec3 low, ivec3 high, float t_m, out float wall_m,
               out int axis, out bool up) {
#ifdef NEPHO_SHELL
  if (is_shell(volume)) {
    shell_next_wall(volume, w, low, high, t_m, wall_m, axis, up);
    return;
  }
#endif
  box_next_wall(w, low, high, t_m, wall_m, axis, up);
}

void find_leave(int volume, inout Walk w, float t_m) {
  next_wall(volume, w, w.low, w.high, t_m, w.leave_m, w.leave_axis, w.leave_up);
}

// Starts a walk of the ray (ray_start, ray_direction). Until its entry the walk is OUTSIDE.
Walk begin_walk(int volume) {
#ifdef NEPHO_SHELL
  if (is_shell(volume)) return shell_begin(volume);
#endif
  return box_begin(volume);
}

// Goes on in a new frame, at w.leave_m: into the chart, or over an edge of the cube. fp64, and so apart
// from next_leaf: llvmpipe runs what is in branches at every turn of a loop.
void enter_chart(int volume, inout Walk w) {
  float t_m = w.leave_m;
  bool crosses = w.kind == CROSSING;
#ifdef NEPHO_SHELL
  int layer = w.low.z;
  if (is_shell(volume) && crosses) {
    if (w.leave_axis == 2) {
      shell_reenter(volume, w);
      return;
    }
    shell_cross_face(w);
  }
  if (is_shell(volume)) shell_set_face(volume, w, crosses ? w.root : shell_face_at(volume, w, t_m));
#endif
  w.grid = node_at(uint(volumes[volume].first_grid + 2 * w.root));
  w.grid_size = node_at(uint(volumes[volume].first_grid + 2 * w.root + 1));
  ivec3 cell = w.index + ivec3(floor(cells_at(volume, w, t_m)));
  ivec3 last = ivec3(volumes[volume].cells[0], volumes[volume].cells[1], volumes[volume].cells[2]) - 1;
  if ((volumes[volume].periodic & 1) == 0) cell.x = clamp(cell.x, 0, last.x);
  if ((volumes[volume].periodic & 2) == 0) cell.y = clamp(cell.y, 0, last.y);
  cell.z = clamp(cell.z, 0, last.z);
#ifdef NEPHO_SHELL
  if (crosses) cell.z = layer;
#endif
  descend(volume, w, cell);
  find_leave(volume, w, t_m);
}

// Leaves the current leaf for the one behind the wall, at w.leave_m.
void next_leaf(int volume, inout Walk w) {
  float t_m = w.leave_m;
  bool gone = w.leave_axis < 0;
  ivec3 cell = clamp(w.index + ivec3(floor(cells_at(volume, w, t_m))), w.low, w.high - 1);
  ivec3 beyond = w.leave_up ? w.high : w.low - 1;
  int count = volumes[volume].cells[0];
  if (w.leave_axis == 0) {
    cell.x = beyond.x;
  } else if (w.leave_axis == 1) {
    cell.y = beyond.y;
    count = volumes[volume].cells[1];
  } else {
    cell.z = beyond.z;
    count = volumes[volume].cells[2];
  }
  int at = w.leave_axis == 0 ? cell.x : w.leave_axis == 1 ? cell.y : cell.z;
  if (at < 0 || at >= count) {
    bool inside = false;
#ifdef NEPHO_BOX
    bool wraps = (volumes[volume].periodic >> max(w.leave_axis, 0) & 1) != 0;
    inside = wraps && ++w.wraps < MAX_WRAPS;
#ifndef NEPHO_LIT
    if (wraps && w.wraps >= MAX_LEVEL_WRAPS && box_is_level(w)) {
      inside = false;
      w.endless = true;
    }
#endif
#endif
#ifdef NEPHO_SHELL
    // Onto another face, or through the bottom.
    if (is_shell(volume) && !gone && (w.leave_axis < 2 || !w.leave_up)) {
      w.low.z = cell.z;
      w.kind = CROSSING;
      return;
    }
#endif
    gone = gone || !inside;
  }
  if (gone) {
    w.kind = GONE;
    w.leave_m = FAR;
    w.leave_axis = -1;
    return;
  }
  descend(volume, w, cell);
  find_leave(volume, w, t_m);
}
