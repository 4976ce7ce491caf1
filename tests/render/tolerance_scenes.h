#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analytic_field.h"
#include "cumulus.h"
#include "hash_noise.h"
#include "plume.h"
#include "scenes.h"

namespace nepho::test {

// What the integration along view rays is measured on: smooth and ragged, thin and thick, in boxes
// and on a shell, alone and overlapping.
struct MarchScene {
  std::string name;
  std::vector<std::shared_ptr<const BrickSource>> sources;
  RenderRequest request;
};

inline MarchScene march_scene(std::string name,
                              std::vector<std::shared_ptr<const BrickSource>> sources,
                              const glm::dvec3& eye_m, const glm::dvec3& target_m,
                              double vertical_fov_rad) {
  MarchScene scene{std::move(name), std::move(sources), request_of({})};
  for (const auto& source : scene.sources)
    scene.request.volumes.push_back(
        {.source = source.get(), .phase = Phase{PhaseKind::kHenyeyGreenstein, 10e-6, 0.85}});
  RenderSettings& settings = scene.request.settings;
  settings.light = Light::kOctaves;
  settings.width = 40;
  settings.height = 24;
  settings.pixels_per_voxel = 1e-3;  // the finest level, whatever the tolerance
  scene.request.camera = {eye_m, target_m, {0, 0, 1}, vertical_fov_rad};
  scene.request.sun = {glm::normalize(glm::dvec3(-0.6, 0.35, 0.55)), {1.6, 1.85, 2.0}};
  return scene;
}
inline void light_by_sky(MarchScene& scene) {
  scene.request.sky.zenith_W_per_m2_sr_nm = {0.02, 0.04, 0.08};
  scene.request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.07);
  scene.request.sky.below_W_per_m2_sr_nm = glm::dvec3(0.03);
}

template <class Field>
std::shared_ptr<const BrickSource> field_in_box(double size_m, double height_m, Lattice lattice,
                                                Field field, Periodic periodic = {}) {
  return std::make_shared<FieldSource>(box(size_m, height_m, periodic), std::move(lattice), field);
}

// A ball of 28 voxels' radius, smooth to its rim, of optical depth 8.
inline MarchScene smooth_ball() {
  const auto field = [](glm::dvec3 p) {
    const double r = glm::length(p - glm::dvec3(0, 0, 500)) / 440;
    return 0.017 * std::pow(std::max(0.0, 1 - r * r), 2);
  };
  return march_scene("smooth ball", {field_in_box(1000, 1000, isotropic(3), field)},
                     {300, -1700, 900}, {0, 0, 500}, 0.55);
}

// Smoke over a source, as stable fluids move it: sheets and curls of a few voxels.
inline MarchScene plume() {
  samples::PlumeSettings settings;
  settings.nx = settings.nz = 40;
  settings.ny = 64;
  settings.source_radius = 5;
  samples::Plume plume(settings);
  for (int step = 0; step < 70; ++step) plume.step();
  const auto field = [smoke = plume.smoke()](glm::dvec3 p) {
    const glm::vec3 cell(p.x / 10 + 19.5, p.z / 10 - 0.5, p.y / 10 + 19.5);
    if (std::abs(p.x) > 195 || std::abs(p.y) > 195 || p.z > 635) return 0.0;
    return 0.05 * double(smoke.sample(cell));
  };
  MarchScene scene = march_scene("plume", {field_in_box(640, 640, isotropic(3), field)},
                                 {200, -1100, 350}, {0, 0, 220}, 0.5);
  light_by_sky(scene);
  return scene;
}

// Thresholded noise with edges at every scale down to the voxel.
inline MarchScene ragged_noise() {
  const auto field = [](glm::dvec3 p) { return 8 * cloud(0.005 * p); };
  return march_scene("ragged noise", {field_in_box(1000, 1000, isotropic(3), field)},
                     {-700, -1500, 600}, {0, 0, 480}, 0.6);
}

// A cumulus of 40 m voxels with a level base, on a periodic field, under a bright sky.
inline MarchScene cumulus_field() {
  samples::CumulusShape shape;
  shape.voxel_m = 40;
  const samples::Cumulus cumulus(shape);
  const auto field = [cumulus](glm::dvec3 p) {
    return 0.06 * cumulus.density({p.x, p.z - 300, p.y});
  };
  MarchScene scene =
      march_scene("cumulus field",
                  {field_in_box(5120, 2560, Lattice({kSplitXyz, kSplitXyz, kSplitXyz, kSplitXy}),
                                field, {true, true})},
                  {0, -4500, 1500}, {0, 0, 1000}, 0.7);
  light_by_sky(scene);
  return scene;
}

// Optical depth 60 under soft faces of two voxels, without end to the sides.
inline MarchScene thick_slab() {
  const auto field = [](glm::dvec3 p) {
    return 0.1 * samples::smooth_step(150, 200, p.z) * (1 - samples::smooth_step(700, 750, p.z)) *
           (1 + 0.3 * std::sin(p.x / 160) * std::cos(p.y / 160));
  };
  return march_scene(
      "thick slab",
      {field_in_box(1005, 1000, Lattice({kSplitXyz, kSplitXyz}), field, {true, true})},
      {0, -900, 1500}, {0, 200, 650}, 0.8);
}

// Streaks of ice that lean with the wind, of optical depth 0.02 to 0.5, against a bright sky.
inline MarchScene thin_cirrus() {
  const auto field = [](glm::dvec3 p) {
    const glm::dvec3 leaning(p.x - 0.9 * p.z, 0.35 * p.y, 0.4 * p.z);
    const double streaks = samples::fractal_noise(leaning / 900.0, 3, 5);
    return 3e-4 * std::max(0.0, streaks) * samples::smooth_step(0, 500, p.z) *
           (1 - samples::smooth_step(1000, 1500, p.z));
  };
  MarchScene scene = march_scene(
      "thin cirrus", {field_in_box(12e3, 1500, Lattice({kSplitXy, kSplitXyz, kSplitXyz}), field)},
      {0, -9000, -3000}, {0, 0, 700}, 0.7);
  light_by_sky(scene);
  return scene;
}

// Weather systems on a planet's shell, 240 m layers under 150 km cells: a global forecast's shape.
inline MarchScene forecast_shell() {
  const auto field = [](glm::dvec3 p) {
    const double height_m = geodetic_height_m(Ellipsoid::wgs84(), p);
    const glm::dvec3 at = p / 6.4e6;
    const double wet = samples::fractal_noise(at * 5.0, 4, 3);
    const double top_m = 6000 + 5000 * samples::fractal_noise(at * 3.0, 2, 9);
    return 2e-3 * std::max(0.0, wet) * samples::smooth_step(1000, 2000, height_m) *
           (1 - samples::smooth_step(top_m - 1500, top_m, height_m));
  };
  MarchScene scene = march_scene(
      "forecast shell",
      {std::make_shared<FieldSource>(std::make_shared<ShellChart>(Ellipsoid::wgs84(), 0, 16000),
                                     Lattice({kSplitXyz, kSplitXyz, kSplitXyz}), field)},
      {}, {}, 0.8);
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.5, 0.6, 0.55));
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
  scene.request.camera = {6.9e6 * up, 6.38e6 * up + 9e5 * east, up, 0.9};
  scene.request.sun.to_sun = glm::normalize(up + 0.8 * east);
  scene.request.sky.up = up;
  light_by_sky(scene);
  return scene;
}

// Ragged cloud in a haze whose voxels are others.
inline MarchScene cloud_in_haze() {
  const auto clumps = [](glm::dvec3 p) { return 8 * cloud(0.005 * p) + 1.5 * puffs(0.001 * p); };
  const auto haze = [](glm::dvec3 p) {
    return 1e-3 * std::exp(-p.z / 300) * (1 + 0.3 * std::sin(p.x / 90));
  };
  MarchScene scene = march_scene(
      "cloud in haze",
      {field_in_box(1000, 1000, isotropic(3), clumps), field_in_box(1400, 700, isotropic(2), haze)},
      {-700, -1500, 600}, {0, 0, 480}, 0.75);
  light_by_sky(scene);
  return scene;
}

using MakeMarchScene = std::function<MarchScene()>;
inline const std::vector<std::pair<std::string, MakeMarchScene>>& march_scenes() {
  static const std::vector<std::pair<std::string, MakeMarchScene>> scenes = {
      {"smooth ball", smooth_ball},       {"plume", plume},
      {"ragged noise", ragged_noise},     {"cumulus field", cumulus_field},
      {"thick slab", thick_slab},         {"thin cirrus", thin_cirrus},
      {"forecast shell", forecast_shell}, {"cloud in haze", cloud_in_haze}};
  return scenes;
}

}  // namespace nepho::test
