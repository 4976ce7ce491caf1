// Marching all volumes at once: segments in which each volume is inside one leaf, steps in which
// Simpson integrates the sum of their extinctions. Included by the passes.

Walk walks[NEPHO_VOLUMES];

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
  float code = textureLod(atlas, (at + 0.5) / vec3(textureSize(atlas, 0)), 0.0).r;
#endif
  return walks[volume].offset_per_m + walks[volume].range_per_m * code;
}

float total_extinction_at(float t_m) {
  float sum = 0.0;
  for (int v = 0; v < NEPHO_VOLUMES; ++v) sum += extinction_at(v, t_m);
  return sum;
}

// Where the ray meets the ground, or FAR.
float ground_distance() {
  if (frame.ground_radius_m <= 0.0LF) return FAR;
  dvec3 p = dvec3(ray_start.xy, ray_start.z * frame.ground_z_scale);
  dvec3 d = dvec3(ray_direction.xy, ray_direction.z * frame.ground_z_scale);
  double stretch = sqrt(dot(d, d)), r0 = sqrt(dot(p, p));
  double b = dot(p, d) / stretch, height = r0 - frame.ground_radius_m;
  double c = height * (r0 + frame.ground_radius_m), discriminant = b * b - c;
  if (b >= 0.0LF || discriminant < 0.0LF || height < -0.01LF) return FAR;
  return float(max(c / (-b + sqrt(discriminant)), 0.0LF) / stretch);
}

// Starts all walks; the distance of the first entry, or FAR where the ground comes first or nothing
// is met, and that of the ground. A ray that starts outside is moved, in fp64, to its first entry:
// a float of metres from there resolves thin steps in thick cloud, also for an eye at 1e9 m.
float begin_walks(out float ground_m) {
  float first = FAR;
  for (int moved = 0; moved < 2; ++moved) {
    first = FAR;
    for (int v = 0; v < NEPHO_VOLUMES; ++v) {
      walks[v] = begin_walk(v);
      first = min(first, walks[v].leave_m);
    }
    ground_m = ground_distance();
    if (ground_m <= first) return FAR;
    if (first <= 0.0 || first >= FAR) break;
    if (moved == 0) ray_start += ray_direction * double(first);
  }
  return first;
}

// Brings every walk into the leaf that holds t_m. Returns where the first of them is left; `empty`
// where no leaf has extinction, `smooth` where none has a brick.
float settle_walks(float t_m, out bool empty, out bool smooth_) {
  float end = FAR;
  empty = true;
  smooth_ = true;
  for (int v = 0; v < NEPHO_VOLUMES; ++v) {
    while (walks[v].leave_m <= t_m) next_leaf(v, walks[v]);
    end = min(end, walks[v].leave_m);
    if (walks[v].kind == NODE_BRICK) smooth_ = false;
    if (walks[v].kind == NODE_BRICK || walks[v].kind == NODE_CONSTANT) empty = false;
  }
  return end;
}

// One cell of the finest leaf around t_m, along the ray.
float cell_length(float t_m) {
  float least = FAR;
  for (int v = 0; v < NEPHO_VOLUMES; ++v)
    if (walks[v].kind == NODE_BRICK || walks[v].kind == NODE_CONSTANT) {
#ifdef NEPHO_SHELL
      if (is_shell(v)) {
        least = min(least, shell_cell_length(v, walks[v], t_m));
        continue;
      }
#endif
#ifdef NEPHO_BOX
      least = min(least, box_cell_length(walks[v]));
#endif
    }
  return least;
}

// Where the first of the cells around t_m is left, and the Simpson sub-steps that its curvature
// asks for: the reference setting.
float cell_end(float t_m, float end_m, out int sub_steps) {
  float least = end_m;
  sub_steps = 1;
  for (int v = 0; v < NEPHO_VOLUMES; ++v) {
    if (walks[v].kind != NODE_BRICK) continue;
    ivec3 size = (walks[v].high - walks[v].low) >> 3;
    // The cell ahead, a hair beyond t_m: on a wall the cell behind would end at once.
    float ahead = t_m + 1e-3 * cell_length(t_m);
    ivec3 cell = clamp(ivec3(floor(leaf_cells_at(v, walks[v], ahead))), ivec3(0), ivec3(7));
    ivec3 low = walks[v].low + cell * size;
    float wall;
    int axis;
    bool up;
    next_wall(v, walks[v], low, low + size, ahead, wall, axis, up);
    least = min(least, wall);
  }
  least = min(max(least, t_m + 1e-3 * cell_length(t_m)), end_m);
#ifdef NEPHO_SHELL
  for (int v = 0; v < NEPHO_VOLUMES; ++v)
    if (is_shell(v) && walks[v].kind == NODE_BRICK) {
      float height = float(volumes[v].cell_height_m) / walks[v].per_cell.z;
      sub_steps = max(sub_steps, simpson_steps((least - t_m) * walks[v].stretch, walks[v].radius.z, height));
    }
#endif
  return least;
}

// Optical depth from the start to where the ray leaves all charts; `blocked` where the ground is hit.
const float OPAQUE = 65504.0;  // the largest half float
float optical_depth_ahead() {
  float end_m, t = begin_walks(end_m), tau = 0.0;
  if (t >= FAR) return end_m < FAR ? OPAQUE : 0.0;
  for (int guard = 0; guard < 1000000 && t < end_m; ++guard) {
    bool empty, smooth_;
    float end = min(settle_walks(t, empty, smooth_), end_m);
    if (end >= FAR) break;
    if (!empty) {
      float k0 = total_extinction_at(t);
      if (smooth_) {
        tau += k0 * (end - t);
      } else {
        float h = NEPHO_SUN_STEP * cell_length(0.5 * (t + end));
        while (t < end) {
#ifdef NEPHO_CELL_EXACT
          int sub_steps;
          float next = cell_end(t, end, sub_steps);
#else
          // Equal steps to the end of the segment: no short last one.
          const int sub_steps = 1;
          float next = end - t < 1.5 * h ? end : t + h;
#endif
          float sub = (next - t) / float(sub_steps);
          for (int s = 0; s < sub_steps; ++s) {
            float k_mid = total_extinction_at(t + 0.5 * sub), k1 = total_extinction_at(t + sub);
            tau += simpson_optical_depth(k0, k_mid, k1, sub);
            k0 = k1;
            t += sub;
          }
          t = next;
        }
      }
      if (tau > 1e4) break;
    }
    t = end;
  }
  return end_m < FAR ? OPAQUE : min(tau, OPAQUE);
}
