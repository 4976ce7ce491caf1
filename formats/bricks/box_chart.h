#pragma once

#include "bricks/chart.h"

namespace nepho {

struct Periodic {
  bool x = false, y = false;
};

// An affine box: ecef = origin + edges * q, with the three edge vectors (m) as columns, of any
// angles and handedness; straight rays stay straight. Refuses singular edges.
class BoxChart final : public Chart {
 public:
  BoxChart(glm::dvec3 origin_ecef_m, glm::dmat3 edges_m, Periodic periodic = {});

  ChartKind kind() const override { return ChartKind::kBox; }
  int roots() const override { return 1; }
  glm::dvec3 ecef_m(RootPosition position) const override;
  // q of a periodic axis is wrapped into [0, 1).
  RootPosition locate(glm::dvec3 ecef_m) const override;
  ColumnNames names(Column column, const Index3& cells) const override;
  double hat_horizontal(Column column, const Index3& cells) const override;  // m2
  double hat_vertical(std::uint32_t k, const Index3& cells) const override;  // m
  void check(const Lattice&) const override {}

  const glm::dvec3& origin_m() const { return origin_m_; }
  const glm::dmat3& edges_m() const { return edges_m_; }
  const glm::dmat3& inverse_edges() const { return inverse_; }  // d(ecef) -> d(q), 1/m
  Periodic periodic() const { return periodic_; }

 private:
  glm::dvec3 origin_m_;
  glm::dmat3 edges_m_, inverse_;
  Periodic periodic_;
  double area_m2_, rise_m_;  // |e_x x e_y|, and the height over it
};

}  // namespace nepho
