#pragma once

#include <memory>
#include <optional>

#include "bricks/lattice.h"
#include "bricks/shell_chart.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

struct LayoutOptions {
  std::optional<double> horizontal_resolution_m, vertical_resolution_m;
};

// The lattice that holds a forecast in its own resolution and aspect (lattice.md 1): columns about
// as wide as the model's cells (within a factor of 1.4), voxels about as high as its thin layers
// that hold cloud (Forecast::thinnest_layer_m).
struct Layout {
  std::shared_ptr<const ShellChart> chart;
  Lattice lattice{{}};
  double voxel_width_m = 0, voxel_height_m = 0;  // width at the middle of a cube face
  double extend_below_m = 0;                     // of the lowest layer
};

// Throws Error where the resolution makes more than a lattice can name, or than memory can hold.
Layout choose_layout(const Forecast& forecast, const LayoutOptions& options);

// Area-weighted median over the cells of the shorter side (m).
double cell_width_m(const HorizontalGrid& grid);

}  // namespace nepho::forecast
