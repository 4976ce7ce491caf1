#include "forecast/bricks/cell_overlap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nepho::forecast {
namespace {

using std::numbers::pi;

// Normal and axes of each face, as ShellChart has them (+x -x +y -y +z -z).
double normal_component(int root, const glm::dvec3& p) {
  const double value = p[root / 2];
  return root % 2 ? -value : value;
}

int nearest_face(const glm::dvec3& p) {
  int best = 0;
  for (int root = 1; root < 6; ++root)
    if (normal_component(root, p) > normal_component(best, p)) best = root;
  return best;
}

// Solid angle per unit of lattice area at a lattice point.
double density(double tan_u, double tan_v, double step_rad) {
  const double s = 1 + tan_u * tan_u + tan_v * tan_v;
  return step_rad * step_rad * (1 + tan_u * tan_u) * (1 + tan_v * tan_v) / (s * std::sqrt(s));
}

// Degree 4, 6 points (Dunavant 1985, doi:10.1002/nme.1620210612): weights add to 1.
struct TrianglePoint {
  double a, b, c, weight;
};
constexpr double kA = 0.445948490915965, kB = 0.091576213509771;
constexpr double kWa = 0.223381589678011, kWb = 0.109951743655322;
constexpr std::array<TrianglePoint, 6> kTriangle = {{{1 - 2 * kA, kA, kA, kWa},
                                                     {kA, 1 - 2 * kA, kA, kWa},
                                                     {kA, kA, 1 - 2 * kA, kWa},
                                                     {1 - 2 * kB, kB, kB, kWb},
                                                     {kB, 1 - 2 * kB, kB, kWb},
                                                     {kB, kB, 1 - 2 * kB, kWb}}};

}  // namespace

// Convex, or nearly: a quadrilateral cut by four lines has at most 8 corners.
struct CellOverlap::Polygon {
  std::array<glm::dvec2, 12> point;
  int size = 0;

  void push_back(glm::dvec2 p) {
    if (size < int(point.size())) point[std::size_t(size++)] = p;
  }
  double area() const {  // signed, twice
    double sum = 0;
    for (int at = 2; at < size; ++at) {
      const glm::dvec2 u = point[std::size_t(at - 1)] - point[0],
                       v = point[std::size_t(at)] - point[0];
      sum += u.x * v.y - u.y * v.x;
    }
    return sum;
  }
  // The part with point[axis] * side >= limit * side (Sutherland and Hodgman 1974).
  Polygon clipped(int axis, double limit, double side) const {
    Polygon part;
    for (int at = 0; at < size; ++at) {
      const glm::dvec2 &p = point[std::size_t(at)], &q = point[std::size_t((at + 1) % size)];
      const double dp = (p[axis] - limit) * side, dq = (q[axis] - limit) * side;
      if (dp >= 0) part.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
        glm::dvec2 cut = p + (q - p) * (dp / (dp - dq));
        cut[axis] = limit;
        part.push_back(cut);
      }
    }
    return part;
  }
};

glm::dvec3 scaled_direction(const Ellipsoid& body, glm::dvec2 lat_lon_deg, double height_m) {
  const double degree = pi / 180;
#ifdef NEPHO_MUTANT_SHIFT180
  lat_lon_deg.y += 180;
#endif
  const glm::dvec3 p = geodetic_to_ecef_m(body, lat_lon_deg.x * degree,
                                          std::remainder(lat_lon_deg.y, 360.0) * degree, height_m);
  return glm::normalize(glm::dvec3(p.x, p.y, p.z * (body.equatorial_m / body.polar_m)));
}

void CellOverlap::add(const std::array<glm::dvec3, 4>& corners,
                      std::vector<HatShare>& shares) const {
  std::array<int, 4> faces;
  std::ranges::transform(corners, faces.begin(), nearest_face);
  const bool one_face = std::ranges::all_of(faces, [&](int face) { return face == faces[0]; });
  for (int root = 0; root < 6; ++root) {
    if (one_face && root != faces[0]) continue;
    // A quadrilateral that leaves a face is followed to 73 degrees from its middle.
    if (std::ranges::any_of(corners,
                            [&](const auto& p) { return normal_component(root, p) < 0.3; }))
      continue;
    Polygon quad;
    for (const glm::dvec3& corner : corners) {
      const glm::dvec3 surface_m = {
          corner.x, corner.y, corner.z * (chart_.body().polar_m / chart_.body().equatorial_m)};
      quad.push_back(glm::dvec2(chart_.coordinates(root, surface_m)) * double(cells_[0]));
    }
    add_on_face(root, quad, shares);
  }
}

void CellOverlap::add_on_face(int root, const Polygon& quad, std::vector<HatShare>& shares) const {
  const double area = quad.area();
  if (area == 0) return;
  glm::dvec2 low = quad.point[0], high = low;
  for (int at = 1; at < quad.size; ++at) {
    low = glm::min(low, quad.point[std::size_t(at)]);
    high = glm::max(high, quad.point[std::size_t(at)]);
  }
  const double n = cells_[0];
  low = glm::max(low, 0.0);
  high = glm::min(high, n);
  for (double i = std::floor(low.x); i < high.x; ++i) {
    const Polygon strip = quad.clipped(0, i, +1).clipped(0, i + 1, -1);
    if (strip.size < 3) continue;
    for (double j = std::floor(low.y); j < high.y; ++j) {
      const Polygon piece = strip.clipped(1, j, +1).clipped(1, j + 1, -1);
      if (piece.size >= 3)
        add_square(root, std::uint32_t(i), std::uint32_t(j), piece, area > 0 ? 1 : -1, shares);
    }
  }
}

void CellOverlap::add_square(int root, std::uint32_t i, std::uint32_t j, const Polygon& piece,
                             double sign, std::vector<HatShare>& shares) const {
  const double n = cells_[0], step_rad = pi / 2 / n;
  const double u[2] = {equiangular(2 * (i / n) - 1), equiangular(2 * ((i + 1) / n) - 1)};
  const double v[2] = {equiangular(2 * (j / n) - 1), equiangular(2 * ((j + 1) / n) - 1)};
  double corner[4], sum[4] = {};
  for (int c = 0; c < 4; ++c) corner[c] = density(u[c & 1], v[c >> 1], step_rad);
  const glm::dvec2 origin = {double(i), double(j)};
  for (int at = 2; at < piece.size; ++at) {
    const glm::dvec2 p0 = piece.point[0] - origin, p1 = piece.point[std::size_t(at - 1)] - origin,
                     p2 = piece.point[std::size_t(at)] - origin;
    const glm::dvec2 e = p1 - p0, f = p2 - p0;
    const double area = 0.5 * sign * (e.x * f.y - e.y * f.x);
    for (const TrianglePoint& t : kTriangle) {
      const glm::dvec2 p = t.a * p0 + t.b * p1 + t.c * p2;
      const double hat[4] = {(1 - p.x) * (1 - p.y), p.x * (1 - p.y), (1 - p.x) * p.y, p.x * p.y};
      const double here =
          hat[0] * corner[0] + hat[1] * corner[1] + hat[2] * corner[2] + hat[3] * corner[3];
      for (int c = 0; c < 4; ++c) sum[c] += t.weight * area * here * hat[c];
    }
  }
  for (std::uint32_t c = 0; c < 4; ++c) {
    Column column = {root, i + (c & 1), j + (c >> 1)};
#ifndef NEPHO_MUTANT_SEAM
    if (column.i == 0 || column.i == cells_[0] || column.j == 0 || column.j == cells_[1])
      column = chart_.names(column, cells_).owner();
#endif
    const auto known = std::ranges::find(shares, column, &HatShare::column);
    if (known != shares.end())
      known->solid_angle_sr += sum[c];
    else
      shares.push_back({column, sum[c]});
  }
}

}  // namespace nepho::forecast
