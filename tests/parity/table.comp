#version 450 core
// The rows of tests/physics/cases.cpp through the shared equations, one row an invocation.
// Apart, or clang-format would sort them.
#include "definitions.glsl"

#include "physics.glsl"

#include "cases.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Inputs {
  float inputs[];
};  // 6 per row
layout(std430, binding = 1) readonly buffer Indices {
  int indices[];
};  // which, wall, nearest
layout(std430, binding = 2) writeonly buffer Results {
  float results[];
};  // 3 per row
uniform uint rows;

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= rows) return;
  uint at = 6u * row;
  float y0;
  float y1;
  float y2;
  evaluate(indices[3u * row], inputs[at], inputs[at + 1u], inputs[at + 2u], inputs[at + 3u],
           inputs[at + 4u], inputs[at + 5u], indices[3u * row + 1u], indices[3u * row + 2u], y0, y1,
           y2);
  results[3u * row] = y0;
  results[3u * row + 1u] = y1;
  results[3u * row + 2u] = y2;
}
