#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "reference/chart_ray.h"
#include "reference/level_set.h"
#include "tree/light_tiles.h"

namespace nepho {

// One volume along one ray, piece by piece: a cell of a leaf, or the whole of an empty or constant
// one. Inside a piece, extinction is smooth: in a box a cubic, exact by Simpson.
class VolumeWalk {
 public:
  // `whole_constants`: a constant leaf is one piece, otherwise one per cell (for its source). Such
  // walks go towards a light: a level one through a periodic layer ends, `endless`, after 8
  // periods.
  VolumeWalk(const LevelSet& levels, std::size_t volume, const Ray& ray, double t_max_m,
             bool whole_constants);

  // Moves to the next piece; false where the volume ends. Throws std::logic_error after more
  // pieces than any lattice can have: a bug, never a picture that hangs.
  bool next();

  double t0_m() const { return t0_m_; }
  double t1_m() const { return t1_m_; }
  // kBrick where the field is the source's own, but for empty nodes.
  NodeKind kind() const {
    return own_field_ && leaf_.kind != NodeKind::kEmpty ? NodeKind::kBrick : leaf_.kind;
  }
  double extinction_per_m(double t_m) const;  // t inside the piece
  // Part of it that is ice, 0 .. 1: where extinction goes to 0, the whole brick's (as the
  // renderer's).
  double ice_part(double t_m) const;
  // Light of the picture's tiles: optical depth towards the sun, sky visible above, aside, below
  // (1 where the tiles do not tell).
  glm::dvec4 light(const LightTiles& tiles, double t_m) const;
  int sub_steps(double length_m) const;  // Simpson's, for such a length of it
  std::size_t pieces() const { return pieces_; }
  bool endless() const { return endless_; }
  int root() const { return leaf_root_; }                  // of the piece
  const ChartRay::Block& block() const { return block_; }  // its walls, in finest cells

 private:
  bool in_leaf() const;
  void find_leaf();
  void load_corners();
  glm::dvec3 fraction(double t_m) const;  // of the piece's cell
  double interpolated(const std::array<double, 8>& corners, double t_m) const;
  double brick_extinction_per_m(double t_m) const;
  double own_extinction_per_m(double t_m) const;

  const LevelSet& levels_;
  std::size_t volume_;
  std::unique_ptr<ChartRay> ray_;
  bool whole_constants_;
  int steps_;  // in a cell, at least
  bool own_field_, noisy_;
  ChartRay::Start start_;
  int root_ = 0;
  ChartRay::Cell cell_{};  // finest cell that the next piece begins in
  bool endless_ = false, done_ = false, found_ = false;
  LevelLeaf leaf_;
  int leaf_root_ = 0;
  ChartRay::Block node_{}, block_{};
  std::array<int, 3> size_bits_{};                   // log2 of finest cells in one of the leaf's
  Index3 sample_{};                                  // of the piece's first corner, in its leaf
  ChartRay::Cell period_{};                          // finest cells before the leaf's own period
  std::array<double, 8> corners_{}, ice_corners_{};  // the second where the brick has ice
  double t0_m_ = 0, t1_m_ = 0, resume_m_ = 0;
  // Where the ray is at an end of the piece, in finest cells of leaf_root_: most values are asked
  // for there.
  struct Known {
    double t_m = -1;
    int root = 0;
    glm::dvec3 at{0.0};
  };
  Known begin_, end_;
  glm::dvec3 cells_at(double t_m) const;
  std::size_t pieces_ = 0;
};

}  // namespace nepho
