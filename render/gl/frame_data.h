#pragma once

#include <cstddef>
#include <vector>

#include "renderer.h"
#include "shaders/frame.layout.h"
#include "tree/forest.h"

namespace nepho::gl {

// Scene and forest as the shaders read them.

static_assert(sizeof(NodeRecord) == 16 && sizeof(BrickRecord) == 8 && sizeof(LitRecord) == 24);
static_assert(offsetof(FrameData, ground_radius_m) == 192 && sizeof(FrameData) == 280);
static_assert(offsetof(VolumeData, radius_m) == 168 && offsetof(VolumeData, chart) == 208);
static_assert(offsetof(VolumeData, levels) == 240 && sizeof(VolumeData) == 400);

struct GpuScene {
  FrameData frame{};
  std::vector<VolumeData> volumes;
  std::vector<NodeRecord> nodes;
  std::vector<BrickRecord> bricks;
  std::vector<BrickRecord> ice;  // beside `bricks`; none where no volume tells ice apart
  std::vector<LitRecord> lit;
  std::vector<float> phases;  // rows of 1024 x 3: log of the phase function, 1/sr
  bool has_box = false, has_shell = false, absorbs = false, sky = false, has_ice = false;
  double widest_leaf_rad = 0;  // of all leaves with extinction on a shell
};

// What refinement goes by: the request, and what its tiles cost here.
Refinement refinement_of(const RenderRequest& request);
// A sky that is not black, or air, lights the clouds: the light tiles then hold the sky's
// visibility too.
bool sky_lights(const RenderRequest& request);
// Whether a volume has ice beside its extinction: there is then a second atlas.
bool tells_ice(const RenderRequest& request);

// Eye and basis of a picture of `settings`' size, and that size.
void set_camera(FrameData& frame, const Camera& camera, const RenderSettings& settings);

GpuScene make_gpu_scene(const RenderRequest& request, const Forest& forest);

}  // namespace nepho::gl
