#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "bricks/lattice.h"
#include "bricks/shell_chart.h"
#include "forecast/bricks/coverage.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// What fills a model's layers:
//   smooth    parabolas that keep each layer's optical depth (layer_profile.h); clear layers count
//             as 0
//   constant  the file's own steps: layers thicker than voxels show as terraces
enum class Layers { kSmooth, kConstant };

struct RemapOptions {
  // The lowest layer is continued downwards by this much (m): hats at the ground reach two voxels
  // below it, and would mix in nothing (lattice.md 7).
  double extend_below_m = 0;
  // Layers thinner than this (1/m) count as clear: 1e-9 is an optical depth of 1e-4 in 100 km. 0
  // keeps all.
  double clear_below_per_m = 1e-9;
  Layers layers = Layers::kSmooth;
};

// One of the domains that are drawn together, finest first: of a coarser one only that is taken
// which no finer one covers (coverage.h).
struct HatDomain {
  const HorizontalGrid& grid;
  const ForecastColumns& columns;
};

// Hat means of a model's cell means at the finest level of a ShellChart (lattice.md 2):
//
//   c_g = sum over cells W(cell, g) sum over layers w(layer, k) / (V_h V_v)
//
// W by CellOverlap, w = int beta Lambda_k r^2 dr by VerticalHats, V from the chart. Columns are
// vertical along the ellipsoid's normal, hats along the scaled radius: they part by 0.34 % of the
// height difference from the middle of the clouds (17 m at 5 km). Cells without cloud cost nothing.
//
//   sample column -> taps (cell, W / V_h)      sparse rows, float weights
//   cell -> w / V_v for k in a range      float
//
// The same bits for any number of threads. Memory: 8 bytes per tap, 4 (8 with ice) per cell and
// voxel height between its lowest and highest cloud.
class HatRemap {
 public:
  HatRemap(std::shared_ptr<const ShellChart> chart, const Lattice& lattice,
           std::span<const HatDomain> domains, const RemapOptions& options);
  // One domain.
  HatRemap(std::shared_ptr<const ShellChart> chart, const Lattice& lattice,
           const HorizontalGrid& grid, const ForecastColumns& columns, const RemapOptions& options);

  enum class Part { kTotal, kIce };
  // Finest nodes whose closed samples are not all zero, ascending.
  std::vector<NodeKey> nodes(Part part) const;
  // 9^3 samples of any finest node, x fastest, 1/m. Thread-safe.
  void samples(NodeKey key, Part part, double* samples) const;
  // The trilinear field of the samples at a point of the world; 0 outside the shell.
  double interpolated(const glm::dvec3& ecef_m, Part part) const;
  const Lattice& lattice() const { return lattice_; }
  std::uint64_t bytes() const;
  std::size_t sample_columns() const { return row_begin_.empty() ? 0 : row_begin_.size() - 1; }
  bool has_ice() const { return !hats_[1].empty(); }

 private:
  struct CellRange {
    std::uint32_t first = 0, count = 0;  // samples k of the chart
    std::uint64_t at = 0;                // of the first in hats_
  };
  struct Tap {
    std::uint32_t cell;  // of all domains, one after the other
    float weight;
  };
  struct Entry {
    Column column;
    std::uint32_t cell;
    double solid_angle_sr;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.column != b.column ? a.column < b.column : a.cell < b.cell;
    }
  };
  static constexpr std::uint32_t kNoRow = 0xffffffff;
  using Tile = std::array<std::uint32_t, kBrickSamples * kBrickSamples>;  // rows of its columns

  struct CloudHeights;
  void remap_columns(std::span<const HatDomain> domains, const RemapOptions& options);
  void remap_domain(const HatDomain& domain, std::size_t first, const RemapOptions& options,
                    CloudHeights& heights);
  void overlap_domain(const HatDomain& domain, std::size_t first, const Coverage& finer,
                      std::vector<Entry>& entries) const;
  void overlap_cells(std::span<const HatDomain> domains);
  void list_tiles(const std::vector<Column>& rows);
  const Tile* tile(NodeKey key) const;
  double value(std::uint32_t row, std::uint32_t k, const std::vector<float>& hats) const;

  std::shared_ptr<const ShellChart> chart_;
  Lattice lattice_;
  int level_;
  Index3 cells_;
  double reference_height_m_ = 0;  // where the columns' walls are
  std::vector<CellRange> ranges_;
  std::array<std::vector<float>, 2> hats_;  // total, ice
  std::vector<std::uint32_t> row_begin_;
  std::vector<Tap> taps_;
  std::vector<std::uint64_t> tile_keys_;  // packed NodeKey of k = 0, ascending
  std::unordered_map<std::uint64_t, std::uint32_t> tile_at_;
  std::vector<Tile> tiles_;
};

// The chart's vertical coordinate r' - a (m) of a point `height_m` over the ellipsoid at a geodetic
// latitude: exact.
class ChartHeight {
 public:
  ChartHeight(const Ellipsoid& body, double latitude_deg);
  double operator()(double height_m) const;

 private:
  double equatorial_m_, twice_normal_m_, bulge_;
};
inline double chart_height_m(const Ellipsoid& body, double latitude_deg, double height_m) {
  return ChartHeight(body, latitude_deg)(height_m);
}

}  // namespace nepho::forecast
