// Every equation, in the order in which they use each other. The one list: GLSL includes it after
// definitions.glsl, C++ once per number type (physics_cpp.h).
//
// The common subset: free functions without state, constants only, no swizzle, no texture, no
// include in the parts; literals are Number(0.5), results OUT(T). PRECISE forbids contraction.
#include "angles.glsl"

#include "air.glsl"
#include "daylight.glsl"
#include "ground.glsl"
#include "octaves.glsl"
#include "phase.glsl"
#include "shell.glsl"
#include "sky.glsl"
#include "tone.glsl"
#include "transport.glsl"
#include "walls.glsl"
