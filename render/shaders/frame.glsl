// Buffers of every pass. NEPHO_VOLUMES and the other switches are defined by the host.
layout(std430, binding = 0) readonly buffer FrameBuffer { FrameData frame; };
layout(std430, binding = 1) readonly buffer VolumeBuffer { VolumeData volumes[]; };
layout(std430, binding = 2) readonly buffer NodeBuffer { NodeRecord nodes[]; };
layout(std430, binding = 3) readonly buffer BrickBuffer { BrickRecord bricks[]; };
#ifdef NEPHO_ICE
layout(std430, binding = 8) readonly buffer IceBuffer { BrickRecord ice_bricks[]; };
#endif

dvec3 vec_of(double a[3]) { return dvec3(a[0], a[1], a[2]); }
vec3 vec_of(float a[3]) { return vec3(a[0], a[1], a[2]); }

bool splits(int volume, int level, int axis) {
  return (volumes[volume].levels[level] >> (24 + axis) & 1) != 0;
}
// log2 of the size of one of this level's cells, in cells of the finest level.
ivec3 cell_shift(int volume, int level) {
  int word = volumes[volume].levels[level];
  return ivec3(word & 255, word >> 8 & 255, word >> 16 & 255);
}
