// The affine box: q, and so the cell, is linear along the ray; walls are exact in closed form.

Walk box_begin(int volume) {
  Walk w;
  w.kind = GONE;
  w.leave_m = FAR;
  w.leave_axis = -1;
  w.root = 0;
  w.wraps = 0;
  w.endless = false;
  VolumeData v = volumes[volume];
  dvec3 from_origin = ray_start - vec_of(v.origin_m);
  dvec3 cell, slope;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 row = dvec3(v.to_cells[3 * axis], v.to_cells[3 * axis + 1], v.to_cells[3 * axis + 2]);
    cell[axis] = dot(row, from_origin);
    slope[axis] = dot(row, ray_direction);
  }
  double enter = 0.0LF, leave = 1e300LF;
  for (int axis = 0; axis < 3; ++axis) {
    if ((v.periodic >> axis & 1) != 0) continue;
    double count = double(v.cells[axis]);
    // A start on a face, off by a rounding, is inside.
    double slack = 1e-9LF * count;
    if (abs(slope[axis]) < 1e-30LF) {
      if (cell[axis] < -slack || cell[axis] > count + slack) return w;
      continue;
    }
    double a = -cell[axis] / slope[axis], b = (count - cell[axis]) / slope[axis];
    enter = max(enter, min(a, b));
    leave = min(leave, max(a, b));
  }
  if (leave <= enter) return w;
  cell += slope * enter;
  for (int axis = 0; axis < 2; ++axis)
    if ((v.periodic >> axis & 1) != 0) {
      double count = double(v.cells[axis]);
      cell[axis] -= floor(cell[axis] / count) * count;
    }
  dvec3 nearest = floor(cell + 0.5LF);
  w.index = ivec3(nearest);
  w.rest = vec3(cell - nearest);
  w.slope = vec3(slope);
  w.anchor_m = float(enter);
  w.kind = OUTSIDE;
  w.leave_m = w.anchor_m;
  return w;
}

bool box_is_level(Walk w) { return abs(w.slope.z) < 1e-6 * max(abs(w.slope.x), abs(w.slope.y)); }

void box_next_wall(Walk w, ivec3 low, ivec3 high, float t_m, out float wall_m, out int axis,
                   out bool up) {
  wall_m = FAR;
  axis = 0;
  up = true;
  for (int a = 0; a < 3; ++a) {
    if (w.slope[a] == 0.0) continue;
    bool rises = w.slope[a] > 0.0;
    int wall = rises ? high[a] : low[a];
    float t = w.anchor_m + box_wall_distance(wall, w.index[a], w.rest[a], 1.0 / w.slope[a]);
    if (t < wall_m) {
      wall_m = t;
      axis = a;
      up = rises;
    }
  }
  wall_m = max(wall_m, t_m);
}

// Length of the ray in one of the leaf's cells, at most.
float box_cell_length(Walk w) {
  vec3 per_m = abs(w.slope) * w.per_cell;
  return 1.0 / max(max(per_m.x, per_m.y), max(per_m.z, 1e-30));
}
