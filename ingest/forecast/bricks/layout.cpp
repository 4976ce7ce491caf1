#include "forecast/bricks/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "forecast/bricks/hat_remap.h"
#include "forecast/grids/cell_size.h"

namespace nepho::forecast {
namespace {

constexpr double kLeastHeight_m = 50;       // of a voxel, where nobody asks for less
constexpr double kMostSampleColumns = 3e7;  // 2 GB of rows and tiles
constexpr double kMostNestedColumns = 6e6;  // 2 GB, where nobody asked for as many

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

std::vector<DomainTime> all_domains(const Forecast& forecast) {
  std::vector<DomainTime> all;
  for (std::size_t time = 0; time < forecast.times_s().size(); ++time) {
    std::size_t at = 0;  // behind those that are known, so that the order stays
    for (const DomainTime& domain : forecast.domains(time)) {
      const auto known = std::ranges::find(all, domain.domain, &DomainTime::domain);
      if (known != all.end())
        at = std::size_t(known - all.begin()) + 1;
      else
        all.insert(all.begin() + std::ptrdiff_t(at++), domain);
    }
  }
  return all;
}

Layout choose_layout(const Forecast& forecast, const LayoutOptions& options) {
  const Ellipsoid body = Ellipsoid::wgs84();
  const double quarter_m = std::numbers::pi / 2 * body.equatorial_m;
  Layout layout;

  double area_m2 = 0;
  layout.narrowest_cell_m = 1e30;
  const std::vector<DomainTime> domains = all_domains(forecast);
  for (const auto& [domain, time] : domains) {
    const auto grid = domain->grid(time);
    layout.narrowest_cell_m = std::min(layout.narrowest_cell_m, cell_width_m(*grid));
    const std::vector<CellSize> sizes = some_cells(*grid);
    double mean_m2 = 0;
    for (const CellSize& size : sizes) mean_m2 += size.area_m2 / double(sizes.size());
    area_m2 += mean_m2 * double(grid->nx()) * grid->ny();
  }
  const double width_m = options.horizontal_resolution_m.value_or(layout.narrowest_cell_m);
  int horizontal = splits_for(quarter_m / width_m, options.horizontal_resolution_m.has_value());
  const auto sample_columns = [&] {
    layout.voxel_width_m = quarter_m / (kBrickCells * std::exp2(horizontal));
    return area_m2 / (layout.voxel_width_m * layout.voxel_width_m);
  };
  const bool nested = domains.size() > 1 && !options.horizontal_resolution_m;
  while (nested && horizontal > 0 && sample_columns() > kMostNestedColumns) {
    --horizontal;
    layout.coarsened = true;
  }
  if (horizontal > NodeKey::kMaxSplitsXy || sample_columns() > kMostSampleColumns)
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
