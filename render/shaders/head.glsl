// What every pass begins with; the host puts its #defines right after #version.
#include "definitions.glsl"
#include "physics.glsl"
#include "frame.layout.h"
#include "frame.glsl"
