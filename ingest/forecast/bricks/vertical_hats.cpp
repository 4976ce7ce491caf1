#include "forecast/bricks/vertical_hats.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nepho::forecast {
namespace {

// int r^2 dr from r = 1 to 1 + up, without the loss of digits of a difference of cubes.
double volume_below(double up) {
  return up * (1 + up * (1 + up / 3));
}

// Gauss's points and weights on [0, 1].
constexpr std::array<glm::dvec2, 2> kTwoPoints = {
    {{0.21132486540518712, 0.5}, {0.78867513459481288, 0.5}}};
constexpr std::array<glm::dvec2, 3> kThreePoints = {
    {{0.11270166537925831, 5.0 / 18}, {0.5, 4.0 / 9}, {0.88729833462074169, 5.0 / 18}}};

}  // namespace

double VerticalHats::SmoothColumn::value_per_m(std::size_t layer, double up) const {
  const double u = (volume_below(up) - below[layer]) / (below[layer + 1] - below[layer]);
  return std::max(0.0, profile[layer](u));  // rounding
}

VerticalHats::VerticalHats(const ShellChart& chart, std::uint32_t cells_z,
                           const RemapOptions& options)
    : chart_(chart), cells_(cells_z), voxel_m_(chart.thickness_m() / cells_z), options_(options) {
  const double a = chart.body().equatorial_m, b = chart.body().polar_m;
  volume_.resize(cells_ + 1);
  for (std::uint32_t k = 0; k <= cells_; ++k)
    volume_[k] = chart.hat_vertical(k, {cells_, cells_, cells_}) / (a * b * voxel_m_);
}

bool VerticalHats::clear(const ModelColumn& column, std::size_t layer) const {
  const float value = column.value_per_m[layer];
  return !(value > 0) || double(value) < options_.clear_below_per_m;
}

glm::dvec2 VerticalHats::extent(const ModelColumn& column, const ChartHeight& up_m,
                                std::size_t layer) const {
  const auto voxels = [&](double height_m) {
    return std::clamp((up_m(height_m) - chart_.bottom_m()) / voxel_m_, 0.0, double(cells_));
  };
  const double below_m = layer == 0 ? options_.extend_below_m : 0;
  return {voxels(double(column.interface_m[layer]) - below_m),
          voxels(double(column.interface_m[layer + 1]))};
}

VerticalHats::Range VerticalHats::range(const ModelColumn& column) const {
  Range range;
  const ChartHeight up_m(chart_.body(), column.latitude_deg);
  double low = cells_, high = 0;
  for (std::size_t layer = 0; layer < column.value_per_m.size(); ++layer) {
    if (clear(column, layer)) continue;
    const glm::dvec2 z = extent(column, up_m, layer);
    if (!(z.y > z.x)) continue;
    if (!(high > low)) range.cloudy_m.x = double(column.interface_m[layer]);
    range.cloudy_m.y = double(column.interface_m[layer + 1]);
    low = std::min(low, z.x);
    high = std::max(high, z.y);
  }
  if (!(high > low)) return range;
  range.first = std::uint32_t(low);
  range.count = std::uint32_t(std::ceil(high)) - range.first + 1;
  return range;
}

VerticalHats::SmoothColumn VerticalHats::smooth(const ModelColumn& column) const {
  const std::size_t layers = column.value_per_m.size();
  SmoothColumn smooth{ChartHeight(chart_.body(), column.latitude_deg), {}, {}};
  if (options_.layers != Layers::kSmooth) return smooth;
  smooth.below.resize(layers + 1);
  smooth.profile.resize(layers);
  for (std::size_t k = 0; k <= layers; ++k)
    smooth.below[k] =
        volume_below(smooth.up_m(double(column.interface_m[k])) / chart_.body().equatorial_m);
  std::vector<double> thickness(layers), mean(layers);
  for (std::size_t k = 0; k < layers; ++k) {
    thickness[k] = smooth.below[k + 1] - smooth.below[k];
    mean[k] = clear(column, k) ? 0 : double(column.value_per_m[k]);
  }
  reconstruct(thickness, mean, smooth.profile);
  return smooth;
}

template <class Rule, class Extinction>
void VerticalHats::add_layer(glm::dvec2 extent, const Rule& rule, Extinction&& extinction_per_m,
                             std::uint32_t first, std::span<double> sum) const {
  const double a = chart_.body().equatorial_m;
  for (double cell = std::floor(extent.x); cell < extent.y; ++cell) {
    const double low = std::max(extent.x - cell, 0.0), high = std::min(extent.y - cell, 1.0);
    if (!(high > low)) continue;
    const auto k = std::size_t(cell) - first;
    for (const glm::dvec2& point : rule) {
      const double t = low + (high - low) * point.x;
      const double up = (chart_.bottom_m() + (cell + t) * voxel_m_) / a, r = 1 + up;
      const double part = point.y * (high - low) * r * r * extinction_per_m(up);
      sum[k] += (1 - t) * part;
      sum[k + 1] += t * part;
    }
  }
}

void VerticalHats::means(const ModelColumn& column, const SmoothColumn& inside,
                         std::span<const float> part_per_m, std::uint32_t first,
                         std::span<float> means) const {
  std::vector<double> sum(means.size(), 0.0);
  const std::size_t layers = column.value_per_m.size();
  for (std::size_t layer = 0; layer < layers; ++layer) {
    if (clear(column, layer)) continue;
#ifdef NEPHO_MUTANT_FLIP
    const std::size_t from = layers - 1 - layer;
#else
    const std::size_t from = layer;
#endif
    const double own_per_m = double(part_per_m[from]);
    if (inside.profile.empty()) {
      add_layer(
          extent(column, inside.up_m, layer), kTwoPoints, [&](double) { return own_per_m; }, first,
          sum);
      continue;
    }
    const double share = std::min(1.0, own_per_m / double(column.value_per_m[from]));
    const auto part_at = [&](double up) { return share * inside.value_per_m(from, up); };
    add_layer(extent(column, inside.up_m, layer), kThreePoints, part_at, first, sum);
  }
  for (std::size_t k = 0; k < means.size(); ++k) means[k] = float(sum[k] / volume_[first + k]);
}

}  // namespace nepho::forecast
