#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "vdb_writer.h"

namespace nepho::samples {

using Voxel = std::array<std::int32_t, 3>;

// One grid of a .vdb file to be: sparse blocks, as the writer takes them.
struct SampleBlock {
  Voxel origin{};
  std::int32_t size = 8;
  std::vector<double> values;  // 8^3, x fastest; empty: a tile
  double tile = 0;
};
struct SampleMetadatum {
  std::string name, text;
  Voxel ijk{};
  bool is_text = true;
};
struct SampleGrid {
  std::string name = "density";
  VdbValue value = VdbValue::kFloat;
  VdbClass grid_class = VdbClass::kFog;
  glm::dmat3 columns{1.0};  // index steps in the file's world units
  glm::dvec3 translation{0.0};
  double background = 0;
  bool all_active = false;
  std::vector<SampleMetadatum> metadata;
  std::vector<SampleBlock> blocks;
};

using VoxelField = std::function<double(const Voxel&)>;

// Blocks of the voxels in low..high (both included) where the field is not 0; parallel.
std::vector<SampleBlock> sample(const Voxel& low, const Voxel& high, const VoxelField& field);

// Writes files through nepho_vdb_writer.so, found in the module folders.
class VdbWriter {
 public:
  // Throws Error where the module is missing.
  explicit VdbWriter(const std::vector<std::filesystem::path>& folders);
  // Throws Error with the writer's reason.
  void write(const std::filesystem::path& path, const std::vector<SampleGrid>& grids,
             const std::string& creator = "nephoscope make_samples",
             bool write_statistics = true) const;

 private:
  vdb_write_fn* write_;
};

}  // namespace nepho::samples
