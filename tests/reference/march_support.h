#pragma once

#include <memory>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "field_source.h"
#include "reference/ray_march.h"
#include "reference/walk.h"

namespace nepho::test {

// Every brick of one level of one source, constant or not: full control over the cells.
class FixedLevel final : public LevelSet {
 public:
  FixedLevel(std::vector<const BrickSource*> sources, int level)
      : sources_(std::move(sources)), level_(level) {}
  std::size_t size() const override { return sources_.size(); }
  const VolumeInfo& info(std::size_t volume) const override { return sources_[volume]->info(); }
  LevelLeaf leaf(std::size_t volume, int root, const Index3& cell) const override {
    const Lattice& lattice = info(volume).lattice;
    const Index3 &n = lattice.cells(lattice.max_level()), &own = lattice.cells(level_);
    LevelLeaf leaf;
    leaf.key = {root, level_, cell[0] / (n[0] / own[0]) / 8, cell[1] / (n[1] / own[1]) / 8,
                cell[2] / (n[2] / own[2]) / 8};
    leaf.kind = NodeKind::kBrick;
    auto brick = std::make_shared<LeafBrick>();
    ChannelView view{.channel = Channel::kExtinction, .codes = brick->codes.data()};
    sources_[volume]->read(leaf.key, 0, {&view, 1});
    brick->scale = view.scale;
    brick->offset = view.offset;
    brick->max_abs_error = view.max_abs_error;
    leaf.brick = std::move(brick);
    return leaf;
  }

 private:
  std::vector<const BrickSource*> sources_;
  int level_;
};

inline std::shared_ptr<const Chart> box(double side_m, Periodic periodic = {},
                                        glm::dvec3 origin_m = glm::dvec3{0.0}) {
  return std::make_shared<BoxChart>(origin_m, glm::dmat3(side_m), periodic);
}

inline RenderVolume volume_of(const BrickSource& source, double asymmetry = 0.85) {
  RenderVolume volume;
  volume.source = &source;
  volume.phase = {.kind = PhaseKind::kHenyeyGreenstein, .asymmetry = asymmetry};
  return volume;
}

// One sun of irradiance 1 straight above, a black sky.
inline RenderRequest request_of(std::vector<RenderVolume> volumes, Light light = Light::kSingle) {
  RenderRequest request;
  request.volumes = std::move(volumes);
  request.settings.light = light;
  return request;
}

}  // namespace nepho::test
