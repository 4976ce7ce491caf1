#include <algorithm>
#include <cmath>

#include "cases.h"
#include "physics/physics_cpp.h"

#define OUT(T) T&
#pragma GCC diagnostic ignored "-Wunused-function"
namespace nepho::f32 {
namespace {
#include "cases.glsl"
}
}  // namespace nepho::f32
namespace nepho::f64 {
namespace {
#include "cases.glsl"
}
}  // namespace nepho::f64
namespace nepho::dim {
namespace {
#include "cases.glsl"
}
}  // namespace nepho::dim
#undef OUT

namespace nepho::test {

Outputs evaluate_f32(int which, const Row& row) {
  std::array<float, 6> x;
  std::transform(row.x.begin(), row.x.end(), x.begin(), [](double v) { return float(v); });
  std::array<float, 3> y;
  f32::evaluate(which, x[0], x[1], x[2], x[3], x[4], x[5], row.wall, row.nearest, y[0], y[1], y[2]);
  return {y[0], y[1], y[2]};
}

Outputs evaluate_f64(int which, const Row& row) {
  const auto& x = row.x;
  Outputs y;
  f64::evaluate(which, x[0], x[1], x[2], x[3], x[4], x[5], row.wall, row.nearest, y[0], y[1], y[2]);
  return y;
}

Outputs evaluate_dim(int which, const Row& row) {
  using dim::Number;
  const auto& x = row.x;
  Number y0, y1, y2;
  dim::evaluate(which, Number(x[0]), Number(x[1]), Number(x[2]), Number(x[3]), Number(x[4]),
                Number(x[5]), row.wall, row.nearest, y0, y1, y2);
  return {y0.value, y1.value, y2.value};
}

double error_of(const Row& row, const Outputs& got) {
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (row.scale[i] == 0) continue;
    const double error = std::abs(got[i] - row.truth[i]) / row.scale[i];
    worst = error <= worst ? worst : error;  // a NaN must not pass
    if (std::isnan(error)) return error;
  }
  return worst;
}

}  // namespace nepho::test
