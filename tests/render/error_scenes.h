#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/open_scene.h"
#include "renderer.h"

namespace nepho::test {

// Scenes of eight kinds, small, on which errors that are stated are held against whole pictures:
// drawn shapes, a thick slab, a box of noise, a plume in a VDB, an LES, a forecast, and a
// procedural planet from its ground and from space. The files are those of make_samples --size
// small, in NEPHO_TEST_SAMPLES.
struct ErrorScene {
  OpenedScene opened;  // of files and modules; empty where fields are drawn here
  RenderRequest request;
};

struct ErrorSceneKind {
  std::string name;
  std::function<ErrorScene()> make;
  int paths;  // a pixel, of a path-traced picture of 16 x 9 that tells the light model's error
};

const std::vector<ErrorSceneKind>& error_scenes();
// Clouds so thin that light between voxels is no limit: 1 % is within reach of the march.
const std::vector<ErrorSceneKind>& thin_scenes();

}  // namespace nepho::test
