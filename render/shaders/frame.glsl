// Buffers of every pass. NEPHO_VOLUMES and the other switches are defined by the host.
//
// What all invocations share is copied to variables before anything else: inside loops and branches
// llvmpipe reads storage buffers one lane at a time.
layout(std430, binding = 0) restrict readonly buffer FrameBuffer { FrameData frame_in; };
layout(std430, binding = 1) restrict readonly buffer VolumeBuffer { VolumeData volumes_in[]; };
layout(std430, binding = 2) restrict readonly buffer NodeBuffer { uvec4 nodes[]; };  // NodeRecord
layout(std430, binding = 3) restrict readonly buffer BrickBuffer { vec2 bricks[]; };  // BrickRecord
#ifdef NEPHO_ICE
layout(std430, binding = 8) restrict readonly buffer IceBuffer { vec2 ice_bricks[]; };
#endif

FrameData frame;
VolumeData volumes[NEPHO_VOLUMES];  // indexed by constants only, or all of it goes to memory
struct ShellFloats {
  float cell_rad, per_cell_rad, cell_height_m, per_cell_height_m;
};
ShellFloats shell_floats[NEPHO_VOLUMES];
vec2 atlas_tiles;      // on its first two sides
vec3 per_atlas_texel;  // 1 / size

dvec3 vec_of(double a[3]) { return dvec3(a[0], a[1], a[2]); }
vec3 vec_of(float a[3]) { return vec3(a[0], a[1], a[2]); }

// The first statement of every main().
void load_frame() {
  frame = frame_in;
#define NEPHO_DO(v)                                                              \
  volumes[v] = volumes_in[v];                                                    \
  shell_floats[v].cell_rad = float(volumes[v].cell_rad);                         \
  shell_floats[v].per_cell_rad = float(1.0LF / volumes[v].cell_rad);             \
  shell_floats[v].cell_height_m = float(volumes[v].cell_height_m);               \
  shell_floats[v].per_cell_height_m = float(1.0LF / volumes[v].cell_height_m);
  NEPHO_EACH_VOLUME
#undef NEPHO_DO
  ivec3 size = textureSize(atlas, 0);
  atlas_tiles = vec2(size.xy / 9);
  per_atlas_texel = 1.0 / vec3(size);
}
