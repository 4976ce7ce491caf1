// The passes that fill the light tiles: one invocation a sample.
layout(std430, binding = 5) readonly buffer LitBuffer { LitRecord lit[]; };
uniform int first_tile;

ivec3 lit_texel(int tile, ivec3 sample_index) {
  return ivec3(tile_origin(uint(tile), LIGHT_ATLAS_SIZE)) + sample_index;
}

// World position of a finest index of a volume.
dvec3 world_of(int volume, int root, ivec3 index) {
  VolumeData v = volumes[volume];
#ifdef NEPHO_SHELL
  if (is_shell(volume)) return shell_world_of(volume, root, index);
#endif
  dvec3 p = vec_of(v.origin_m);
  for (int axis = 0; axis < 3; ++axis)
    p += double(index[axis]) * dvec3(v.from_cells[3 * axis], v.from_cells[3 * axis + 1], v.from_cells[3 * axis + 2]);
  return p;
}
dvec3 lit_world(int tile, ivec3 sample_index) {
  LitRecord record = lit[tile];
  ivec3 shift = cell_shift(record.volume, record.level);
  ivec3 index = (8 * ivec3(record.i, record.j, record.k) + sample_index) << shift;
  return world_of(record.volume, record.root, index);
}
