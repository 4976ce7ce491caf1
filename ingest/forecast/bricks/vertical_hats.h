#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bricks/shell_chart.h"
#include "forecast/bricks/hat_remap.h"
#include "forecast/bricks/layer_profile.h"

namespace nepho::forecast {

// One column of a model: nz layers from the ground up.
struct ModelColumn {
  double latitude_deg = 0;
  std::span<const float> interface_m;  // nz + 1, rising
  std::span<const float> value_per_m;  // nz
};

// Means of a column's layers over the vertical hats of a ShellChart's level:
//   c_k = sum over layers int beta(r) Lambda_k r^2 dr / int Lambda_k r^2 dr
// A piece of a constant layer in a voxel is a cubic, which two Gauss points integrate exactly; a
// piece of a parabola in volume is of a higher degree than five only by the curvature of the
// planet: three points integrate it closer than a float tells.
class VerticalHats {
 public:
  VerticalHats(const ShellChart& chart, std::uint32_t cells_z, const RemapOptions& options);

  struct Range {
    std::uint32_t first = 0, count = 0;  // samples that hold something
    glm::dvec2 cloudy_m{0.0};            // lowest and highest interface of layers with cloud
  };
  Range range(const ModelColumn& column) const;
  // Means of samples first .. first + means.size(), which range() gave, of the column's value or of
  // a part of it (nz, 1/m). What is clear in all is clear in part, and within a smooth layer a part
  // is the same share of the whole everywhere: no mean of it exceeds that of the whole.
  void means(const ModelColumn& column, std::span<const float> part_per_m, std::uint32_t first,
             std::span<float> means) const {
    this->means(column, smooth(column), part_per_m, first, means);
  }
  // The same of several parts of one column, which is smoothed once.
  struct SmoothColumn;
  void means(const ModelColumn& column, const SmoothColumn& inside,
             std::span<const float> part_per_m, std::uint32_t first, std::span<float> means) const;

  // A column's layers as parabolas in volume; empty where layers stay constant.
  struct SmoothColumn {
    ChartHeight up_m;
    std::vector<double> below;      // volume below each interface, int r^2 dr from r = a, over a^3
    std::vector<Parabola> profile;  // of each layer
    // Within a layer, at r = a (1 + up).
    double value_per_m(std::size_t layer, double up) const;
  };
  SmoothColumn smooth(const ModelColumn& column) const;

 private:
  bool clear(const ModelColumn& column, std::size_t layer) const;
  // Bottom and top of a layer in voxels above the chart's bottom.
  glm::dvec2 extent(const ModelColumn& column, const ChartHeight& up_m, std::size_t layer) const;
  // Adds a layer's integral under each hat from `first` on (1/m times voxels).
  template <class Rule, class Extinction>
  void add_layer(glm::dvec2 extent, const Rule& rule, Extinction&& extinction_per_m,
                 std::uint32_t first, std::span<double> sum) const;

  const ShellChart& chart_;
  std::uint32_t cells_;
  double voxel_m_;
  RemapOptions options_;
  std::vector<double> volume_;  // of each hat, over a^2 voxel_m
};

}  // namespace nepho::forecast
