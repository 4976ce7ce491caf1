#include "sources/netcdf/vertical_hats.h"

#include <algorithm>
#include <cmath>

namespace nepho::netcdf {

VerticalHats::VerticalHats(const ShellChart& chart, std::uint32_t cells_z,
                           const RemapOptions& options)
    : chart_(chart), cells_(cells_z), voxel_m_(chart.thickness_m() / cells_z), options_(options) {
  const double a = chart.body().equatorial_m, b = chart.body().polar_m;
  volume_.resize(cells_ + 1);
  for (std::uint32_t k = 0; k <= cells_; ++k)
    volume_[k] = chart.hat_vertical(k, {cells_, cells_, cells_}) / (a * b * voxel_m_);
}

bool VerticalHats::clear(const ModelColumn& column, std::size_t layer) const {
  const float value = (column.clear_where.empty() ? column.value_per_m : column.clear_where)[layer];
  return !(value > 0) || double(value) < options_.clear_below_per_m;
}

glm::dvec2 VerticalHats::extent(const ModelColumn& column, std::size_t layer) const {
  const auto voxels = [&](double height_m) {
    const double up_m = chart_height_m(chart_.body(), column.latitude_deg, height_m);
    return std::clamp((up_m - chart_.bottom_m()) / voxel_m_, 0.0, double(cells_));
  };
  const double below_m = layer == 0 ? options_.extend_below_m : 0;
  return {voxels(double(column.interface_m[layer]) - below_m),
          voxels(double(column.interface_m[layer + 1]))};
}

VerticalHats::Range VerticalHats::range(const ModelColumn& column) const {
  Range range;
  double low = cells_, high = 0;
  for (std::size_t layer = 0; layer < column.value_per_m.size(); ++layer) {
    if (clear(column, layer)) continue;
    const glm::dvec2 z = extent(column, layer);
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

void VerticalHats::means(const ModelColumn& column, std::uint32_t first,
                         std::span<float> means) const {
  std::vector<double> sum(means.size(), 0.0);
  const double a = chart_.body().equatorial_m;
  const std::size_t layers = column.value_per_m.size();
  for (std::size_t layer = 0; layer < layers; ++layer) {
    if (clear(column, layer)) continue;
#ifdef NEPHO_MUTANT_FLIP
    const double beta = double(column.value_per_m[layers - 1 - layer]);
#else
    const double beta = double(column.value_per_m[layer]);
#endif
    const glm::dvec2 z = extent(column, layer);
    for (double cell = std::floor(z.x); cell < z.y; ++cell) {
      const double low = std::max(z.x - cell, 0.0), high = std::min(z.y - cell, 1.0);
      if (!(high > low)) continue;
      const auto k = std::size_t(cell) - first;
      for (const double node : {0.21132486540518712, 0.78867513459481288}) {
        const double t = low + (high - low) * node;
        const double r = 1 + (chart_.bottom_m() + (cell + t) * voxel_m_) / a;
        const double part = 0.5 * (high - low) * r * r * beta;
        sum[k] += (1 - t) * part;
        sum[k + 1] += t * part;
      }
    }
  }
  for (std::size_t k = 0; k < means.size(); ++k) means[k] = float(sum[k] / volume_[first + k]);
}

}  // namespace nepho::netcdf
