#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "nc_output.h"

namespace nepho::samples {

// Small synthetic twins of the traps in real NetCDF files: `file` in the folder, a cloud over 47 N
// 8 E. Those that a reader must refuse come last.
struct NcTwin {
  std::string name, what;
  std::function<void(const std::filesystem::path& folder, const NcWriter&)> write;
  std::string file;
};
const std::vector<NcTwin>& nc_twins();

// The cloud of the CF twins: kg of liquid water per kg of air, at a place.
double twin_water(double lat_deg, double lon_deg, double height_m);

}  // namespace nepho::samples
