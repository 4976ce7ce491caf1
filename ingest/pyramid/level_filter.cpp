#include "pyramid/level_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nepho {
namespace {

constexpr std::size_t kStride[3] = {1, kBrickSamples, kBrickSamples* kBrickSamples};

// (1/2, 1, 1/2) over 9 fine samples: 5 coarse ones, in place.
void halve_line(double* line, std::size_t stride) {
  double coarse[5];
  for (std::size_t g = 0; g < 5; ++g) {
    double sides = 0;
    if (g > 0) sides += line[(2 * g - 1) * stride];
    if (g < 4) sides += line[(2 * g + 1) * stride];
    coarse[g] = line[2 * g * stride] + 0.5 * sides;
  }
  for (std::size_t g = 0; g < 5; ++g) line[g * stride] = coarse[g];
}

// Filters the split axes of a 9^3 block; what is left has 5 samples on those, 9 on the others.
std::array<std::size_t, 3> halve(double* block, SplitMask mask) {
  std::array<std::size_t, 3> size = {kBrickSamples, kBrickSamples, kBrickSamples};
  for (int axis = 0; axis < 3; ++axis) {
    if (!splits(mask, axis)) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (std::size_t b = 0; b < size[std::size_t(v)]; ++b)
      for (std::size_t a = 0; a < size[std::size_t(u)]; ++a)
        halve_line(block + a * kStride[u] + b * kStride[v], kStride[axis]);
    size[std::size_t(axis)] = 5;
  }
  return size;
}

// Sum of (1 - |d| / m) over the integers d in [low, high], |d| < m.
double hat_sum(std::int64_t low, std::int64_t high, std::int64_t m) {
  low = std::max(low, 1 - m);
  high = std::min(high, m - 1);
  if (low > high) return 0;
  const auto triangle = [](std::int64_t n) { return n > 0 ? n * (n + 1) / 2 : 0; };
  // sum |d| over [low, high]
  const std::int64_t distance = low >= 0    ? triangle(high) - triangle(low - 1)
                                : high <= 0 ? triangle(-low) - triangle(-high - 1)
                                            : triangle(high) + triangle(-low);
  return double(high - low + 1) - double(distance) / double(m);
}

// Share of a coarse hat (m finest spacings to a side) around `index` that finest samples low..high
// hold, of the root's 0..cells; the end samples' own hats are half.
double share(std::int64_t index, std::int64_t m, std::int64_t low, std::int64_t high,
             std::int64_t cells) {
  const std::int64_t centre = index * m;
  const auto within = [&](std::int64_t first, std::int64_t last) {
    first = std::max<std::int64_t>(first, 0);
    last = std::min(last, cells);
    double sum = hat_sum(first - centre, last - centre, m);
    if (first == 0 && last >= 0) sum -= 0.5 * hat_sum(-centre, -centre, m);
    if (last == cells && first <= cells) sum -= 0.5 * hat_sum(cells - centre, cells - centre, m);
    return sum;
  };
  return within(low, high) / within(0, cells);
}

}  // namespace

HatWeights owned_hats(const Chart& chart, const Lattice& lattice, NodeKey key) {
  const Index3& cells = lattice.cells(key.level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  const auto owned = [&](int axis, std::uint32_t s) {
    const auto a = std::size_t(axis);
    return s < kBrickCells || g[a] + s == cells[a];
  };
  HatWeights hats;
  for (std::uint32_t j = 0; j < kBrickSamples; ++j)
    for (std::uint32_t i = 0; i < kBrickSamples; ++i)
      hats.horizontal[i + kBrickSamples * j] =
          owned(0, i) && owned(1, j) ? chart.hat_horizontal({key.root(), g[0] + i, g[1] + j}, cells)
                                     : 0.0;
  for (std::uint32_t k = 0; k < kBrickSamples; ++k)
    hats.vertical[k] = owned(2, k) ? chart.hat_vertical(g[2] + k, cells) : 0.0;
  return hats;
}

HatWeights whole_hats(const Chart& chart, const Lattice& lattice, NodeKey key) {
  const Index3& cells = lattice.cells(key.level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  HatWeights hats;
  for (std::uint32_t j = 0; j < kBrickSamples; ++j)
    for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
      double sum = 0;
      for (const Column& name : chart.names({key.root(), g[0] + i, g[1] + j}, cells))
        sum += chart.hat_horizontal(name, cells);
      hats.horizontal[i + kBrickSamples * j] = sum;
    }
  for (std::uint32_t k = 0; k < kBrickSamples; ++k)
    hats.vertical[k] = chart.hat_vertical(g[2] + k, cells);
  return hats;
}

void add_child(const double* samples, const float* variance, const HatWeights& hats, SplitMask mask,
               SplitMask octant, FilterSums parent) {
  BrickSamples mean, square;
  for (std::size_t k = 0, at = 0; k < kBrickSamples; ++k)
    for (std::size_t h = 0; h < hats.horizontal.size(); ++h, ++at) {
      const double weight = hats.horizontal[h] * hats.vertical[k], c = samples[at];
      mean[at] = weight * c;
      square[at] = weight * (c * c + (variance ? double(variance[at]) : 0.0));
    }
  const std::array<std::size_t, 3> size = halve(mean.data(), mask);
  halve(square.data(), mask);
  std::size_t first = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (splits(octant, axis)) first += kBrickCells / 2 * kStride[axis];
  for (std::size_t k = 0; k < size[2]; ++k)
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i) {
        const std::size_t at = i + j * kStride[1] + k * kStride[2];
        parent.mean[first + at] += mean[at];
        parent.square[first + at] += float(square[at]);
      }
}

void refine(const Lattice& lattice, NodeKey node, const double* samples, NodeKey descendant,
            double* refined) {
  struct Axis {
    std::array<std::size_t, kBrickSamples> cell;
    std::array<double, kBrickSamples> fraction;
    std::size_t first, last;  // samples of the node that are needed
  };
  std::array<Axis, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint64_t ratio =
        lattice.cells(descendant.level())[a] / lattice.cells(node.level())[a];
    for (std::uint64_t s = 0; s < kBrickSamples; ++s) {
      const std::uint64_t fine =
          std::uint64_t{kBrickCells} * (descendant.ijk()[a] - node.ijk()[a] * ratio) + s;
      const std::uint64_t cell = std::min<std::uint64_t>(fine / ratio, kBrickCells - 1);
      axes[a].cell[s] = cell;
      axes[a].fraction[s] = double(fine - cell * ratio) / double(ratio);
    }
    axes[a].first = axes[a].cell.front();
    axes[a].last = axes[a].cell.back() + 1;
  }
  const auto lerp = [](double low, double high, double t) {
    return t == 0 ? low : t == 1 ? high : low + t * (high - low);
  };
  const auto& [x, y, z] = axes;
  BrickSamples along_x, along_y;
  for (std::size_t k = z.first; k <= z.last; ++k)
    for (std::size_t j = y.first; j <= y.last; ++j) {
      const double* row = samples + j * kStride[1] + k * kStride[2];
      for (std::size_t s = 0; s < kBrickSamples; ++s)
        along_x[s + j * kStride[1] + k * kStride[2]] =
            lerp(row[x.cell[s]], row[x.cell[s] + 1], x.fraction[s]);
    }
  for (std::size_t k = z.first; k <= z.last; ++k)
    for (std::size_t s = 0; s < kBrickSamples; ++s) {
      const double* low = &along_x[y.cell[s] * kStride[1] + k * kStride[2]];
      for (std::size_t i = 0; i < kBrickSamples; ++i)
        along_y[i + s * kStride[1] + k * kStride[2]] =
            lerp(low[i], low[i + kStride[1]], y.fraction[s]);
    }
  for (std::size_t s = 0; s < kBrickSamples; ++s) {
    const double* low = &along_y[z.cell[s] * kStride[2]];
    for (std::size_t h = 0; h < kStride[2]; ++h)
      refined[h + s * kStride[2]] = lerp(low[h], low[h + kStride[2]], z.fraction[s]);
  }
}

std::pair<double, double> range_around(const Lattice& lattice, NodeKey node, const double* samples,
                                       NodeKey descendant) {
  std::array<std::size_t, 3> first, last;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint64_t ratio =
        lattice.cells(descendant.level())[a] / lattice.cells(node.level())[a];
    const std::uint64_t fine =
        std::uint64_t{kBrickCells} * (descendant.ijk()[a] - node.ijk()[a] * ratio);
    const auto cell = [&](std::uint64_t s) {
      return std::size_t(std::min<std::uint64_t>(s / ratio, kBrickCells - 1));
    };
    first[a] = cell(fine);
    last[a] = cell(fine + kBrickCells) + 1;
  }
  double least = samples[first[0] + first[1] * kStride[1] + first[2] * kStride[2]], most = least;
  for (std::size_t k = first[2]; k <= last[2]; ++k)
    for (std::size_t j = first[1]; j <= last[1]; ++j)
      for (std::size_t i = first[0]; i <= last[0]; ++i) {
        const double c = samples[i + j * kStride[1] + k * kStride[2]];
        least = c < least ? c : least;
        most = c > most ? c : most;
      }
  return {least, most};
}

double greatest_gap(const BrickSamples& own, const BrickSamples& low, const BrickSamples& high) {
  // One maximum per column of the brick: independent, so that they run side by side.
  std::array<double, kBrickSamples * kBrickSamples> worst{};
  for (std::size_t at = 0; at < own.size(); at += worst.size())
    for (std::size_t h = 0; h < worst.size(); ++h) {
      const double below = low[at + h] - own[at + h], above = own[at + h] - high[at + h];
      const double gap = below > above ? below : above;
      worst[h] = gap > worst[h] ? gap : worst[h];
    }
  return *std::ranges::max_element(worst);
}

void closed_form_samples(const Lattice& lattice, NodeKey key, const SparsePyramid::Region& region,
                         double* samples, float* variance) {
  if (region.constant) {
    std::fill_n(samples, kBrickVolume, region.value);
    if (variance) std::fill_n(variance, kBrickVolume, 0.0f);
    return;
  }
  const Index3 &cells = lattice.cells(key.level()), &finest = lattice.cells(lattice.max_level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  std::array<std::array<double, kBrickSamples>, 3> shares;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::uint32_t s = 0; s < kBrickSamples; ++s)
      shares[a][s] =
          share(g[a] + s, finest[a] / cells[a], region.low[a], region.high[a], finest[a]);
  const double value = region.value, outside = region.outside;
  std::size_t at = 0;
  for (const double pz : shares[2])
    for (const double py : shares[1])
      for (const double px : shares[0]) {
        const double p = px * py * pz;
        samples[at] = p == 1 ? value : outside + (value - outside) * p;
        if (variance) variance[at] = float(p * (1 - p) * (value - outside) * (value - outside));
        ++at;
      }
}

}  // namespace nepho
