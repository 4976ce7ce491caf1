#include "bricks/shell_chart.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace nepho {
namespace {

using std::numbers::pi;

struct SignedAxis {
  int axis, sign;
};
struct FaceFrame {
  SignedAxis normal, u, v;  // u x v = normal
};
constexpr std::array<FaceFrame, 6> kFaces = {{{{0, +1}, {1, +1}, {2, +1}},
                                              {{0, -1}, {1, -1}, {2, +1}},
                                              {{1, +1}, {0, -1}, {2, +1}},
                                              {{1, -1}, {0, +1}, {2, +1}},
                                              {{2, +1}, {0, +1}, {1, +1}},
                                              {{2, -1}, {0, +1}, {1, -1}}}};

template <class Component>
Component along(const std::array<Component, 3>& p, SignedAxis a) {
  return Component(a.sign) * p[std::size_t(a.axis)];
}
template <class Component>
void set_along(std::array<Component, 3>& p, SignedAxis a, Component value) {
  p[std::size_t(a.axis)] = Component(a.sign) * value;
}

// Gauss-Legendre on [0, 1]. 5 points: 1e-13 of a hat's integral even on the widest cells (11 deg).
// On finer lattices fewer do as well, to rounding: 3 from 256 cells a face on, 2 from 4096.
struct GaussRule {
  std::array<double, 5> node, weight;
  std::size_t size;
};
constexpr GaussRule kFivePoints = {
    {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155, 0.953089922969332},
    {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
     0.11846344252809454},
    5};
constexpr GaussRule kThreePoints = {{0.11270166537925831, 0.5, 0.88729833462074169},
                                    {0.27777777777777778, 0.44444444444444444, 0.27777777777777778},
                                    3};
constexpr GaussRule kTwoPoints = {{0.21132486540518712, 0.78867513459481288}, {0.5, 0.5}, 2};

const GaussRule& gauss_rule(std::uint32_t cells) {
  return cells < 256 ? kFivePoints : cells < 4096 ? kThreePoints : kTwoPoints;
}

struct HatPoint {
  double tangent, weight;
};
// Quadrature of one face coordinate's hat, cut at the face's ends.
struct HatLine {
  std::array<HatPoint, 10> points;
  int size = 0;
};
HatLine hat_line(std::uint32_t index, std::uint32_t cells) {
  const GaussRule& rule = gauss_rule(cells);
  HatLine line;
  for (const int side : {-1, +1}) {
    if (side < 0 ? index == 0 : index == cells) continue;
    for (std::size_t p = 0; p < rule.size; ++p) {
      const double s = 2 * (index + side * rule.node[p]) / cells - 1;
      line.points[std::size_t(line.size++)] = {std::tan(pi / 4 * s),
                                               rule.weight[p] * (1 - rule.node[p])};
    }
  }
  return line;
}

// The lines of a node's 9 x 9 columns are asked for again and again, and tangents are dear.
const HatLine& remembered_hat_line(std::uint32_t index, std::uint32_t cells) {
  struct Known {
    std::uint32_t index = 0, cells = 0;
    HatLine line;
  };
  static thread_local std::array<Known, 32> all;
  Known& known = all[index % all.size()];
  if (known.index != index || known.cells != cells) known = {index, cells, hat_line(index, cells)};
  return known.line;
}

}  // namespace

double equiangular(double s) {
#ifdef NEPHO_MUTANT_SEAM
  return std::tan(pi / 4 * s);
#endif
  const double magnitude = std::abs(s);
  return std::copysign(magnitude == 1 ? 1.0 : std::tan(pi / 4 * magnitude), s);
}

ShellChart::ShellChart(Ellipsoid body, double bottom_m, double top_m)
    : body_(body), bottom_m_(bottom_m), thickness_m_(top_m - bottom_m) {
  if (!(thickness_m_ > 0)) throw std::invalid_argument("ShellChart: top is not above bottom");
}

glm::dvec3 ShellChart::to_scaled(glm::dvec3 ecef_m) const {
  return {ecef_m.x, ecef_m.y, ecef_m.z * (body_.equatorial_m / body_.polar_m)};
}

glm::dvec3 ShellChart::ecef_m(RootPosition position) const {
  const FaceFrame& face = kFaces[std::size_t(position.root)];
  std::array<double, 3> p{};
  set_along(p, face.normal, 1.0);
  set_along(p, face.u, equiangular(2 * position.q.x - 1));
  set_along(p, face.v, equiangular(2 * position.q.y - 1));
  // The norm sums x, y, z in this order on every face: with the odd, exact equiangular() the faces
  // that share a sample then agree bit for bit.
  const double norm = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  const double radius_m = body_.equatorial_m + (bottom_m_ + position.q.z * thickness_m_);
  const double scale = radius_m / norm;
  return {scale * p[0], scale * p[1], scale * p[2] * (body_.polar_m / body_.equatorial_m)};
}

RootPosition ShellChart::locate(glm::dvec3 ecef_m) const {
  const glm::dvec3 scaled = to_scaled(ecef_m);
  const std::array<double, 3> p = {scaled.x, scaled.y, scaled.z};
  std::size_t root = 0;
  for (std::size_t f = 1; f < kFaces.size(); ++f)
    if (along(p, kFaces[f].normal) > along(p, kFaces[root].normal)) root = f;
  return {int(root), coordinates(int(root), ecef_m)};
}

glm::dvec3 ShellChart::coordinates(int root, glm::dvec3 ecef_m) const {
  const glm::dvec3 scaled = to_scaled(ecef_m);
  const std::array<double, 3> p = {scaled.x, scaled.y, scaled.z};
  const FaceFrame& face = kFaces[std::size_t(root)];
  const auto coordinate = [&](SignedAxis a) {
    return 0.5 + std::atan(along(p, a) / along(p, face.normal)) * (2 / pi);
  };
  const double altitude_m = glm::length(scaled) - body_.equatorial_m;
  return {coordinate(face.u), coordinate(face.v), (altitude_m - bottom_m_) / thickness_m_};
}

ColumnNames ShellChart::names(Column column, const Index3& cells) const {
  // The column as an integer point on the cube [-n, n]^3: it lies on each face whose wall it
  // touches.
  const std::int64_t n = cells[0];
  const FaceFrame& own = kFaces[std::size_t(column.root)];
  std::array<std::int64_t, 3> p{};
  set_along(p, own.normal, n);
  set_along(p, own.u, 2 * std::int64_t(column.i) - n);
  set_along(p, own.v, 2 * std::int64_t(column.j) - n);
  ColumnNames names;
  for (std::size_t f = 0; f < kFaces.size(); ++f)
    if (along(p, kFaces[f].normal) == n)
      names.push_back({int(f), std::uint32_t((along(p, kFaces[f].u) + n) / 2),
                       std::uint32_t((along(p, kFaces[f].v) + n) / 2)});
  return names;
}

double ShellChart::hat_horizontal(Column column, const Index3& cells) const {
  const HatLine u = remembered_hat_line(column.i, cells[0]);
  const HatLine& v = remembered_hat_line(column.j, cells[1]);
  double sum = 0;
  for (int a = 0; a < u.size; ++a)
    for (int b = 0; b < v.size; ++b) {
      const auto [x, wx] = u.points[std::size_t(a)];
      const auto [y, wy] = v.points[std::size_t(b)];
      const double s = 1 + x * x + y * y;
      sum += wx * wy * (1 + x * x) * (1 + y * y) / (s * std::sqrt(s));
    }
  return sum * (pi / 2 / cells[0]) * (pi / 2 / cells[1]);
}

double ShellChart::hat_vertical(std::uint32_t k, const Index3& cells) const {
  const double h = thickness_m_ / cells[2];
  const double r = body_.equatorial_m + (bottom_m_ + k * h);
  double sum = 0;
  if (k > 0) sum += r * r / 2 - r * h / 3 + h * h / 12;
  if (k < cells[2]) sum += r * r / 2 + r * h / 3 + h * h / 12;
  return sum * h * (body_.polar_m / body_.equatorial_m);
}

void ShellChart::check(const Lattice& lattice) const {
  for (int level = 0; level <= lattice.max_level(); ++level)
    if (lattice.cells(level)[0] != lattice.cells(level)[1])
      throw std::invalid_argument("ShellChart: x and y must split together, faces meet in turn");
}

glm::dvec3 geodetic_to_ecef_m(const Ellipsoid& body, double latitude_rad, double longitude_rad,
                              double height_m) {
  const double a = body.equatorial_m, b = body.polar_m;
  const double s = std::sin(latitude_rad), c = std::cos(latitude_rad);
  const double n = a * a / std::hypot(a * c, b * s);
  const double p = (n + height_m) * c;
  return {p * std::cos(longitude_rad), p * std::sin(longitude_rad),
          (n * (b / a) * (b / a) + height_m) * s};
}

double geodetic_height_m(const Ellipsoid& body, glm::dvec3 ecef_m) {
  // On the ellipsoid of latitude phi, r'^2 - a^2 = 2 N h + A h^2 exactly. The latitude is that of
  // the surface point in the same scaled direction: wrong by e^2 h/a, which N hardly feels.
  const double a = body.equatorial_m, ratio = a / body.polar_m;
  const double p = std::hypot(ecef_m.x, ecef_m.y), z = ecef_m.z * ratio;
  const double excess = (std::hypot(p, z) - a) * (std::hypot(p, z) + a);
  const double s = ratio * z / std::hypot(p, ratio * z), s2 = s * s;
  const double n = a / std::sqrt(1 - (1 - 1 / (ratio * ratio)) * s2);
  const double A = 1 + (ratio * ratio - 1) * s2;
  return excess / (n + std::sqrt(n * n + A * excess));
}

}  // namespace nepho
