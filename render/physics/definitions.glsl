// What the shared equations mean in GLSL: every quantity is a float. Include before physics.glsl.
// (C++: physics_cpp.h.) SI units; radiance per nm; angles in rad.
#define Number float
#define Length float
#define Area float
#define InverseLength float
#define SolidAngle float
#define InverseSolidAngle float
#define Radiance float
#define Irradiance float
#define Emission float
#define OUT(T) out T
#define PRECISE precise

// 2^ceil(24 / 2) + 1: splits a float into two halves whose products are exact.
const Number dekker_splitter = Number(4097.0);
