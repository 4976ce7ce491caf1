#pragma once

#include <functional>
#include <string>
#include <vector>

#include "made_grid.h"

namespace nepho::samples {

// Vertical coordinates for tests of readers, by formulas of their own: 20 levels in the troposphere
// of the US Standard Atmosphere, above hills. nothing here knows a reader.
struct MadeVertical {
  std::string name;
  // Heights (m, over the sea) of all interfaces of a cell as the file says them, from the ground
  // up.
  std::function<std::vector<double>(const MadeCell&)> interfaces_m;
  // Adds the axis "lev" and all that gives levels their place; fields are lev x the grid's axes.
  std::function<void(TinyFile&, const MadeGrid&)> write;
};

const std::vector<std::string>& made_vertical_names();
// Throws Error on another name.
MadeVertical made_vertical(const std::string& name);

// Levels from the ground up and rows as the grid has them ("up"), or both turned round ("down"); a
// cloud of `made_content` in four layers, `made_low_layer` and above, of the grid's cloudy cells.
// Throws Error on another order.
void write_made(const std::filesystem::path& path, const std::string& grid,
                const std::string& vertical, const std::string& order, const NcWriter& writer);
inline constexpr double kMadeContent_g_per_m3 = 0.5;
inline constexpr std::size_t kMadeLowLayer = 6, kMadeHighLayer = 9;

}  // namespace nepho::samples
