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
  // The leaf.
  ivec3 low, high;   // its box in finest cells, high excluded
  int level;
  uint kind;
  float constant_per_m;
  float range_per_m, offset_per_m;
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
  int wraps;
  bool endless;      // level, and out of wraps
};

const uint OUTSIDE = 4u, GONE = 5u;

// The ray of this invocation, world metres.
dvec3 ray_start, ray_direction;

int child_rank(int volume, int level, ivec3 cell, ivec3 shift_below) {
  int rank = 0, bit = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (splits(volume, level, axis)) {
      rank |= (cell[axis] >> (3 + shift_below[axis]) & 1) << bit;
      ++bit;
    }
  return rank;
}

vec3 tile_origin(uint slot, ivec3 atlas_size) {
  uint nx = uint(atlas_size.x) / 9u, ny = uint(atlas_size.y) / 9u;
  return 9.0 * vec3(slot % nx, slot / nx % ny, slot / (nx * ny));
}

// The leaf that holds a finest cell of the walk's root.
void descend(int volume, inout Walk w, ivec3 cell) {
  ivec3 cells = ivec3(volumes[volume].cells[0], volumes[volume].cells[1], volumes[volume].cells[2]);
  ivec3 period = ivec3(0);
  if ((volumes[volume].periodic & 1) != 0) period.x = int(floor(float(cell.x) / float(cells.x))) * cells.x;
  if ((volumes[volume].periodic & 2) != 0) period.y = int(floor(float(cell.y) / float(cells.y))) * cells.y;
  ivec3 local = cell - period;
  uint at = uint(volumes[volume].first_node + w.root);
  NodeRecord node = nodes[at];
  int level = 0;
  while ((node.flags & 7u) == NODE_INNER) {
    at = node.first_child_or_lit + uint(child_rank(volume, level, local, cell_shift(volume, level + 1)));
    node = nodes[at];
    ++level;
  }
  w.level = level;
  w.kind = node.flags & 7u;
  ivec3 shift = cell_shift(volume, level) + 3;
  w.low = (local >> shift << shift) + period;
  w.high = w.low + (ivec3(1) << shift);
  w.per_cell = 8.0 / vec3(w.high - w.low);
  if (w.kind == NODE_BRICK) {
    BrickRecord brick = bricks[node.brick_or_constant];
    w.range_per_m = brick.range_per_m;
    w.offset_per_m = brick.offset_per_m;
    w.tile = tile_origin(node.brick_or_constant, textureSize(atlas, 0));
#ifdef NEPHO_ICE
    w.ice_range_per_m = ice_bricks[node.brick_or_constant].range_per_m;
    w.ice_offset_per_m = ice_bricks[node.brick_or_constant].offset_per_m;
#endif
  } else {
    w.constant_per_m = w.kind == NODE_CONSTANT ? uintBitsToFloat(node.brick_or_constant) : 0.0;
  }
#ifdef NEPHO_LIT
  if (w.kind != NODE_EMPTY) w.light_tile = tile_origin(node.first_child_or_lit, textureSize(light_atlas, 0));
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

// Position in the leaf's own cells, 0..8.
vec3 leaf_cells_at(int volume, Walk w, float t_m) {
  return clamp((vec3(w.index - w.low) + cells_at(volume, w, t_m)) * w.per_cell, 0.0, 8.0);
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

// Leaves the current leaf for the one behind the wall, at w.leave_m.
void next_leaf(int volume, inout Walk w) {
  float t_m = w.leave_m;
  if (w.leave_axis < 0) {  // enters the chart, or has nothing more ahead
    if (w.kind == OUTSIDE) {
#ifdef NEPHO_SHELL
      if (is_shell(volume)) shell_set_face(volume, w, shell_face_at(volume, w, t_m));
#endif
      ivec3 cell = w.index + ivec3(floor(cells_at(volume, w, t_m)));
      ivec3 cells = ivec3(volumes[volume].cells[0], volumes[volume].cells[1], volumes[volume].cells[2]);
      bvec2 wrap = bvec2((volumes[volume].periodic & 1) != 0, (volumes[volume].periodic & 2) != 0);
      if (!wrap.x) cell.x = clamp(cell.x, 0, cells.x - 1);
      if (!wrap.y) cell.y = clamp(cell.y, 0, cells.y - 1);
      cell.z = clamp(cell.z, 0, cells.z - 1);
      descend(volume, w, cell);
      find_leave(volume, w, t_m);
    } else {
      w.kind = GONE;
      w.leave_m = FAR;
    }
    return;
  }
  ivec3 cell = clamp(w.index + ivec3(floor(cells_at(volume, w, t_m))), w.low, w.high - 1);
  cell[w.leave_axis] = w.leave_up ? w.high[w.leave_axis] : w.low[w.leave_axis] - 1;
  int count = volumes[volume].cells[w.leave_axis];
  bool wraps = (volumes[volume].periodic >> w.leave_axis & 1) != 0;
  if (cell[w.leave_axis] < 0 || cell[w.leave_axis] >= count) {
    bool inside = wraps && ++w.wraps < MAX_WRAPS;
#if defined(NEPHO_BOX) && !defined(NEPHO_LIT)
    if (wraps && w.wraps >= MAX_LEVEL_WRAPS && box_is_level(w)) {
      inside = false;
      w.endless = true;
    }
#endif
#ifdef NEPHO_SHELL
    if (is_shell(volume)) {
      if (w.leave_axis < 2) {
        cell = shell_cross_face(volume, w, t_m, cell.z);
        inside = true;
      } else if (!w.leave_up) {
        shell_reenter(volume, w);
        return;
      }
    }
#endif
    if (!inside) {
      w.kind = GONE;
      w.leave_m = FAR;
      w.leave_axis = -1;
      return;
    }
  }
  descend(volume, w, cell);
  find_leave(volume, w, t_m);
}
