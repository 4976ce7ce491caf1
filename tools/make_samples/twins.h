#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sample_grid.h"

namespace nepho::samples {

// Small synthetic twins of the traps in real VDB files. `file` is what a scene would name: a file
// or, for sequences, a pattern.
struct Twin {
  std::string name, what;
  std::function<void(const std::filesystem::path& folder, const VdbWriter&)> write;
  std::string file;
};
const std::vector<Twin>& twins();

// The field of most twins: a puff around (12, 9, 7) of radius 20 voxels, 0 < value <= 1.
double puff(const Voxel& voxel);
SampleGrid puff_grid();

// Two clouds `apart_m` from each other, of 3.4 m voxels: `active` voxels in all.
SampleGrid far_pair(double apart_m, double active);

}  // namespace nepho::samples
