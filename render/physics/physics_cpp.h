#pragma once

#include <algorithm>
#include <cmath>

#include "units/quantity.h"

// The shared equations as C++: nepho::f32 (the GPU's arithmetic), nepho::f64 and nepho::dim, where
// a wrong unit does not compile. Include it in sources only: the functions are local to each.

#define OUT(T) T&
#define PRECISE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

#define NEPHO_PHYSICS_SCALAR(T) \
  using Number = T;             \
  using Length = T;             \
  using Area = T;               \
  using InverseLength = T;      \
  using SolidAngle = T;         \
  using InverseSolidAngle = T;  \
  using Radiance = T;           \
  using Irradiance = T;         \
  using Emission = T;           \
  using std::abs;               \
  using std::ceil;              \
  using std::exp;               \
  using std::max;               \
  using std::min;               \
  using std::pow;               \
  using std::sqrt;

namespace nepho::f32 {
namespace {
NEPHO_PHYSICS_SCALAR(float)
const Number dekker_splitter = Number(4097.0);  // 2^12 + 1
#include "physics/physics.glsl"
}  // namespace
}  // namespace nepho::f32

namespace nepho::f64 {
namespace {
NEPHO_PHYSICS_SCALAR(double)
const Number dekker_splitter = Number(134217729.0);  // 2^27 + 1
#include "physics/physics.glsl"
}  // namespace
}  // namespace nepho::f64

namespace nepho::dim {
namespace {
using Number = Quantity<0, 0, 0>;
using Length = Quantity<1, 0, 0>;
using Area = Quantity<2, 0, 0>;
using InverseLength = Quantity<-1, 0, 0>;
using Radiance = Quantity<0, 1, 0>;
using SolidAngle = Quantity<0, 0, 1>;
using InverseSolidAngle = Quantity<0, 0, -1>;
using Irradiance = Quantity<0, 1, 1>;
using Emission = Quantity<-1, 1, 0>;
const Number dekker_splitter = Number(134217729.0);
#include "physics/physics.glsl"
}  // namespace
}  // namespace nepho::dim

#pragma GCC diagnostic pop
#undef NEPHO_PHYSICS_SCALAR
#undef OUT
#undef PRECISE
