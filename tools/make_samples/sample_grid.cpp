#include "sample_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/error.h"
#include "loaded_module.h"

namespace nepho::samples {
namespace {

// The writer pulls one block after the other.
struct Feed {
  const SampleGrid* grid;
  std::size_t at = 0;
};

bool next_block(void* context, VdbBlock* block) {
  Feed& feed = *static_cast<Feed*>(context);
  if (feed.at == feed.grid->blocks.size()) return false;
  const SampleBlock& from = feed.grid->blocks[feed.at++];
  std::ranges::copy(from.origin, block->origin);
  block->size = from.size;
  block->values = from.values.empty() ? nullptr : from.values.data();
  block->tile = from.tile;
  block->all_active = feed.grid->all_active;
  return true;
}

VdbGridSpec spec_of(const SampleGrid& grid, Feed& feed, std::vector<VdbMetadatum>& metadata) {
  for (const SampleMetadatum& m : grid.metadata)
    metadata.push_back(
        {m.name.c_str(), m.is_text ? m.text.c_str() : nullptr, {m.ijk[0], m.ijk[1], m.ijk[2]}});
  VdbGridSpec spec{};
  spec.name = grid.name.c_str();
  spec.value = grid.value;
  spec.grid_class = grid.grid_class;
  for (int a = 0; a < 3; ++a) {
    spec.translation[a] = grid.translation[a];
    for (int b = 0; b < 3; ++b) spec.columns[a][b] = grid.columns[a][b];
  }
  spec.background = grid.background;
  spec.metadata = metadata.data();
  spec.metadata_count = metadata.size();
  spec.next = next_block;
  spec.context = &feed;
  return spec;
}

}  // namespace

std::vector<SampleBlock> sample(const Voxel& low, const Voxel& high, const VoxelField& field) {
  Voxel first{}, count{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = low[a] & ~7;
    count[a] = (high[a] - first[a]) / 8 + 1;
  }
  std::vector<SampleBlock> blocks(std::size_t(count[0]) * std::size_t(count[1]) *
                                  std::size_t(count[2]));
  tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t index) {
    const auto x = std::int32_t(index % std::size_t(count[0]));
    const auto y = std::int32_t(index / std::size_t(count[0]) % std::size_t(count[1]));
    const auto z = std::int32_t(index / std::size_t(count[0]) / std::size_t(count[1]));
    SampleBlock& block = blocks[index];
    block.origin = {first[0] + 8 * x, first[1] + 8 * y, first[2] + 8 * z};
    std::vector<double> values(512);
    bool any = false;
    for (std::int32_t at = 0; at < 512; ++at) {
      const Voxel v = {block.origin[0] + at % 8, block.origin[1] + at / 8 % 8,
                       block.origin[2] + at / 64};
      bool inside = true;
      for (std::size_t a = 0; a < 3; ++a) inside = inside && v[a] >= low[a] && v[a] <= high[a];
      double& value = values[std::size_t(at)];
      value = inside ? field(v) : 0;
      any = any || value != 0;
    }
    if (any) block.values = std::move(values);
  });
  std::erase_if(blocks, [](const SampleBlock& block) { return block.values.empty(); });
  return blocks;
}

VdbWriter::VdbWriter(const std::vector<std::filesystem::path>& folders)
    : write_(load_writer(folders, "nepho_vdb_writer.so", ".vdb",
                         "build with OpenVDB (package libopenvdb-dev)")
                 .function<vdb_write_fn>("nepho_vdb_write")) {}

void VdbWriter::write(const std::filesystem::path& path, const std::vector<SampleGrid>& grids,
                      const std::string& creator, bool write_statistics) const {
  std::vector<Feed> feeds;
  for (const SampleGrid& grid : grids) feeds.push_back({&grid});
  std::vector<std::vector<VdbMetadatum>> metadata(grids.size());
  std::vector<VdbGridSpec> specs;
  for (std::size_t at = 0; at < grids.size(); ++at)
    specs.push_back(spec_of(grids[at], feeds[at], metadata[at]));
  const std::string file = path.string();
  const VdbFileSpec spec = {file.c_str(), specs.data(), specs.size(),
                            creator.empty() ? nullptr : creator.c_str(), write_statistics};
  char reason[512] = {};
  if (write_(&spec, reason, sizeof reason) != 0)
    throw Error({"cannot write the file", file, "a writable place with room", reason, ""});
}

}  // namespace nepho::samples
