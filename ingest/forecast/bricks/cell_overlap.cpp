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
constexpr double kNothing = 1e-9;  // of a square
constexpr double kA = 0.445948490915965, kB = 0.091576213509771;
constexpr double kWa = 0.223381589678011, kWb = 0.109951743655322;
constexpr std::array<TrianglePoint, 6> kTriangle = {{{1 - 2 * kA, kA, kA, kWa},
                                                     {kA, 1 - 2 * kA, kA, kWa},
                                                     {kA, kA, 1 - 2 * kA, kWa},
                                                     {1 - 2 * kB, kB, kB, kWb},
                                                     {kB, 1 - 2 * kB, kB, kWb},
                                                     {kB, kB, 1 - 2 * kB, kWb}}};

}  // namespace

// One square of the lattice: what falls into it is added up at its four corners.
struct CellOverlap::Square {
  glm::dvec2 origin;
  double density[4];
  double sum[4] = {};

  // Counterclockwise, or clockwise to take away.
  void add(const FacePolygon& piece, double sign) {
    for (int at = 2; at < piece.size; ++at) {
      const glm::dvec2 p0 = piece.corner(0) - origin, p1 = piece.corner(at - 1) - origin,
                       p2 = piece.corner(at) - origin;
      const glm::dvec2 e = p1 - p0, f = p2 - p0;
      const double area = 0.5 * sign * (e.x * f.y - e.y * f.x);
      for (const TrianglePoint& t : kTriangle) {
        const glm::dvec2 p = t.a * p0 + t.b * p1 + t.c * p2;
        const double hat[4] = {(1 - p.x) * (1 - p.y), p.x * (1 - p.y), (1 - p.x) * p.y, p.x * p.y};
        const double here =
            hat[0] * density[0] + hat[1] * density[1] + hat[2] * density[2] + hat[3] * density[3];
        for (int c = 0; c < 4; ++c) sum[c] += t.weight * area * here * hat[c];
      }
    }
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

void for_each_face(const ShellChart& chart, const Index3& cells,
                   const std::array<glm::dvec3, 4>& corners,
                   const std::function<void(int root, const FacePolygon& polygon)>& use) {
  std::array<int, 4> faces;
  std::ranges::transform(corners, faces.begin(), nearest_face);
  const bool one_face = std::ranges::all_of(faces, [&](int face) { return face == faces[0]; });
  for (int root = 0; root < 6; ++root) {
    if (one_face && root != faces[0]) continue;
    // A quadrilateral that leaves a face is followed to 73 degrees from its middle.
    if (std::ranges::any_of(corners,
                            [&](const auto& p) { return !(normal_component(root, p) >= 0.3); }))
      continue;
    FacePolygon quad;
    for (const glm::dvec3& corner : corners) {
      const glm::dvec3 surface_m = {corner.x, corner.y,
                                    corner.z * (chart.body().polar_m / chart.body().equatorial_m)};
      quad.push_back(glm::dvec2(chart.coordinates(root, surface_m)) * double(cells[0]));
    }
    use(root, quad);
  }
}

void CellOverlap::add(const std::array<glm::dvec3, 4>& corners,
                      std::vector<HatShare>& shares) const {
  for_each_face(chart_, cells_, corners,
                [&](int root, const FacePolygon& quad) { add_on_face(root, quad, shares); });
}

void CellOverlap::add_on_face(int root, const FacePolygon& given,
                              std::vector<HatShare>& shares) const {
  FacePolygon quad = given;
  const double area = quad.area();
  if (area == 0) return;
  if (area < 0) std::reverse(quad.point.begin(), quad.point.begin() + quad.size);
  glm::dvec2 low = quad.corner(0), high = low;
  for (int at = 1; at < quad.size; ++at) {
    low = glm::min(low, quad.corner(at));
    high = glm::max(high, quad.corner(at));
  }
  const double n = cells_[0];
  low = glm::max(low, 0.0);
  high = glm::min(high, n);
  for (double i = std::floor(low.x); i < high.x; ++i) {
    const FacePolygon strip = quad.clipped(0, i, +1).clipped(0, i + 1, -1);
    if (strip.size < 3) continue;
    for (double j = std::floor(low.y); j < high.y; ++j) {
      const FacePolygon piece = strip.clipped(1, j, +1).clipped(1, j + 1, -1);
      if (piece.size >= 3) add_square(root, std::uint32_t(i), std::uint32_t(j), piece, shares);
    }
  }
}

void CellOverlap::add_square(int root, std::uint32_t i, std::uint32_t j, const FacePolygon& piece,
                             std::vector<HatShare>& shares) const {
  const double n = cells_[0], step_rad = pi / 2 / n;
  const double u[2] = {equiangular(2 * (i / n) - 1), equiangular(2 * ((i + 1) / n) - 1)};
  const double v[2] = {equiangular(2 * (j / n) - 1), equiangular(2 * ((j + 1) / n) - 1)};
  Square square{{double(i), double(j)}, {}};
  for (int c = 0; c < 4; ++c) square.density[c] = density(u[c & 1], v[c >> 1], step_rad);
  if (finer_ && !finer_->empty()) {
    finer_->for_each_left(root, i, j, piece,
                          [&](const FacePolygon& part, double sign) { square.add(part, sign); });
    // What is wholly covered leaves differences of equal numbers.
    for (int c = 0; c < 4; ++c)
      if (square.sum[c] < kNothing * square.density[c]) square.sum[c] = 0;
  } else {
    square.add(piece, 1);
  }
  for (std::uint32_t c = 0; c < 4; ++c) {
    Column column = {root, i + (c & 1), j + (c >> 1)};
#ifndef NEPHO_MUTANT_SEAM
    if (column.i == 0 || column.i == cells_[0] || column.j == 0 || column.j == cells_[1])
      column = chart_.names(column, cells_).owner();
#endif
    const auto known = std::ranges::find(shares, column, &HatShare::column);
    if (known != shares.end())
      known->solid_angle_sr += square.sum[c];
    else
      shares.push_back({column, square.sum[c]});
  }
}

}  // namespace nepho::forecast
