#pragma once

#include <filesystem>

#include "nc_output.h"

namespace nepho::samples {

// Trade-wind cumulus as a large-eddy model writes them in CF NetCDF: height levels, a regular grid
// of latitudes and longitudes about `cell_m` apart, periodic in both. Bases are level at the
// condensation level; sizes follow a power law (Neggers et al. 2003, J. Atmos. Sci. 60: number
// ~ size^-1.7 up to a break); water grows with height over the base as a part of the adiabatic.
struct LesShape {
  std::size_t nx = 192, ny = 192, nz = 64;
  double cell_m = 40, level_m = 40;
  std::uint64_t seed = 11;
};

// One level is in memory at a time. Throws Error.
void write_les(const NcWriter& writer, const std::filesystem::path& path, const LesShape& shape);

}  // namespace nepho::samples
