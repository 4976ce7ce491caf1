#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace nepho::test {

// The active voxels of a float or double grid as OpenVDB itself reads them, cleaned as the source
// says it cleans: NaN, infinite and negative values are 0.
struct OracleVoxel {
  glm::dvec3 world;  // by OpenVDB's indexToWorld
  double value;
};
std::vector<OracleVoxel> active_voxels(const std::string& file, const std::string& grid);

// Writes a fog grid with a frustum transform.
void write_frustum(const std::string& file);

}  // namespace nepho::test
