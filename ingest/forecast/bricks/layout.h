#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bricks/lattice.h"
#include "bricks/shell_chart.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

struct LayoutOptions {
  std::optional<double> horizontal_resolution_m, vertical_resolution_m;
};

// The lattice that holds a forecast in its own resolution and aspect (lattice.md 1): columns about
// as wide as the model's cells (within a factor of 1.4), voxels about as high as its thin layers
// that hold cloud (Forecast::thinnest_layer_m). Nests share one lattice, the finest domain's, so
// that hats of both sides add up to one on every border.
struct Layout {
  std::shared_ptr<const ShellChart> chart;
  Lattice lattice{{}};
  double voxel_width_m = 0, voxel_height_m = 0;  // width at the middle of a cube face
  double extend_below_m = 0;                     // of the lowest layer
  double narrowest_cell_m = 0;                   // of the finest domain
  bool coarsened = false;  // nests whose finest cells everywhere would not fit memory
};

// Throws Error where the resolution makes more than a lattice can name, or than memory can hold.
Layout choose_layout(const Forecast& forecast, const LayoutOptions& options);

// Each of a forecast's domains once, at the first time it is drawn; finest first.
std::vector<DomainTime> all_domains(const Forecast& forecast);

}  // namespace nepho::forecast
