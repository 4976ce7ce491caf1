#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bricks/brick_source.h"
#include "scene/scene.h"
#include "tree/light_tiles.h"

namespace nepho {

// Bricks to light. Knows nothing of where bricks come from, of windows or of picture files.

struct RenderVolume {
  const BrickSource* source = nullptr;  // outlives the renderer
  double time_s = 0;
  Phase phase;
  Phase ice_phase{PhaseKind::kHenyeyGreenstein, 30e-6, 0.75};  // of channel kIceExtinction
  glm::dvec3 co_albedo{0.0};
};

struct RenderRequest {
  std::vector<RenderVolume> volumes;
  Camera camera;
  Sun sun;
  Sky sky;  // without a planet: background and light
  // With it: its ground and air are the background, light the clouds and stand before them; `sky`
  // is not used. The ground's shape is `terrain`, or that of the first volume that has a surface
  // map.
  std::optional<Planet> planet;
  const SurfaceMap* terrain = nullptr;  // in place of the volumes'; outlives the renderer
  RenderSettings settings;
  // For tests: does also what was predicted to change nothing (RenderReport::left_out).
  bool leave_nothing_out = false;
  // Compiles what any tree of these volumes may need, so that a view that moves compiles once.
  bool any_tree = false;
  // The view pass also tells how far away what it sees is (gl::PixelValues::depths), to a program
  // that was compiled with gl::kDepthSwitch.
  bool keep_depths = false;
  // For tests: marches the light of all samples, each where it is (gl/light_samples.h).
  bool march_all_light = false;
  bool keep_lights = false;    // for tests: RenderResult::lights
  bool count_samples = false;  // for tests: RenderReport::samples
  // For tests: of the light passes, so that pictures of unlike steps have the same light.
  std::optional<double> light_step_voxels = {};
};

// Linear HDR, row 0 at the top: radiance r, g, b (W m-2 sr-1 nm-1) and the view optical depth.
struct HdrImage {
  int width = 0, height = 0;
  std::vector<float> rgb;            // 3 per pixel
  std::vector<float> optical_depth;  // 1 per pixel
};

// Each: rms over pixels with optical depth > 0.01 (over a planet: over all, but for the sun's disc)
// of the luminance difference, over those pixels' mean luminance. Negative: not measured.
struct ErrorEstimate {
  double integration = -1, level_of_detail = -1, quantisation = -1, light_model = -1;
  int probe_pixels = 0;           // on which the first three were measured
  std::string light_model_basis;  // "16 paths a pixel", or "table, slabs"
};

struct PassReport {
  std::string name;
  double cpu_s = 0;   // process CPU time
  double gpu_s = -1;  // by the GPU's own clock; -1: it tells none (gl/gpu_clock.h)
};
struct VolumeReport {
  std::string name;
  std::uint64_t nodes = 0, bricks = 0, constant_nodes = 0, empty_nodes = 0, sun_tiles = 0;
  int finest_level_used = 0, finest_level = 0;
};
// What the view pass looked up, in all; counted on request.
struct SampleCounts {
  double rays = 0, extinction = 0, source = 0;
};
struct RenderReport {
  std::string device;                        // GL_RENDERER, GL_VERSION
  std::vector<std::string> shader_switches;  // what the compiled shaders hold
  std::vector<std::string> left_out;         // what this scene did not need
  std::vector<PassReport> passes;
  std::vector<VolumeReport> volumes;
  SampleCounts samples;
  bool budget_bound = false;  // more memory would refine the tree
  std::uint64_t atlas_bytes = 0, sun_bytes = 0, node_bytes = 0, staging_bytes = 0;  // in the budget
  std::uint64_t image_bytes = 0, source_bytes = 0, planet_bytes = 0;                // apart from it
};

struct RenderResult {
  HdrImage image;
  ErrorEstimate error;
  RenderReport report;
  std::shared_ptr<const LightTiles> lights = {};  // where they were to be kept
};

// Needs a current OpenGL 4.5 core context. Throws Error where GL refuses or the budget is too small
// for the roots.
RenderResult render(const RenderRequest& request);

}  // namespace nepho
