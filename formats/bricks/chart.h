#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include <glm/glm.hpp>

#include "bricks/lattice.h"

namespace nepho {

struct RootPosition {
  int root = 0;
  glm::dvec3 q{0.0};
};

// The samples that share one (root, i, j) of a level.
struct Column {
  int root = 0;
  std::uint32_t i = 0, j = 0;
  friend constexpr auto operator<=>(const Column&, const Column&) = default;
};

// At most 4: a periodic box has 4 names for its corner column, a cube corner 3, a cube edge 2.
class ColumnNames {
 public:
  void push_back(Column column) { names_[std::size_t(size_++)] = column; }
  const Column* begin() const { return names_.data(); }
  const Column* end() const { return names_.data() + size_; }
  int size() const { return size_; }
  const Column& owner() const { return names_[0]; }

 private:
  std::array<Column, 4> names_{};
  int size_ = 0;
};

enum class ChartKind { kBox, kShell };

// Maps root coordinates q to ECEF metres, and says which columns are one and the same.
class Chart {
 public:
  virtual ~Chart() = default;
  virtual ChartKind kind() const = 0;
  virtual int roots() const = 0;
  virtual glm::dvec3 ecef_m(RootPosition position) const = 0;
  // Inverse of ecef_m. On a shared edge: the lowest root. Not clamped: q outside [0, 1] is outside.
  virtual RootPosition locate(glm::dvec3 ecef_m) const = 0;
  // All names of a column, ascending, whichever of them is asked for; the first is its owner.
  virtual ColumnNames names(Column column, const Index3& cells) const = 0;
  // Integral of the trilinear hat over this root's part of the world, as a product
  // (horizontal * vertical, m3). A hat that reaches over a root's end is summed over its names.
  virtual double hat_horizontal(Column column, const Index3& cells) const = 0;
  virtual double hat_vertical(std::uint32_t k, const Index3& cells) const = 0;
  // Throws where these masks cannot keep neighbouring roots' samples together.
  virtual void check(const Lattice& lattice) const = 0;
};

// Where a source is asked for a sample: the owner's position, whichever name the caller used.
inline glm::dvec3 sample_ecef_m(const Chart& chart, const Lattice& lattice, int root, int level,
                                Index3 global) {
#ifdef NEPHO_MUTANT_SEAM
  const Column owner = {root, global[0], global[1]};
#else
  const Column owner = chart.names({root, global[0], global[1]}, lattice.cells(level)).owner();
#endif
  return chart.ecef_m({owner.root, lattice.q(level, {owner.i, owner.j, global[2]})});
}

}  // namespace nepho
