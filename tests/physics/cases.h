#pragma once

#include <array>
#include <span>
#include <vector>

namespace nepho::test {

// One table for all builds of the shared equations: rows of inputs with their truth in extended
// precision. An error is |got - truth| / scale, with scale = |truth| times the condition number of
// the inputs (so that float's rounding of them counts once), or an absolute unit where the claim is
// absolute. scale 0: no such output.
struct Row {
  std::array<double, 6> x{};
  int wall = 0, nearest = 0;
  std::array<double, 3> truth{}, scale{};
};
using Outputs = std::array<double, 3>;

struct Case {
  const char* name;
  int which;                    // of evaluate() in cases.glsl
  double bound_f32, bound_f64;  // relative; f64's is the method's own error
  double bound_gpu;             // GLSL: its exp and pow are weaker
  std::vector<Row> (*rows)();
};
std::span<const Case> cases();

Outputs evaluate_f32(int which, const Row& row);
Outputs evaluate_f64(int which, const Row& row);
Outputs evaluate_dim(int which, const Row& row);

// The largest error over the outputs of a row.
double error_of(const Row& row, const Outputs& got);

}  // namespace nepho::test
