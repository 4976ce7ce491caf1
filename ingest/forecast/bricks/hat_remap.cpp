#include "forecast/bricks/hat_remap.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "forecast/bricks/cell_overlap.h"
#include "forecast/bricks/vertical_hats.h"
#include "pyramid/touching.h"

#if defined(NEPHO_MUTANT_HALF)
#define NEPHO_MUTATION_FACTOR 0.5
#elif defined(NEPHO_MUTANT_DRIFT)
#define NEPHO_MUTATION_FACTOR 1.02
#else
#define NEPHO_MUTATION_FACTOR 1.0
#endif

namespace nepho::forecast {

// What cells of all domains hold, for one height of their walls.
struct HatRemap::CloudHeights {
  double sum_m = 0, cloudy = 0;
};

HatRemap::HatRemap(std::shared_ptr<const ShellChart> chart, const Lattice& lattice,
                   const HorizontalGrid& grid, const ForecastColumns& columns,
                   const RemapOptions& options)
    : HatRemap(std::move(chart), lattice, std::array{HatDomain{grid, columns}}, options) {}

HatRemap::HatRemap(std::shared_ptr<const ShellChart> chart, const Lattice& lattice,
                   std::span<const HatDomain> domains, const RemapOptions& options)
    : chart_(std::move(chart)),
      lattice_(lattice),
      level_(lattice.max_level()),
      cells_(lattice.cells(lattice.max_level())) {
  remap_columns(domains, options);
  overlap_cells(domains);
}

void HatRemap::remap_columns(std::span<const HatDomain> domains, const RemapOptions& options) {
  std::size_t count = 0;
  for (const HatDomain& domain : domains)
    count += std::size_t(domain.columns.nx) * std::size_t(domain.columns.ny);
  ranges_.resize(count);
  CloudHeights heights;
  std::size_t first = 0;
  for (const HatDomain& domain : domains) {
    remap_domain(domain, first, options, heights);
    first += std::size_t(domain.columns.nx) * std::size_t(domain.columns.ny);
  }
  reference_height_m_ = heights.cloudy > 0 ? heights.sum_m / heights.cloudy : 0;
}

void HatRemap::remap_domain(const HatDomain& domain, std::size_t first_cell,
                            const RemapOptions& options, CloudHeights& heights) {
  const ForecastColumns& columns = domain.columns;
  const VerticalHats vertical(*chart_, cells_[2], options);
  const std::size_t count = std::size_t(columns.nx) * std::size_t(columns.ny);
  const std::span<CellRange> ranges(&ranges_[first_cell], count);
  std::vector<glm::dvec2> cloudy_m(count);  // lowest and highest cloud of a column
  const auto column = [&](std::size_t cell) {
    const auto nz = std::size_t(columns.nz), nx = std::size_t(columns.nx);
    const double latitude_deg =
        domain.grid.lat_lon_deg(double(cell % nx) + 0.5, double(cell / nx) + 0.5).x;
    return ModelColumn{latitude_deg,
                       {&columns.interface_m[cell * (nz + 1)], nz + 1},
                       {&columns.extinction_per_m[cell * nz], nz}};
  };
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t cell) {
    const auto found = vertical.range(column(cell));
    ranges[cell] = {found.first, found.count, 0};
    cloudy_m[cell] = found.cloudy_m;
  });
  std::uint64_t total = hats_[0].size();
  for (std::size_t cell = 0; cell < count; ++cell) {
    ranges[cell].at = total;
    total += ranges[cell].count;
    if (ranges[cell].count == 0) continue;
    heights.sum_m += (cloudy_m[cell].x + cloudy_m[cell].y) / 2;
    ++heights.cloudy;
  }
  const bool has_ice = !columns.ice_extinction_per_m.empty();
  if (has_ice || !hats_[1].empty()) hats_[1].resize(total);
  hats_[0].resize(total);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t cell) {
    const CellRange& range = ranges[cell];
    if (range.count == 0) return;
    const ModelColumn model = column(cell);
    const auto nz = std::size_t(columns.nz);
    const VerticalHats::SmoothColumn inside = vertical.smooth(model);
    vertical.means(model, inside, model.value_per_m, range.first,
                   {&hats_[0][range.at], range.count});
    if (!has_ice) return;
    vertical.means(model, inside, {&columns.ice_extinction_per_m[cell * nz], nz}, range.first,
                   {&hats_[1][range.at], range.count});
  });
}

void HatRemap::overlap_domain(const HatDomain& domain, std::size_t first_cell,
                              const Coverage& finer, std::vector<Entry>& entries) const {
#ifdef NEPHO_MUTANT_NO_MASK
  const CellOverlap overlap(*chart_, cells_);
#else
  const CellOverlap overlap(*chart_, cells_, &finer);
#endif
  const DomainCells cells(chart_->body(), domain.grid, reference_height_m_);
  const std::size_t count = std::size_t(domain.columns.nx) * std::size_t(domain.columns.ny);
  constexpr std::size_t kBlock = 256;  // cells
  std::vector<std::vector<Entry>> of_block((count + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, of_block.size(), [&](std::size_t block) {
    std::vector<HatShare> shares;
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t cell = block * kBlock; cell < end; ++cell) {
      if (ranges_[first_cell + cell].count == 0) continue;
      shares.clear();
      cells.for_each_part(cell, [&](const auto& corners) { overlap.add(corners, shares); });
      for (const HatShare& share : shares)
        if (share.solid_angle_sr > 0)
          of_block[block].push_back(
              {share.column, std::uint32_t(first_cell + cell), share.solid_angle_sr});
    }
  });
  for (std::vector<Entry>& some : of_block) {
    entries.insert(entries.end(), some.begin(), some.end());
    some = {};
  }
}

void HatRemap::overlap_cells(std::span<const HatDomain> domains) {
  std::vector<Entry> entries;
  Coverage finer(*chart_, cells_);
  std::size_t first = 0;
  for (std::size_t n = 0; n < domains.size(); ++n) {
    const HatDomain& domain = domains[n];
    overlap_domain(domain, first, finer, entries);
    first += std::size_t(domain.columns.nx) * std::size_t(domain.columns.ny);
    if (n + 1 < domains.size())
      finer.add(domain.grid, reference_height_m_, domain.columns.without_data);
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

// r'^2 - a^2 = 2 N h + A h^2 on the normal of that latitude.
ChartHeight::ChartHeight(const Ellipsoid& body, double latitude_deg)
    : equatorial_m_(body.equatorial_m) {
  const double ratio = body.equatorial_m / body.polar_m;
  const double s = std::sin(latitude_deg * std::numbers::pi / 180), s2 = s * s;
  twice_normal_m_ = 2 * (equatorial_m_ / std::sqrt(1 - (1 - 1 / (ratio * ratio)) * s2));
  bulge_ = 1 + (ratio * ratio - 1) * s2;
}

double ChartHeight::operator()(double height_m) const {
  const double excess = height_m * (twice_normal_m_ + bulge_ * height_m);
  return excess / (equatorial_m_ + std::sqrt(equatorial_m_ * equatorial_m_ + excess));
}

}  // namespace nepho::forecast
