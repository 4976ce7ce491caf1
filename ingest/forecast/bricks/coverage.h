#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bricks/shell_chart.h"
#include "forecast/bricks/domain_cells.h"
#include "forecast/bricks/face_polygon.h"

namespace nepho::forecast {

// Which part of a coarse domain's cells finer domains leave to it. Of a piece p of a cell, with
// S(p, n) its solid angle (any additive measure) that none of the domains 0 .. n - 1 covers:
//
//   S(p, 0) = |p|      S(p, n) = |p| - sum over m < n, cells r of domain m, of S(p n r, m)
//
// p n r is convex again, so that nothing is approximated: what the finer domains' own cells cover
// of a square is what is taken out of it, wall by wall, and one weight remains for each place.
class Coverage {
 public:
  // Squares of `cells` a side on each face of the chart.
  Coverage(const ShellChart& chart, const Index3& cells) : chart_(chart), cells_(cells) {}

  // The next coarser domain; `counts` tells which of its cells cover (all where it is empty).
  void add(const HorizontalGrid& grid, double height_m, const std::vector<char>& without_data);
  bool empty() const { return domains_.empty(); }

  // Calls use(polygon, +1 or -1) for pieces that add up to what is left of `piece`, which lies in
  // one square and runs counterclockwise.
  template <class Use>
  void for_each_left(int root, std::uint32_t i, std::uint32_t j, const FacePolygon& piece,
                     Use&& use) const {
    left(key(root, i, j), piece, domains_.size(), 1.0, use);
  }

 private:
  // Cells of one domain on the cube's faces, and which squares they touch.
  struct Domain {
    std::vector<FacePolygon> cells;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> of_square;  // ascending
    std::span<const std::pair<std::uint64_t, std::uint32_t>> at(std::uint64_t square) const;
  };
  static std::uint64_t key(int root, std::uint32_t i, std::uint32_t j) {
    return std::uint64_t(root) << 60 | std::uint64_t(i) << 30 | j;
  }
  template <class Use>
  void left(std::uint64_t square, const FacePolygon& piece, std::size_t finer, double sign,
            Use& use) const {
    use(piece, sign);
    for (std::size_t n = 0; n < finer; ++n)
      for (const auto& [_, cell] : domains_[n].at(square))
        if (const FacePolygon common = piece.within(domains_[n].cells[cell]); common.size >= 3)
          left(square, common, n, -sign, use);
  }

  const ShellChart& chart_;
  Index3 cells_;
  std::vector<Domain> domains_;  // finest first
};

}  // namespace nepho::forecast
