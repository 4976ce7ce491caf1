// The spherical shell in scaled space (z stretched by a/b): walls of u and v are planes through the
// centre, met in the plane across their axis; walls of z are spheres. A straight ray turns about
// each axis in one sense, so u and v each have one wall ahead; z falls until the perigee.

const int FACE_U[6] = int[](1, 1, 0, 0, 0, 0);      // axis of u
const float FACE_U_SIGN[6] = float[](1.0, -1.0, -1.0, 1.0, 1.0, 1.0);
const int FACE_V[6] = int[](2, 2, 2, 2, 1, 1);
const float FACE_V_SIGN[6] = float[](1.0, 1.0, 1.0, 1.0, 1.0, -1.0);

float face_sign(int face) { return (face & 1) == 0 ? 1.0 : -1.0; }

dvec3 to_scaled(int volume, dvec3 p) { return dvec3(p.x, p.y, p.z * volumes[volume].z_scale); }

// Unit direction in scaled space, and the scaled metres in a metre.
dvec3 scaled_direction(int volume, out double stretch) {
  dvec3 d = to_scaled(volume, ray_direction);
  stretch = sqrt(dot(d, d));
  return d / stretch;
}

dvec3 scaled_point(int volume, double t_m) {
  return to_scaled(volume, ray_start + ray_direction * t_m);
}

int shell_face_at(int volume, Walk w, float t_m) {
  dvec3 p = scaled_point(volume, double(t_m));
  dvec3 a = abs(p);
  int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (p[axis] < 0.0LF ? 1 : 0);
}

void face_axis(int volume, inout Walk w, int slot, double normal, double side, double d_normal,
               double d_side) {
  double radius = sqrt(normal * normal + side * side);
  double angle = atan_fp64(side, normal);
  double cell = angle / volumes[volume].cell_rad + 0.5LF * double(volumes[volume].cells[0]);
  double nearest = floor(cell + 0.5LF);
  w.index[slot] = int(nearest);
  w.rest[slot] = float(cell - nearest);
  w.radius[slot] = float(radius);
  w.radial[slot] = float((normal * d_normal + side * d_side) / radius);
  w.slope[slot] = float((normal * d_side - side * d_normal) / radius);
}

// The frame of one face about the walk's anchor.
void shell_set_face(int volume, inout Walk w, int face) {
  double stretch;
  dvec3 d = scaled_direction(volume, stretch);
  dvec3 p = scaled_point(volume, double(w.anchor_m));
  int axis = face >> 1;
  double sign_n = double(face_sign(face));
  double normal = sign_n * p[axis], d_normal = sign_n * d[axis];
  double su = double(FACE_U_SIGN[face]), sv = double(FACE_V_SIGN[face]);
  w.root = face;
  face_axis(volume, w, 0, normal, su * p[FACE_U[face]], d_normal, su * d[FACE_U[face]]);
  face_axis(volume, w, 1, normal, sv * p[FACE_V[face]], d_normal, sv * d[FACE_V[face]]);
}

Walk shell_begin(int volume) {
  Walk w;
  w.kind = GONE;
  w.leave_m = FAR;
  w.leave_axis = -1;
  w.wraps = 0;
  w.endless = false;
  w.root = 0;
  VolumeData v = volumes[volume];
  double stretch;
  dvec3 d = scaled_direction(volume, stretch);
  dvec3 p = scaled_point(volume, 0.0LF);
  double r0 = sqrt(dot(p, p)), mu = dot(p, d) / r0;
  double height = r0 - v.radius_m, thickness = v.cell_height_m * double(v.cells[2]);
  double slack = 1e-9LF * thickness, enter = 0.0LF;
  if (height > v.bottom_m + thickness + slack)
    enter = sphere_entry(r0, mu, v.radius_m + v.bottom_m + thickness, false);
  else if (height < v.bottom_m - slack)
    enter = sphere_entry(r0, mu, v.radius_m + v.bottom_m, true);
  if (enter < 0.0LF) return w;
  w.stretch = float(stretch);
  w.anchor_m = float(enter / stretch);
  // The anchor is the rounded float itself, so that frame and distances agree.
  p = scaled_point(volume, double(w.anchor_m));
  r0 = sqrt(dot(p, p));
  double cell = (r0 - v.radius_m - v.bottom_m) / v.cell_height_m;
  double nearest = floor(cell + 0.5LF);
  w.index.z = int(nearest);
  w.rest.z = float(cell - nearest);
  w.radius.z = float(r0);
  w.radial.z = float(dot(p, d) / r0);
  w.slope.z = 0.0;
  w.kind = OUTSIDE;
  w.leave_m = w.anchor_m;
  return w;
}

vec3 shell_cells_at(int volume, Walk w, float t_m) {
  float t = (t_m - w.anchor_m) * w.stretch;
  float per_rad = shell_floats[volume].per_cell_rad, per_m = shell_floats[volume].per_cell_height_m;
  return w.rest + vec3(angle_along_ray(w.radius.x, t, w.radial.x, w.slope.x) * per_rad,
                       angle_along_ray(w.radius.y, t, w.radial.y, w.slope.y) * per_rad,
                       height_along_ray(w.radius.z, t, w.radial.z) * per_m);
}

// As angle_growth_along_ray(), in metres from t_m.
void shell_cells_growth(int volume, Walk w, float t_m, float reach_m, out vec3 rise, out vec3 bend) {
  float t = (t_m - w.anchor_m) * w.stretch, reach = reach_m * w.stretch;
  for (int a = 0; a < 2; ++a) {
    float turn, fade;
    angle_growth_along_ray(w.radius[a], t, w.radial[a], w.slope[a], reach, turn, fade);
    rise[a] = turn * shell_floats[volume].per_cell_rad;
    bend[a] = -rise[a] * fade;
  }
  float r = w.radius.z + height_along_ray(w.radius.z, t, w.radial.z);
  float mu = (w.radius.z * w.radial.z + t) / r;
  float level = max(1.0 - mu * mu, 0.0), per_r = 1.0 / r;
  rise.z = mu * (1.0 - 0.375 * level * (reach * per_r) * (reach * per_r)) * shell_floats[volume].per_cell_height_m;
  bend.z = 0.5 * level * per_r * shell_floats[volume].per_cell_height_m;
  rise *= w.stretch;
  bend *= w.stretch * w.stretch;
}

void shell_next_wall(int volume, Walk w, ivec3 low, ivec3 high, float t_m, out float wall_m,
                     out int axis, out bool up) {
  wall_m = FAR;
  axis = 0;
  up = true;
  float per_stretch = 1.0 / w.stretch, cell_rad = shell_floats[volume].cell_rad;
  float now = (t_m - w.anchor_m) * w.stretch;
  for (int a = 0; a < 2; ++a) {
    bool rises = w.slope[a] > 0.0;
    int wall = rises ? high[a] : low[a];
    float angle = wall_offset(wall, w.index[a], w.rest[a], cell_rad);
    float t = w.slope[a] == 0.0 ? FAR : angular_wall_distance(w.radius[a], angle, w.radial[a], w.slope[a]);
    // A wall that the ray is on may come out behind it by a rounding; one far behind is never met.
    if (t < now - 1e-5 * (abs(now) + w.radius[a] * cell_rad)) t = FAR;
    if (t < wall_m) {
      wall_m = t;
      axis = a;
      up = rises;
    }
  }
  float cell_height = shell_floats[volume].cell_height_m, layer;
  bool lower;
  layer_wall_distance(w.radius.z, -wall_offset(low.z, w.index.z, w.rest.z, cell_height),
                      -wall_offset(high.z, w.index.z, w.rest.z, cell_height), w.radial.z,
                      now < -w.radius.z * w.radial.z, layer, lower);
  if (layer < wall_m) {
    wall_m = layer;
    axis = 2;
    up = !lower;
  }
  wall_m = wall_m >= FAR ? FAR : max(w.anchor_m + wall_m * per_stretch, t_m);
}

// Behind a wall u or v at a face's end lies another face.
void shell_cross_face(inout Walk w) {
  bool u = w.leave_axis == 0;
  int axis = u ? FACE_U[w.root] : FACE_V[w.root];
  float side = (u ? FACE_U_SIGN[w.root] : FACE_V_SIGN[w.root]) * (w.leave_up ? 1.0 : -1.0);
#ifdef NEPHO_MUTANT_OPPOSITE_FACE
  side = -side;
#endif
  w.root = 2 * axis + (side < 0.0 ? 1 : 0);
}

// Through the bottom: the shell is met again on the far side, unless the ground is in the way.
void shell_reenter(int volume, inout Walk w) {
  float near, far;
  float above = -wall_offset(0, w.index.z, w.rest.z, shell_floats[volume].cell_height_m);
  sphere_wall_distances(w.radius.z, above, w.radial.z, near, far);
  w.kind = far < no_hit() ? OUTSIDE : GONE;
  w.leave_m = far < no_hit() ? w.anchor_m + far / w.stretch : FAR;
  w.leave_axis = -1;
}

float shell_cell_length(int volume, Walk w, float t_m) {
  float t = (t_m - w.anchor_m) * w.stretch;
  float r = w.radius.z + height_along_ray(w.radius.z, t, w.radial.z);
  float mu = clamp((w.radius.z * w.radial.z + t) / r, -1.0, 1.0);
  vec3 size = vec3(vec2(shell_floats[volume].cell_rad * r), shell_floats[volume].cell_height_m) / w.per_cell;
  return 1.0 / (sqrt(1.0 - mu * mu) / min(size.x, size.y) + abs(mu) / size.z) / w.stretch;
}

dvec3 shell_world_of(int volume, int root, ivec3 index) {
  VolumeData v = volumes_in[volume];
  double half_turn = 0.5LF * double(v.cells[0]);
  dvec2 tangent;
  for (int slot = 0; slot < 2; ++slot) {
    double s, c;
    sin_cos_fp64((double(index[slot]) - half_turn) * v.cell_rad, s, c);
    tangent[slot] = s / c;
  }
  dvec3 p = dvec3(0.0LF);
  p[root >> 1] = double(face_sign(root));
  p[FACE_U[root]] = double(FACE_U_SIGN[root]) * tangent.x;
  p[FACE_V[root]] = double(FACE_V_SIGN[root]) * tangent.y;
  p *= (v.radius_m + v.bottom_m + double(index.z) * v.cell_height_m) / sqrt(dot(p, p));
  return dvec3(p.xy, p.z / v.z_scale);
}
