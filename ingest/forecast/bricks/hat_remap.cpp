#include "forecast/bricks/hat_remap.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "forecast/bricks/cell_overlap.h"
#include "forecast/bricks/vertical_hats.h"
#include "geo/place.h"
#include "pyramid/touching.h"

#if defined(NEPHO_MUTANT_HALF)
#define NEPHO_MUTATION_FACTOR 0.5
#elif defined(NEPHO_MUTANT_DRIFT)
#define NEPHO_MUTATION_FACTOR 1.02
#else
#define NEPHO_MUTATION_FACTOR 1.0
#endif

namespace nepho::forecast {
namespace {

constexpr double kSide_deg = 1;  // longest wall between two corners

struct Entry {
  Column column;
  std::uint32_t cell;
  double solid_angle_sr;
  friend bool operator<(const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.cell < b.cell;
  }
};

double angle_deg(glm::dvec2 a, glm::dvec2 b) {
  const Ellipsoid ball = Ellipsoid::sphere(1);
  const glm::dvec3 u = scaled_direction(ball, a, 0), v = scaled_direction(ball, b, 0);
  return 2 * std::asin(std::min(1.0, glm::length(u - v) / 2)) * 180 / std::numbers::pi;
}

// Into how many parts walls are cut: the same for all cells, so that neighbours share corners.
int parts_of_walls(const HorizontalGrid& grid) {
  double longest_deg = 0;
  const int step_x = std::max(1, grid.nx() / 16), step_y = std::max(1, grid.ny() / 16);
  for (int j = 0; j < grid.ny(); j += step_y)
    for (int i = 0; i < grid.nx(); i += step_x) {
      const glm::dvec2 here = grid.lat_lon_deg(i, j);
      for (const glm::dvec2& next : {grid.lat_lon_deg(i + 1, j), grid.lat_lon_deg(i, j + 1)})
        if (!std::isnan(here.x) && !std::isnan(next.x))
          longest_deg = std::max(longest_deg, angle_deg(here, next));
    }
  return std::clamp(int(std::ceil(longest_deg / kSide_deg)), 1, 30);
}

// Each polygon as triangles about its first corner, each of these in 4^halvings of great circles:
// walls that two cells share are cut alike.
struct PolygonCells {
  const CellPolygons& polygons;
  const CellOverlap& overlap;
  const Ellipsoid& body;
  double height_m;
  int halvings;

  static int halvings_of(const CellPolygons& polygons) {
    double longest_deg = 0;
    for (std::size_t cell = 0; cell + 1 < polygons.first.size(); ++cell)
      for (std::uint32_t at = polygons.first[cell] + 1; at < polygons.first[cell + 1]; ++at)
        longest_deg =
            std::max(longest_deg, angle_deg(polygons.corner_deg[at - 1], polygons.corner_deg[at]));
    return std::clamp(int(std::ceil(std::log2(longest_deg / kSide_deg))), 0, 5);
  }
  void add(std::size_t cell, std::vector<HatShare>& shares) const {
    const auto corner = [&](std::uint32_t at) { return unit_vector(polygons.corner_deg[at]); };
    const std::uint32_t begin = polygons.first[cell], end = polygons.first[cell + 1];
    for (std::uint32_t at = begin + 2; at < end; ++at)
      add_triangle(corner(begin), corner(at - 1), corner(at), halvings, shares);
  }

 private:
  void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int more,
                    std::vector<HatShare>& shares) const {
    if (more > 0) {
      const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                       ca = glm::normalize(c + a);
      add_triangle(a, ab, ca, more - 1, shares);
      add_triangle(ab, b, bc, more - 1, shares);
      add_triangle(ca, bc, c, more - 1, shares);
      add_triangle(ab, bc, ca, more - 1, shares);
      return;
    }
    const auto scaled = [&](const glm::dvec3& u) {
      return scaled_direction(body, lat_lon_deg_of(u), height_m);
    };
    overlap.add({scaled(a), scaled(b), scaled(c), scaled(c)}, shares);
  }
};

void add_cell(const CellOverlap& overlap, const Ellipsoid& body, const HorizontalGrid& grid, int x,
              int y, int parts, double height_m, std::vector<HatShare>& shares) {
  const auto corner = [&](int a, int b) {
    return scaled_direction(body, grid.lat_lon_deg(x + double(a) / parts, y + double(b) / parts),
                            height_m);
  };
  for (int b = 0; b < parts; ++b)
    for (int a = 0; a < parts; ++a)
      overlap.add({corner(a, b), corner(a + 1, b), corner(a + 1, b + 1), corner(a, b + 1)}, shares);
}

}  // namespace

HatRemap::HatRemap(std::shared_ptr<const ShellChart> chart, const Lattice& lattice,
                   const HorizontalGrid& grid, const ForecastColumns& columns,
                   const RemapOptions& options)
    : chart_(std::move(chart)),
      lattice_(lattice),
      level_(lattice.max_level()),
      cells_(lattice.cells(lattice.max_level())) {
  remap_columns(grid, columns, options);
  overlap_cells(grid, columns);
}

void HatRemap::remap_columns(const HorizontalGrid& grid, const ForecastColumns& columns,
                             const RemapOptions& options) {
  const VerticalHats vertical(*chart_, cells_[2], options);
  const std::size_t count = std::size_t(columns.nx) * std::size_t(columns.ny);
  ranges_.resize(count);
  std::vector<glm::dvec2> cloudy_m(count);  // lowest and highest cloud of a column
  const auto column = [&](std::size_t cell) {
    const auto nz = std::size_t(columns.nz), nx = std::size_t(columns.nx);
    const double latitude_deg =
        grid.lat_lon_deg(double(cell % nx) + 0.5, double(cell / nx) + 0.5).x;
    return ModelColumn{latitude_deg,
                       {&columns.interface_m[cell * (nz + 1)], nz + 1},
                       {&columns.extinction_per_m[cell * nz], nz}};
  };
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t cell) {
    const auto found = vertical.range(column(cell));
    ranges_[cell] = {found.first, found.count, 0};
    cloudy_m[cell] = found.cloudy_m;
  });
  std::uint64_t total = 0;
  double sum_m = 0, cloudy = 0;
  for (std::size_t cell = 0; cell < count; ++cell) {
    ranges_[cell].at = total;
    total += ranges_[cell].count;
    if (ranges_[cell].count == 0) continue;
    sum_m += (cloudy_m[cell].x + cloudy_m[cell].y) / 2;
    ++cloudy;
  }
  reference_height_m_ = cloudy > 0 ? sum_m / cloudy : 0;
  hats_[0].resize(total);
  if (!columns.ice_extinction_per_m.empty()) hats_[1].resize(total);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t cell) {
    const CellRange& range = ranges_[cell];
    if (range.count == 0) return;
    const ModelColumn model = column(cell);
    const auto nz = std::size_t(columns.nz);
    vertical.means(model, model.value_per_m, range.first, {&hats_[0][range.at], range.count});
    if (hats_[1].empty()) return;
    vertical.means(model, {&columns.ice_extinction_per_m[cell * nz], nz}, range.first,
                   {&hats_[1][range.at], range.count});
  });
}

void HatRemap::overlap_cells(const HorizontalGrid& grid, const ForecastColumns& columns) {
  const CellOverlap overlap(*chart_, cells_);
  const CellPolygons* polygons = grid.polygons();
  const int parts = polygons ? 1 : parts_of_walls(grid);
  std::optional<PolygonCells> shapes;
  if (polygons)
    shapes.emplace(PolygonCells{*polygons, overlap, chart_->body(), reference_height_m_,
                                PolygonCells::halvings_of(*polygons)});
  constexpr std::size_t kBlock = 256;  // cells
  std::vector<std::vector<Entry>> of_block((ranges_.size() + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, of_block.size(), [&](std::size_t block) {
    std::vector<HatShare> shares;
    const std::size_t end = std::min(ranges_.size(), (block + 1) * kBlock);
    for (std::size_t cell = block * kBlock; cell < end; ++cell) {
      if (ranges_[cell].count == 0) continue;
      shares.clear();
      const std::size_t nx = std::size_t(columns.nx);
      if (shapes)
        shapes->add(cell, shares);
      else
        add_cell(overlap, chart_->body(), grid, int(cell % nx), int(cell / nx), parts,
                 reference_height_m_, shares);
      for (const HatShare& share : shares)
        if (share.solid_angle_sr > 0)
          of_block[block].push_back({share.column, std::uint32_t(cell), share.solid_angle_sr});
    }
  });
  std::vector<Entry> entries;
  for (std::vector<Entry>& some : of_block) {
    entries.insert(entries.end(), some.begin(), some.end());
    some = {};
  }
  tbb::parallel_sort(entries.begin(), entries.end());
  std::vector<Column> rows;
  for (const Entry& entry : entries) {
    if (rows.empty() || rows.back() != entry.column) {
      rows.push_back(entry.column);
      row_begin_.push_back(std::uint32_t(taps_.size()));
    }
    taps_.push_back({entry.cell, float(entry.solid_angle_sr)});
  }
  row_begin_.push_back(std::uint32_t(taps_.size()));
  taps_.shrink_to_fit();
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t row) {
    double volume_sr = 0;
    for (const Column& name : chart_->names(rows[row], cells_))
      volume_sr += chart_->hat_horizontal(name, cells_);
    for (std::uint32_t at = row_begin_[row]; at < row_begin_[row + 1]; ++at)
      taps_[at].weight = float(double(taps_[at].weight) / volume_sr * NEPHO_MUTATION_FACTOR);
  });
  list_tiles(rows);
}

void HatRemap::list_tiles(const std::vector<Column>& rows) {
  for (std::uint32_t row = 0; row < rows.size(); ++row)
    for (const Column& name : chart_->names(rows[row], cells_))
      for_each_holder(name.i, cells_[0], [&](std::uint32_t a) {
        for_each_holder(name.j, cells_[1], [&](std::uint32_t b) {
          const std::uint64_t key = NodeKey(name.root, level_, a, b, 0).packed();
          const auto [place, first] = tile_at_.try_emplace(key, std::uint32_t(tiles_.size()));
          if (first) {
            tile_keys_.push_back(key);
            tiles_.emplace_back().fill(kNoRow);
          }
          tiles_[place->second]
                [name.i - kBrickCells * a + kBrickSamples * (name.j - kBrickCells * b)] = row;
        });
      });
  std::ranges::sort(tile_keys_);
}

const HatRemap::Tile* HatRemap::tile(NodeKey key) const {
  const auto found = tile_at_.find(NodeKey(key.root(), level_, key.i(), key.j(), 0).packed());
  return found == tile_at_.end() ? nullptr : &tiles_[found->second];
}

std::vector<NodeKey> HatRemap::nodes(Part part) const {
  const std::vector<float>& hats = hats_[std::size_t(part)];
  if (hats.empty()) return {};
  const std::uint32_t layers = cells_[2] / kBrickCells;
  std::vector<std::vector<NodeKey>> of_tile(tile_keys_.size());
  tbb::parallel_for(std::size_t{0}, tile_keys_.size(), [&](std::size_t n) {
    const NodeKey base = NodeKey::from_packed(tile_keys_[n]);
    std::vector<std::uint32_t> cells;
    for (const std::uint32_t row : *tile(base)) {
      if (row == kNoRow) continue;
      for (std::uint32_t at = row_begin_[row]; at < row_begin_[row + 1]; ++at)
        if (taps_[at].weight > 0) cells.push_back(taps_[at].cell);
    }
    std::ranges::sort(cells);
    cells.erase(std::ranges::unique(cells).begin(), cells.end());
    std::vector<char> holds(layers, 0);
    for (const std::uint32_t cell : cells) {
      const CellRange& range = ranges_[cell];
      for (std::uint32_t k = 0; k < range.count; ++k)
        if (hats[range.at + k] > 0)
          for_each_holder(range.first + k, cells_[2], [&](std::uint32_t c) { holds[c] = 1; });
    }
    for (std::uint32_t c = 0; c < layers; ++c)
      if (holds[c]) of_tile[n].emplace_back(base.root(), level_, base.i(), base.j(), c);
  });
  std::vector<NodeKey> nodes;
  for (const auto& some : of_tile) nodes.insert(nodes.end(), some.begin(), some.end());
  return nodes;
}

void HatRemap::samples(NodeKey key, Part part, double* samples) const {
  std::fill_n(samples, kBrickVolume, 0.0);
  const Tile* rows = tile(key);
  const std::vector<float>& hats = hats_[std::size_t(part)];
  if (!rows || hats.empty()) return;
  constexpr std::size_t kArea = kBrickSamples * kBrickSamples;
  const std::uint32_t low = kBrickCells * key.k(), high = low + kBrickSamples;
  for (std::size_t h = 0; h < kArea; ++h) {
    const std::uint32_t row = (*rows)[h];
    if (row == kNoRow) continue;
    std::array<double, kBrickSamples> sum{};
    for (std::uint32_t at = row_begin_[row]; at < row_begin_[row + 1]; ++at) {
      const CellRange& range = ranges_[taps_[at].cell];
      const std::uint32_t first = std::max(low, range.first);
      const std::uint32_t end = std::min(high, range.first + range.count);
      const double weight = double(taps_[at].weight);
      for (std::uint32_t k = first; k < end; ++k)
        sum[k - low] += weight * double(hats[range.at + (k - range.first)]);
    }
    for (std::size_t k = 0; k < kBrickSamples; ++k) samples[h + kArea * k] = sum[k];
  }
}

double HatRemap::value(std::uint32_t row, std::uint32_t k, const std::vector<float>& hats) const {
  if (row == kNoRow) return 0;
  double sum = 0;
  for (std::uint32_t at = row_begin_[row]; at < row_begin_[row + 1]; ++at) {
    const CellRange& range = ranges_[taps_[at].cell];
    if (k >= range.first && k - range.first < range.count)
      sum += double(taps_[at].weight) * double(hats[range.at + (k - range.first)]);
  }
  return sum;
}

double HatRemap::interpolated(const glm::dvec3& ecef_m, Part part) const {
  const std::vector<float>& hats = hats_[std::size_t(part)];
  const RootPosition place = chart_->locate(ecef_m);
  if (hats.empty() || !(place.q.z >= 0) || !(place.q.z <= 1)) return 0;
  const Tile* rows = tile(lattice_.node_at(place.root, place.q, level_));
  if (!rows) return 0;
  std::array<std::uint32_t, 3> cell{};
  glm::dvec3 part_of_cell;
  for (int a = 0; a < 3; ++a) {
    const double n = cells_[std::size_t(a)], at = std::clamp(place.q[a] * n, 0.0, n);
    cell[std::size_t(a)] = std::uint32_t(std::min(std::floor(at), n - 1));
    part_of_cell[a] = at - cell[std::size_t(a)];
  }
  double sum = 0;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const double weight = (x ? part_of_cell.x : 1 - part_of_cell.x) *
                          (y ? part_of_cell.y : 1 - part_of_cell.y) *
                          (z ? part_of_cell.z : 1 - part_of_cell.z);
    const std::uint32_t h = cell[0] % kBrickCells + x + kBrickSamples * (cell[1] % kBrickCells + y);
    if (weight > 0) sum += weight * value((*rows)[h], cell[2] + z, hats);
  }
  return sum;
}

std::uint64_t HatRemap::bytes() const {
  return sizeof *this + ranges_.capacity() * sizeof(CellRange) +
         (hats_[0].capacity() + hats_[1].capacity()) * sizeof(float) +
         row_begin_.capacity() * sizeof(std::uint32_t) + taps_.capacity() * sizeof(Tap) +
         tile_keys_.capacity() * sizeof(std::uint64_t) + tiles_.capacity() * sizeof(Tile) +
         tile_at_.size() * 4 * sizeof(std::uint64_t);
}

double chart_height_m(const Ellipsoid& body, double latitude_deg, double height_m) {
  // r'^2 - a^2 = 2 N h + A h^2 on the normal of that latitude.
  const double a = body.equatorial_m, ratio = a / body.polar_m;
  const double s = std::sin(latitude_deg * std::numbers::pi / 180), s2 = s * s;
  const double n = a / std::sqrt(1 - (1 - 1 / (ratio * ratio)) * s2);
  const double excess = height_m * (2 * n + (1 + (ratio * ratio - 1) * s2) * height_m);
  return excess / (a + std::sqrt(a * a + excess));
}

}  // namespace nepho::forecast
