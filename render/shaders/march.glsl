// Loops over volumes are written out by the host (NEPHO_EACH_VOLUME = NEPHO_DO(0) NEPHO_DO(1) ...):
// indices are then constants, and llvmpipe, where all loops of an invocation share 65535 iterations,
// spends none on them. A ray that runs out all the same is counted in `overruns`, never ignored.
//
// Marching all volumes at once: segments in which each volume is inside one leaf, steps in which
// Simpson integrates the sum of their extinctions. Included by the passes.

Walk walks[NEPHO_VOLUMES];

layout(std430, binding = 6) buffer CounterBuffer { uint overruns, rays, extinction_samples, source_samples; };

// `ended` is set in a loop's body where its condition is about to fail. (The condition itself, asked
// again after the loop, came out wrong on llvmpipe.)
void count_overrun(int ended) {
  if (ended == 0) atomicAdd(overruns, 1u);
}

float texel8(sampler3D map, vec3 at) {
  vec3 f = fract(at);
  ivec3 p = ivec3(at);
  // Never beyond the tile: on its last sample the weight is 0.
  ivec3 n = ivec3(greaterThan(f, vec3(0.0)));
  vec4 low = vec4(texelFetch(map, p, 0).r, texelFetch(map, p + ivec3(n.x, 0, 0), 0).r,
                  texelFetch(map, p + ivec3(0, n.y, 0), 0).r, texelFetch(map, p + ivec3(n.x, n.y, 0), 0).r);
  vec4 high = vec4(texelFetch(map, p + ivec3(0, 0, n.z), 0).r, texelFetch(map, p + ivec3(n.x, 0, n.z), 0).r,
                   texelFetch(map, p + ivec3(0, n.y, n.z), 0).r, texelFetch(map, p + n, 0).r);
  vec4 c = low + (high - low) * f.z;
  vec2 d = c.xy + (c.zw - c.xy) * f.y;
  return d.x + (d.y - d.x) * f.x;
}

float extinction_at(int volume, float t_m) {
  if (walks[volume].kind != NODE_BRICK) return walks[volume].kind == NODE_CONSTANT ? walks[volume].constant_per_m : 0.0;
  vec3 at = walks[volume].tile + leaf_cells_at(volume, walks[volume], t_m);
#ifdef NEPHO_TEXELS8
  float code = texel8(atlas, at);
#else
  float code = textureLod(atlas, (at + 0.5) * per_atlas_texel, 0.0).r;
#endif
#ifdef NEPHO_MUTANT_HALF_EXTINCTION
  code *= 0.5;
#endif
  return walks[volume].offset_per_m + walks[volume].range_per_m * code;
}

// Of each volume, where total_extinction_at was asked last: the source there needs them too.
float last_extinction[NEPHO_VOLUMES];

float total_extinction_at(float t_m) {
  float sum = 0.0;
#ifdef NEPHO_MUTANT_GREATEST
#define NEPHO_DO(v)                            \
  last_extinction[v] = extinction_at(v, t_m);  \
  sum = max(sum, last_extinction[v]);
#else
#define NEPHO_DO(v)                            \
  last_extinction[v] = extinction_at(v, t_m);  \
  sum += last_extinction[v];
#endif
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return sum;
}

#include "ground_distance.glsl"

// Starts all walks; the distance of the first entry, or FAR where the ground comes first or nothing
// is met, and that of the ground. A ray that starts outside is moved, in fp64, to its first entry:
// a float of metres from there resolves thin steps in thick cloud, also for an eye at 1e9 m. Moved a
// little less far: rounded up, the entry would be inside (at 1e9 m by up to 32 m).
float begin_walks(out float ground_m) {
  float first = FAR;
  for (int moved = 0; moved < 2; ++moved) {
    first = FAR;
#define NEPHO_DO(v)         \
  walks[v] = begin_walk(v); \
  first = min(first, walks[v].leave_m);
    NEPHO_EACH_VOLUME
#undef NEPHO_DO
    ground_m = ground_distance();
    if (ground_m <= first) return FAR;
    if (first <= 0.0 || first >= FAR) break;
    if (moved == 0) ray_start += ray_direction * (double(first) * (1.0LF - 1.2e-7LF));
  }
  return first;
}

// Starts what has to go on in a new frame at t_m or before.
void enter_walks(float t_m) {
#define NEPHO_DO(v)                                                                             \
  if ((walks[v].kind == OUTSIDE || walks[v].kind == CROSSING) && walks[v].leave_m <= t_m)       \
    enter_chart(v, walks[v]);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
}

// Brings walks onward that are left at t_m or before, by a leaf each. Returns where the first of them
// is left, which may be at t_m again; `empty` where no leaf has extinction, `smooth` where none has a
// brick; `enters` where enter_walks has to be asked first.
float settle_walks(float t_m, out bool empty, out bool smooth_, out bool enters) {
  float end = FAR;
  empty = smooth_ = true;
  enters = false;
#define NEPHO_DO(v)                                                                               \
  if (walks[v].kind < OUTSIDE && walks[v].leave_m <= t_m) next_leaf(v, walks[v]);                 \
  end = min(end, walks[v].leave_m);                                                               \
  enters = enters || ((walks[v].kind == OUTSIDE || walks[v].kind == CROSSING) && walks[v].leave_m <= t_m); \
  smooth_ = smooth_ && walks[v].kind != NODE_BRICK;                                               \
  empty = empty && walks[v].kind != NODE_BRICK && walks[v].kind != NODE_CONSTANT;
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return end;
}

float leaf_cell_length(int volume, float t_m) {
  float cell_m = FAR;
  if (walks[volume].kind == NODE_BRICK || walks[volume].kind == NODE_CONSTANT) {
#if defined(NEPHO_SHELL) && defined(NEPHO_BOX)
    if (is_shell(volume))
      cell_m = shell_cell_length(volume, walks[volume], t_m);
    else
      cell_m = box_cell_length(walks[volume]);
#elif defined(NEPHO_SHELL)
    cell_m = shell_cell_length(volume, walks[volume], t_m);
#else
    cell_m = box_cell_length(walks[volume]);
#endif
  }
  return cell_m;
}

// The shortest step that a float of t_m can still take: a few of its spacings.
float least_step(float t_m) { return 5e-7 * abs(t_m); }

// One cell of the finest leaf around t_m, along the ray.
float cell_length(float t_m) {
  float least = FAR;
#define NEPHO_DO(v) least = min(least, leaf_cell_length(v, t_m));
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return least;
}

#ifdef NEPHO_CELL_EXACT
// Where the leaf's cell around `ahead` is left.
float leaf_cell_end(int volume, float ahead) {
  float wall = FAR;
  if (walks[volume].kind == NODE_BRICK) {
    // Rounded down before the index is added: a sum in float could round a ray that leaves a wall
    // at 1e-18 of its length back onto it, and that wall, always behind, is never left.
    ivec3 at = walks[volume].index + ivec3(floor(cells_at(volume, walks[volume], ahead)));
    ivec3 size = (walks[volume].high - walks[volume].low) >> 3;  // powers of two
    at = clamp(at, walks[volume].low, walks[volume].high - 1) - walks[volume].low;
    ivec3 low = walks[volume].low + (at & -size);
    int axis;
    bool up;
    next_wall(volume, walks[volume], low, low + size, ahead, wall, axis, up);
  }
  return wall;
}

int leaf_sub_steps(int volume, float step_m) {
#ifdef NEPHO_SHELL
  if (is_shell(volume) && walks[volume].kind == NODE_BRICK)
    return simpson_steps(step_m * walks[volume].stretch, walks[volume].radius.z,
                         shell_floats[volume].cell_height_m / walks[volume].per_cell.z);
#endif
  return 1;
}

// Where the first of the cells around t_m is left, and the Simpson sub-steps that its curvature
// asks for: the reference setting.
float cell_end(float t_m, float end_m, out int sub_steps) {
  // A hair beyond t_m: on a wall the cell behind would end at once.
  float hair = max(1e-3 * cell_length(t_m), least_step(t_m)), least = end_m;
#define NEPHO_DO(v) least = min(least, leaf_cell_end(v, t_m + hair));
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  least = min(max(least, t_m + hair), end_m);
  sub_steps = 1;
#define NEPHO_DO(v) sub_steps = max(sub_steps, leaf_sub_steps(v, least - t_m));
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return least;
}
#endif

void begin_segment(float begin_m, float end_m) {
#define NEPHO_DO(v) begin_leaf_segment(v, walks[v], begin_m, end_m);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
}

#if !defined(NEPHO_CELL_EXACT) && (defined(NEPHO_LEAF_PARABOLA) || !defined(NEPHO_SHELL))
// Widens [first, last] by what the segment has of one leaf's samples that are not 0 and the cells around
// them: where the straight line between its ends, as wide as the parabola is bent, runs through their box.
void widen_by_cloud(int volume, float begin_m, float end_m, inout float first_m, inout float last_m) {
  if (walks[volume].kind == NODE_CONSTANT) {
    first_m = begin_m;
    last_m = end_m;
  }
  if (walks[volume].kind != NODE_BRICK) return;
  uint box = walks[volume].cloud_box;
  float length_m = end_m - begin_m;
  vec3 slack = vec3(1e-3);
#ifdef NEPHO_LEAF_PARABOLA
  slack += 0.25 * length_m * length_m * abs(walks[volume].place_bend);
#endif
  vec3 low = vec3(ivec3(box & 15u, box >> 4 & 15u, box >> 8 & 15u) - 1) - slack;
  vec3 high = vec3(ivec3(box >> 12 & 15u, box >> 16 & 15u, box >> 20) + 1) + slack;
  vec3 from = leaf_cells_at(volume, walks[volume], begin_m);
  vec3 along = leaf_cells_at(volume, walks[volume], end_m) - from;
  along = mix(along, vec3(1e-4), lessThan(abs(along), vec3(1e-4)));
  vec3 a = (low - from) / along, b = (high - from) / along, enter = min(a, b), leave = max(a, b);
  float first = max(max(enter.x, enter.y), max(enter.z, 0.0)), last = min(min(leave.x, leave.y), min(leave.z, 1.0));
  if (first >= last) return;
  first_m = min(first_m, begin_m + first * length_m);
  last_m = max(last_m, begin_m + last * length_m);
}
#define NEPHO_CLOUD_BOX
#endif

// Optical depth within one set of leaves.
float depth_of_segment(float t, float end, bool smooth_) {
  begin_segment(t, end);
#ifdef NEPHO_CLOUD_BOX
  float first = end, last = t;
#define NEPHO_DO(v) widen_by_cloud(v, t, end, first, last);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  t = first;
  end = min(last, end);
#endif
  float k0 = total_extinction_at(t), tau = 0.0;
  // Constant extinction is one step.
  float h = smooth_ ? end - t : NEPHO_SUN_STEP * cell_length(0.5 * (t + end));
  while (t < end) {
#ifdef NEPHO_CELL_EXACT
    int sub_steps = 1;
    float next = end;
    if (!smooth_) next = cell_end(t, end, sub_steps);
#else
    // Equal steps to the end of the segment: no short last one.
    const int sub_steps = 1;
    float next = end - t < 1.5 * h ? end : t + max(h, least_step(t));
#endif
    float sub = (next - t) / float(sub_steps);
    for (int s = 0; s < sub_steps; ++s) {
      float k_mid = total_extinction_at(t + 0.5 * sub), k1 = total_extinction_at(t + sub);
      float part = simpson_optical_depth(k0, k_mid, k1, sub);
      tau += part;
#ifdef NEPHO_NOTE_DEPTH
      note_depth(part, t, t + sub);
#endif
      k0 = k1;
      t += sub;
    }
    t = next;
  }
  return tau;
}

// Optical depth from the start to the ground, or to where the ray leaves all charts; done where it
// is above `most`.
const float OPAQUE = 65504.0;  // the largest half float
float optical_depth_ahead(float most) {
  float end_m, t = begin_walks(end_m), tau = 0.0;
  int ended = t < end_m ? 0 : 1;
  // Loops within loops: llvmpipe runs all of a loop's body at every turn, and turns end only when all
  // rays side by side are through. Entering a chart, empty leaves and marching are apart.
  while (ended == 0) {
    enter_walks(t);
    int inside = 1;
    while (inside == 1) {
      bool empty, smooth_, enters;
      float leave;
      int looking = 1;
      while (looking == 1) {
        leave = settle_walks(t, empty, smooth_, enters);
        if (empty && !enters && leave < FAR) t = min(max(t, leave), end_m);
        if (enters || leave >= FAR || t >= end_m || (!empty && leave > t)) looking = 0;
      }
      if (leave >= FAR || t >= end_m) {
        ended = 1;
        inside = 0;
      } else if (enters) {
        inside = 0;
      } else {
        float end = min(leave, end_m);
        tau += depth_of_segment(t, end, smooth_);
        t = end;
        if (t >= end_m || tau > most) {
          ended = 1;
          inside = 0;
        }
      }
    }
  }
  count_overrun(ended);
  // A level ray in a periodic layer never leaves it.
#define NEPHO_DO(v) \
  if (walks[v].endless && tau > 0.0) tau = OPAQUE;
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  return min(tau, OPAQUE);
}
