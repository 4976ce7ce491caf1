#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bricks/shell_chart.h"
#include "sources/netcdf/hat_remap.h"

namespace nepho::netcdf {

// One column of a model: nz layers from the ground up.
struct ModelColumn {
  double latitude_deg;
  std::span<const float> interface_m;  // nz + 1, rising
  std::span<const float> value_per_m;  // nz
  // Whose smallness says that a layer is clear; empty: the values' own.
  std::span<const float> clear_where = {};
};

// Means of a column's layers over the vertical hats of a ShellChart's level:
//   c_k = sum over layers beta int Lambda_k r^2 dr / int Lambda_k r^2 dr
// exactly: a piece of a layer in a voxel is a cubic, which two Gauss points integrate.
class VerticalHats {
 public:
  VerticalHats(const ShellChart& chart, std::uint32_t cells_z, const RemapOptions& options);

  struct Range {
    std::uint32_t first = 0, count = 0;  // samples that hold something
    glm::dvec2 cloudy_m{0.0};            // lowest and highest interface of layers with cloud
  };
  Range range(const ModelColumn& column) const;
  // Means of samples first .. first + means.size(), which range() gave.
  void means(const ModelColumn& column, std::uint32_t first, std::span<float> means) const;

 private:
  bool clear(const ModelColumn& column, std::size_t layer) const;
  // Bottom and top of a layer in voxels above the chart's bottom.
  glm::dvec2 extent(const ModelColumn& column, std::size_t layer) const;

  const ShellChart& chart_;
  std::uint32_t cells_;
  double voxel_m_;
  RemapOptions options_;
  std::vector<double> volume_;  // of each hat, over a^2 voxel_m
};

}  // namespace nepho::netcdf
