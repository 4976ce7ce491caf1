// The passes that fill the light tiles: one invocation a sample.
layout(std430, binding = 5) readonly buffer LitBuffer { LitRecord lit[]; };
// 729 tile + sample, for this pass (gl/light_samples.h). The view pass has its phases at this binding.
layout(std430, binding = 4) restrict readonly buffer SampleBuffer { uint light_samples[]; };

ivec3 lit_sample_index(uint entry) {
  int s = int(entry % 729u);
  return ivec3(s % 9, s / 9 % 9, s / 81);
}

ivec3 lit_texel(int tile, ivec3 sample_index) {
  return ivec3(tile_origin(uint(tile), vec2(LIGHT_ATLAS_SIZE.xy / 9))) + sample_index;
}

// log2 of the size of one of this level's cells, in cells of the finest level.
ivec3 cell_shift(int volume, int level) {
  int word = volumes_in[volume].levels[level];
  return ivec3(word & 255, word >> 8 & 255, word >> 16 & 255);
}

// World position of a finest index of a volume.
dvec3 world_of(int volume, int root, ivec3 index) {
  VolumeData v = volumes_in[volume];
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
#if NEPHO_VOLUMES == 1
  record.volume = 0;
#endif
  ivec3 shift = cell_shift(record.volume, record.level);
  ivec3 index = (8 * ivec3(record.i, record.j, record.k) + sample_index) << shift;
  return world_of(record.volume, record.root, index);
}
