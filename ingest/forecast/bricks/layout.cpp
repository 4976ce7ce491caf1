#include "forecast/bricks/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/bricks/hat_remap.h"

namespace nepho::forecast {
namespace {

constexpr double kLeastHeight_m = 50;       // of a voxel, where nobody asks for less
constexpr double kMostSampleColumns = 3e7;  // 2 GB of rows and tiles

struct CellSize {
  double width_m, area_m2;
};

std::vector<CellSize> some_cells(const HorizontalGrid& grid) {
  const double radius_m = Ellipsoid::wgs84().equatorial_m;
  std::vector<CellSize> sizes;
  if (const CellPolygons* polygons = grid.polygons()) {
    const std::size_t cells = polygons->first.size() - 1;
    // Cells without corners are of no size: all are looked at where none of some has any.
    for (std::size_t step = std::max<std::size_t>(1, cells / 1024); sizes.empty() && step > 0;
         step = step > 1 ? 1 : 0)
      for (std::size_t cell = 0; cell < cells; cell += step)
        if (const double width_m = radius_m * polygon_width_rad(*polygons, cell); width_m > 0)
          sizes.push_back({width_m, width_m * width_m});
    return sizes;
  }
  const int step_x = std::max(1, grid.nx() / 32), step_y = std::max(1, grid.ny() / 32);
  for (int j = 0; j < grid.ny(); j += step_y)
    for (int i = 0; i < grid.nx(); i += step_x) {
      const auto at = [&](double x, double y) { return unit_vector(grid.lat_lon_deg(x, y)); };
      const double x_m = radius_m * glm::length(at(i + 1, j + 0.5) - at(i, j + 0.5));
      const double y_m = radius_m * glm::length(at(i + 0.5, j + 1) - at(i + 0.5, j));
      if (!std::isnan(x_m * y_m)) sizes.push_back({std::min(x_m, y_m), x_m * y_m});
    }
  return sizes;
}

// Columns at least as narrow as asked; of the model's own width the nearest power of two, where its
// cells are so wide (500 km) that their edges' curvature counts the next.
int splits_for(double cells, bool asked) {
  const double exact = std::log2(cells / kBrickCells);
  return std::max(0, int(asked || exact < 1.5 ? std::ceil(exact - 1e-9) : std::round(exact)));
}

[[noreturn]] void too_fine(const char* parameter, double asked_m) {
  throw Error({"the resolution is too fine", std::string("parameter '") + parameter + "'",
               "a lattice that fits memory and the bits of a node's key",
               std::to_string(asked_m) + " m", "choose a coarser resolution"});
}

// xy until a voxel is no wider than it is at the finest level, times its height; then xyz.
std::vector<SplitMask> split_axes(int horizontal, int vertical) {
  std::vector<SplitMask> masks;
  for (int n = vertical; n < horizontal; ++n) masks.push_back(kSplitXy);
  for (int n = horizontal; n < vertical; ++n) masks.push_back(kSplitZ);
  for (int n = 0; n < std::min(horizontal, vertical); ++n) masks.push_back(kSplitXyz);
  return masks;
}

}  // namespace

double cell_width_m(const HorizontalGrid& grid) {
  std::vector<CellSize> sizes = some_cells(grid);
  std::ranges::sort(sizes, {}, &CellSize::width_m);
  double total = 0, below = 0;
  for (const CellSize& size : sizes) total += size.area_m2;
  for (const CellSize& size : sizes)
    if ((below += size.area_m2) >= total / 2) return size.width_m;
  return sizes.back().width_m;
}

Layout choose_layout(const Forecast& forecast, const LayoutOptions& options) {
  const Ellipsoid body = Ellipsoid::wgs84();
  const double quarter_m = std::numbers::pi / 2 * body.equatorial_m;
  const auto grid = forecast.grid(0);
  Layout layout;

  const double width_m = options.horizontal_resolution_m.value_or(cell_width_m(*grid));
  const int horizontal =
      splits_for(quarter_m / width_m, options.horizontal_resolution_m.has_value());
  double area_m2 = 0;
  const std::vector<CellSize> sizes = some_cells(*grid);
  for (const CellSize& size : sizes) area_m2 += size.area_m2 / double(sizes.size());
  area_m2 *= double(grid->nx()) * grid->ny();
  layout.voxel_width_m = quarter_m / (kBrickCells * std::exp2(horizontal));
  if (horizontal > NodeKey::kMaxSplitsXy ||
      area_m2 / (layout.voxel_width_m * layout.voxel_width_m) > kMostSampleColumns)
    too_fine("horizontal_resolution_m", width_m);

  // From two voxels below the lowest ground, so that hats there have a layer to hold, to the top.
  const glm::dvec2 range_m = forecast.height_range_m();
  const double asked_m =
      options.vertical_resolution_m.value_or(std::max(kLeastHeight_m, forecast.thinnest_layer_m()));
  const double top_m = chart_height_m(body, 90, range_m.y);
  const double least_m =
      std::min(chart_height_m(body, 0, range_m.x), chart_height_m(body, 90, range_m.x));
  const double tall_m = top_m - least_m + 3 * asked_m;
  const double exact = std::log2(tall_m / asked_m / kBrickCells);
  // The nearest power of two; finer than asked only where the user asked.
  const int vertical = std::max(
      0, options.vertical_resolution_m ? int(std::ceil(exact - 1e-9)) : int(std::lround(exact)));
  if (vertical > NodeKey::kMaxSplitsZ) too_fine("vertical_resolution_m", asked_m);
  const double cells = kBrickCells * std::exp2(vertical);
  layout.voxel_height_m = tall_m / cells;
  if (!options.vertical_resolution_m)
    layout.voxel_height_m = std::max(layout.voxel_height_m, kLeastHeight_m);
  layout.extend_below_m = 2 * layout.voxel_height_m;
  const double bottom_m = least_m - 2.5 * layout.voxel_height_m;
  layout.chart = std::make_shared<ShellChart>(
      body, bottom_m, std::max(bottom_m + cells * layout.voxel_height_m, top_m));
  layout.voxel_height_m = layout.chart->thickness_m() / cells;
  layout.lattice = Lattice(split_axes(horizontal, vertical));
  return layout;
}

}  // namespace nepho::forecast
