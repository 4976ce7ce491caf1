#include "gl/pixel_strides.h"

#include <algorithm>
#include <cmath>

#include "gl/pixel_plan.h"
#include "tree/view_metric.h"

namespace nepho::gl {
namespace {

std::uint8_t stride_of(double voxel_pixels) {
  return voxel_pixels >= 4 ? 4 : voxel_pixels >= 2 ? 2 : 1;
}

}  // namespace

std::vector<std::uint8_t> pixel_strides(const RenderRequest& request, const Forest& forest) {
  const int columns = (request.settings.width + kStrideTile - 1) / kStrideTile;
  const int rows = (request.settings.height + kStrideTile - 1) / kStrideTile;
  std::vector<std::uint8_t> strides(std::size_t(columns) * std::size_t(rows), 4);
#if !defined(NEPHO_MUTANT_PIXEL_STRIDES)
  const ViewMetric metric(request.camera, request.settings);
  for (const VolumeTree& tree : forest.volumes)
    for (const TreeNode& node : tree.nodes) {
      if (!node.seen || (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant))
        continue;
      const auto footprint = metric.footprint(tree.source->info(), node.key);
      if (!footprint) continue;
      // A constant leaf has no more in it than its own shape.
      const double finest = node.kind == NodeKind::kConstant ? kBrickCells : 1;
      const std::uint8_t stride = stride_of(finest * footprint->voxel_pixels);
      if (stride == 4) continue;
      const auto tile = [](double pixel, int count) {
        return int(std::clamp(std::floor(pixel / kStrideTile), -1.0, double(count)));
      };
      for (int y = std::max(tile(footprint->low.y, rows), 0);
           y <= std::min(tile(footprint->high.y, rows), rows - 1); ++y)
        for (int x = std::max(tile(footprint->low.x, columns), 0);
             x <= std::min(tile(footprint->high.x, columns), columns - 1); ++x) {
          std::uint8_t& least = strides[std::size_t(y * columns + x)];
          least = std::min(least, stride);
        }
    }
#endif
  return strides;
}

}  // namespace nepho::gl
