#include "gl/pixel_strides.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tree/view_metric.h"

namespace nepho::gl {
namespace {

constexpr double kPerVoxel = 1.5;

std::uint8_t stride_of(double voxel_pixels) {
#if defined(NEPHO_MUTANT_PIXEL_STRIDES)
  voxel_pixels = 1e9;
#endif
  const double most = kPerVoxel * voxel_pixels;
  return most >= 8 ? 8 : most >= 4 ? 4 : most >= 2 ? 2 : 1;
}

}  // namespace

PixelStrides pixel_strides(const RenderRequest& request, const Forest& forest) {
  const int columns = (request.settings.width + kStrideTile - 1) / kStrideTile;
  const int rows = (request.settings.height + kStrideTile - 1) / kStrideTile;
  PixelStrides strides;
  strides.x.assign(std::size_t(columns) * std::size_t(rows), 8);
  strides.y = strides.x;
  const ViewMetric metric(request.camera, request.settings, std::nullopt);
  for (const VolumeTree& tree : forest.volumes)
    for (const TreeNode& node : tree.nodes) {
      if (!node.seen || (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant))
        continue;
      const auto footprint = metric.footprint(tree.source->info(), node.key);
      if (!footprint) continue;
      // A constant leaf has no more in it than its own shape.
      const double finest = node.kind == NodeKind::kConstant ? kBrickCells : 1;
      const std::uint8_t stride_x = stride_of(finest * footprint->voxel_pixels.x);
      const std::uint8_t stride_y = stride_of(finest * footprint->voxel_pixels.y);
      if (stride_x == 8 && stride_y == 8) continue;
      const auto tile = [](double pixel, int count) {
        return int(std::clamp(std::floor(pixel / kStrideTile), -1.0, double(count)));
      };
      for (int y = std::max(tile(footprint->low.y, rows), 0);
           y <= std::min(tile(footprint->high.y, rows), rows - 1); ++y)
        for (int x = std::max(tile(footprint->low.x, columns), 0);
             x <= std::min(tile(footprint->high.x, columns), columns - 1); ++x) {
          const auto at = std::size_t(y * columns + x);
          strides.x[at] = std::min(strides.x[at], stride_x);
          strides.y[at] = std::min(strides.y[at], stride_y);
        }
    }
  return strides;
}

}  // namespace nepho::gl
