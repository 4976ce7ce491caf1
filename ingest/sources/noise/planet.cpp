#include "sources/noise/planet.h"

#include <algorithm>
#include <cmath>

#include "sources/noise/lattice_noise.h"
#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

double unit(std::uint32_t bits) {
  return double(bits) / 4294967296.0;
}

// The sign pattern of a vector whose direction is an axis.
glm::dvec3 axis_of(const glm::dvec3& v) {
  const glm::dvec3 m = glm::abs(v);
  glm::dvec3 axis(0.0);
  const int a = m.x > m.y && m.x > m.z ? 0 : m.y > m.z ? 1 : 2;
  axis[a] = v[a] > 0 ? 1 : -1;
  return axis;
}

std::vector<glm::dvec3> icosahedron_vertices() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<glm::dvec3> v;
  for (const double one : {-1.0, 1.0})
    for (const double g : {-golden, golden}) {
      v.push_back({0, one, g});
      v.push_back({one, g, 0});
      v.push_back({g, 0, one});
    }
  for (glm::dvec3& p : v) p = p / std::sqrt(1 + golden * golden);
  return v;
}

}  // namespace

Directions::Directions(const ShellChart& chart) {
  for (int root = 0; root < 6; ++root) {
    const glm::dvec3 middle = chart.to_scaled(chart.ecef_m({root, {0.5, 0.5, 0}}));
    const auto r = std::size_t(root);
    normal_[r] = axis_of(middle);
    const auto side = [&](glm::dvec3 q) {
      const glm::dvec3 p = chart.to_scaled(chart.ecef_m({root, q}));
      return axis_of(p - normal_[r] * glm::dot(p, normal_[r]));
    };
    u_[r] = side({0.75, 0.5, 0}), v_[r] = side({0.5, 0.75, 0});
  }
}

glm::dvec3 Directions::at(Column owner, std::uint32_t cells) const {
  const auto r = std::size_t(owner.root);
  const double u = tan_quarter_turn(2 * (double(owner.i) / cells) - 1);
  const double v = tan_quarter_turn(2 * (double(owner.j) / cells) - 1);
  const glm::dvec3 p = normal_[r] + u * u_[r] + v * v_[r];
  return p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

Sheets::Sheets(double radius_m, double wind_from_rad, std::uint32_t seed) : radius_m_(radius_m) {
  const std::vector<glm::dvec3> vertices = icosahedron_vertices();
  std::vector<glm::dvec3> middles = vertices;
  for (std::size_t a = 0; a < vertices.size(); ++a)
    for (std::size_t b = a + 1; b < vertices.size(); ++b)
      if (glm::dot(vertices[a], vertices[b]) > 0.4)
        middles.push_back(glm::normalize(vertices[a] + vertices[b]));
  // A turn of the whole, so that the sheets' rims lie on no cube face's axis.
  const glm::dvec3 x = {2.0 / 3, -2.0 / 3, 1.0 / 3}, y = {2.0 / 3, 1.0 / 3, -2.0 / 3},
                   z = {1.0 / 3, 2.0 / 3, 2.0 / 3};
  for (std::size_t s = 0; s < middles.size(); ++s) {
    const glm::dvec3 middle = middles[s].x * x + middles[s].y * y + middles[s].z * z;
    const double level = std::sqrt(middle.x * middle.x + middle.y * middle.y);
    const glm::dvec3 east = glm::dvec3{-middle.y, middle.x, 0} / level;
    const glm::dvec3 north = glm::cross(middle, east);
    const double veer = 0.7 * (unit(hash(std::int32_t(s), 1, 0, seed)) - 0.5);
    const glm::dvec2 from = cosine_sine(wind_from_rad + veer);
    const glm::dvec3 along = -(from.x * north + from.y * east);
    sheets_.push_back({middle, along, glm::cross(middle, along)});
  }
}

SheetPoints Sheets::at(const glm::dvec3& direction) const {
  constexpr double kRim = 0.8660254037844386;  // cos 30 deg; no point is beyond 21 deg of a middle
  std::array<double, 42> share;
  double sum = 0;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const double t = std::max(0.0, (glm::dot(direction, sheets_[s].middle) - kRim) / (1 - kRim));
    const double t4 = t * t * t * t;
    share[s] = t4 * t4 * t4;
    sum += share[s];
  }
  SheetPoints points;
  double square = 0;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const double weight = share[s] - 0.05 * sum;  // most of a sheet belongs to it alone
    if (!(weight > 0) || points.size == int(points.point.size())) continue;
    const Sheet& sheet = sheets_[s];
    const double scale = 2 * radius_m_ / (1 + glm::dot(direction, sheet.middle));
    points.point[std::size_t(points.size++)] = {
        int(s),
        weight,
        {scale * glm::dot(direction, sheet.along), scale * glm::dot(direction, sheet.across)}};
    square += weight * weight;
  }
  for (int p = 0; p < points.size; ++p) points.point[std::size_t(p)].weight /= std::sqrt(square);
  return points;
}

Storms::Storms(std::uint32_t seed) {
  for (std::int32_t n = 0; n < 26; ++n) {
    const auto dice = [&](std::int32_t what) { return unit(hash(n, what, 7, seed)); };
    const double hemisphere = n % 2 ? 1 : -1;
    const double z = hemisphere * (0.5 + 0.38 * dice(0));  // 30 to 62 deg
    const glm::dvec2 turn = cosine_sine(6.2831853 * (n / 2 + 0.7 * dice(1)) / 13);
    const double level = std::sqrt(1 - z * z);
    storms_.push_back({{level * turn.x, level * turn.y, z},
                       0.14 + 0.12 * dice(2),
                       hemisphere * (0.9 + 0.9 * dice(3))});
  }
}

glm::dvec3 Storms::wound(glm::dvec3 d) const {
  glm::dvec3 moved = d;
  for (const Storm& storm : storms_) {
    const double chord2 = 2 - 2 * glm::dot(d, storm.middle), reach2 = storm.reach * storm.reach;
    if (chord2 >= reach2) continue;
    const double q = 1 - chord2 / reach2, t = storm.turn * q * q;
    // Rodrigues' rotation by 2 atan t, less the start.
    const double c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
    moved = moved + (c - 1) * d + s * glm::cross(storm.middle, d) +
            (1 - c) * glm::dot(storm.middle, d) * storm.middle;
  }
  return moved;
}

double Storms::stretch(const glm::dvec3& direction, double radius) const {
  // |R - 1| <= 2, and the turn's slope times the distance: 8 |t| x (1 - x) <= 2 |t|.
  double most = 1;
  for (const Storm& storm : storms_) {
    const glm::dvec3 d = direction - storm.middle;
    if (std::sqrt(glm::dot(d, d)) < storm.reach + radius) most += 2 + 2 * std::abs(storm.turn);
  }
  return most;
}

}  // namespace nepho::noise
