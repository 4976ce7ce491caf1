#include "bricks/box_chart.h"

#include <cmath>
#include <stdexcept>

namespace nepho {
namespace {

// Length of a hat in cells: a root's end keeps half of it.
double hat_cells(std::uint32_t index, std::uint32_t cells) {
  return index == 0 || index == cells ? 0.5 : 1.0;
}

// Into [0, 1): a hair below 0 is rounded up to 1, which is 0 again.
double wrapped(double q) {
  const double fraction = q - std::floor(q);
  return fraction < 1 ? fraction : 0.0;
}

struct Ends {
  std::array<std::uint32_t, 2> index;
  int size;
};
Ends same_index(std::uint32_t index, std::uint32_t cells, bool periodic) {
  if (periodic && (index == 0 || index == cells)) return {{0, cells}, 2};
  return {{index, 0}, 1};
}

}  // namespace

BoxChart::BoxChart(glm::dvec3 origin_ecef_m, glm::dmat3 edges_m, Periodic periodic)
    : origin_m_(origin_ecef_m), edges_m_(edges_m), periodic_(periodic) {
  const double volume_m3 = std::abs(glm::determinant(edges_m));
  const double lengths_m3 =
      glm::length(edges_m[0]) * glm::length(edges_m[1]) * glm::length(edges_m[2]);
  if (!(volume_m3 > 1e-9 * lengths_m3) || !std::isfinite(lengths_m3))
    throw std::invalid_argument("BoxChart: the edge vectors do not span a volume");
  if (!std::isfinite(origin_m_.x + origin_m_.y + origin_m_.z))
    throw std::invalid_argument("BoxChart: the origin is not finite");
  inverse_ = glm::inverse(edges_m);
  area_m2_ = glm::length(glm::cross(edges_m[0], edges_m[1]));
  rise_m_ = volume_m3 / area_m2_;
}

glm::dvec3 BoxChart::ecef_m(RootPosition position) const {
  const glm::dvec3 q = position.q;
  return origin_m_ + (q.x * edges_m_[0] + q.y * edges_m_[1] + q.z * edges_m_[2]);
}

RootPosition BoxChart::locate(glm::dvec3 ecef_m) const {
  glm::dvec3 q = inverse_ * (ecef_m - origin_m_);
  if (periodic_.x) q.x = wrapped(q.x);
  if (periodic_.y) q.y = wrapped(q.y);
  return {0, q};
}

ColumnNames BoxChart::names(Column column, const Index3& cells) const {
  const Ends i = same_index(column.i, cells[0], periodic_.x);
  const Ends j = same_index(column.j, cells[1], periodic_.y);
  ColumnNames names;
  for (int a = 0; a < i.size; ++a)
    for (int b = 0; b < j.size; ++b)
      names.push_back({0, i.index[std::size_t(a)], j.index[std::size_t(b)]});
  return names;
}

double BoxChart::hat_horizontal(Column column, const Index3& cells) const {
  return hat_cells(column.i, cells[0]) * hat_cells(column.j, cells[1]) *
         (area_m2_ / cells[0] / cells[1]);
}

double BoxChart::hat_vertical(std::uint32_t k, const Index3& cells) const {
  return hat_cells(k, cells[2]) * (rise_m_ / cells[2]);
}

}  // namespace nepho
