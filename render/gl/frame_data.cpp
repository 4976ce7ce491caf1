#include "gl/frame_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "gl/atlas.h"
#include "gl/node_grid.h"
#include "optics/phase_table.h"
#include "tree/source_verbs.h"

namespace nepho::gl {
namespace {

template <class Number, std::size_t N, class Vector>
void store(Number (&to)[N], const Vector& from) {
  for (std::size_t i = 0; i < N; ++i) to[i] = Number(from[int(i)]);
}

// A direction across `up`, whichever.
glm::dvec3 across(const glm::dvec3& up) {
  const glm::dvec3 other = std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(up, other));
}

void set_light(FrameData& frame, const RenderRequest& request) {
  store(frame.to_sun, glm::normalize(request.sun.to_sun));
  store(frame.sun_irradiance, request.sun.irradiance_W_per_m2_nm);
  const glm::dvec3 up = glm::normalize(request.sky.up), east = across(up);
  const glm::dvec3 north = glm::cross(up, east);
  for (int i = 0; i < 3; ++i) {
    frame.sky_axes[i] = up[i];
    frame.sky_axes[3 + i] = east[i];
    frame.sky_axes[6 + i] = north[i];
  }
  store(frame.zenith, request.sky.zenith_W_per_m2_sr_nm);
  store(frame.horizon, request.sky.horizon_W_per_m2_sr_nm);
  store(frame.below, request.sky.below_W_per_m2_sr_nm);
}

// log2 of a cell's size in finest cells, per axis.
std::array<int, 3> shifts(const Lattice& lattice, int level) {
  std::array<int, 3> result{};
  for (std::size_t a = 0; a < 3; ++a)
    result[a] = std::countr_zero(lattice.cells(lattice.max_level())[a] / lattice.cells(level)[a]);
  return result;
}

void set_box(VolumeData& data, const BoxChart& box) {
  data.chart = 0;
  data.periodic = (box.periodic().x ? 1 : 0) | (box.periodic().y ? 2 : 0);
  store(data.origin_m, box.origin_m());
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 3; ++c) {
      data.to_cells[3 * axis + c] = data.cells[axis] * box.inverse_edges()[c][axis];
      data.from_cells[3 * axis + c] = box.edges_m()[axis][c] / data.cells[axis];
    }
}

void set_shell(VolumeData& data, FrameData& frame, const ShellChart& shell) {
  const Ellipsoid& body = shell.body();
  data.chart = 1;
  data.radius_m = body.equatorial_m;
  data.z_scale = body.equatorial_m / body.polar_m;
  data.bottom_m = shell.bottom_m();
  data.cell_rad = 0.5 * std::numbers::pi / data.cells[0];
  data.cell_height_m = shell.thickness_m() / data.cells[2];
  // The planet's body, below whatever holds fog: the lowest of the shells' grounds.
  const double ground_m = body.equatorial_m + std::min(0.0, shell.bottom_m());
  if (frame.ground_radius_m == 0 || ground_m < frame.ground_radius_m) {
    frame.ground_radius_m = ground_m;
    frame.ground_z_scale = data.z_scale;
  }
}

int phase_row(GpuScene& scene, std::vector<Phase>& rows, const Phase& phase) {
  const auto same = [&](const Phase& other) {
    return other.kind == phase.kind && other.effective_radius_m == phase.effective_radius_m &&
           other.asymmetry == phase.asymmetry;
  };
  const auto at = std::ranges::find_if(rows, same);
  if (at != rows.end()) return int(at - rows.begin());
  const std::vector<float> row = phase_table(phase);
  scene.phases.insert(scene.phases.end(), row.begin(), row.end());
  rows.push_back(phase);
  return int(rows.size()) - 1;
}

VolumeData make_volume(GpuScene& scene, const BrickSource& source) {
  const VolumeInfo& info = source.info();
  const Lattice& lattice = info.lattice;
  VolumeData data{};
  data.max_level = lattice.max_level();
  data.first_node = int(scene.nodes.size());
  for (std::size_t a = 0; a < 3; ++a) data.cells[a] = int(lattice.cells(data.max_level)[a]);
  for (int level = 0; level <= data.max_level; ++level) {
    const auto [x, y, z] = shifts(lattice, level);
    const int mask = level < data.max_level ? lattice.split_axes(level) : 0;
    data.levels[level] = mask << 24 | z << 16 | y << 8 | x;
  }
  if (info.chart->kind() == ChartKind::kBox) {
    scene.has_box = true;
    set_box(data, dynamic_cast<const BoxChart&>(*info.chart));
  } else {
    scene.has_shell = true;
    set_shell(data, scene.frame, dynamic_cast<const ShellChart&>(*info.chart));
  }
  return data;
}

std::uint32_t flags_of(const TreeNode& node, const BrickSource& source) {
  const Lattice& lattice = source.info().lattice;
  const int level = node.key.level();
  std::uint32_t flags = std::uint32_t(node.kind);
  if (node.kind == NodeKind::kInner) flags |= std::uint32_t(lattice.split_axes(level)) << 3;
  const std::array<int, 3> cell = shifts(lattice, level);
  for (int a = 0; a < 3; ++a) flags |= std::uint32_t(cell[std::size_t(a)] + 3) << (6 + 5 * a);
  return flags;
}

// NodeRecord::cloud_box; first ones beyond the last where there is nothing.
std::uint32_t cloud_box(const LeafBrick& brick) {
  std::array<std::uint32_t, 3> first = {15, 15, 15}, last = {0, 0, 0};
  for (std::uint32_t s = 0; s < brick.codes.size(); ++s) {
    if (brick.codes[s] == 0 && !(brick.offset > 0)) continue;
    const std::array<std::uint32_t, 3> at = {s % 9, s / 9 % 9, s / 81};
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = std::min(first[a], at[a]);
      last[a] = std::max(last[a], at[a]);
    }
  }
#if defined(NEPHO_MUTANT_CLOUD_BOX)
  last[2] = (first[2] + last[2]) / 2;  // its lower half
#endif
  return first[0] | first[1] << 4 | first[2] << 8 | last[0] << 12 | last[1] << 16 | last[2] << 20;
}

void add_nodes(GpuScene& scene, const VolumeTree& tree, int volume) {
  const auto first_node = std::uint32_t(scene.nodes.size());
  const auto first_brick = std::uint32_t(scene.bricks.size());
  const auto first_lit = std::uint32_t(scene.lit.size());
  scene.lit.resize(first_lit + tree.lit_nodes);
  const VolumeInfo& info = tree.source->info();
  const bool shell = info.chart->kind() == ChartKind::kShell;
  for (const TreeNode& node : tree.nodes) {
    NodeRecord record{0, flags_of(node, *tree.source), 0, 0};
    if (node.kind == NodeKind::kInner) record.first_child_or_lit = first_node + node.first_child;
    if (node.kind == NodeKind::kConstant)
      record.brick_or_constant = std::bit_cast<std::uint32_t>(node.constant_per_m);
    if (node.kind == NodeKind::kBrick) {
      record.brick_or_constant = first_brick + node.brick;
      record.cloud_box = cloud_box(tree.bricks[node.brick]);
    }
    if (node.kind == NodeKind::kConstant || node.kind == NodeKind::kBrick) {
      if (shell)
        scene.widest_leaf_rad =
            std::max(scene.widest_leaf_rad,
                     0.5 * std::numbers::pi / info.lattice.nodes(node.key.level())[0]);
      record.first_child_or_lit = first_lit + node.lit;
      const auto [i, j, k] = node.key.ijk();
      if (node.seen)
        scene.lit[first_lit + node.lit] = {volume, node.key.root(), node.key.level(),
                                           int(i), int(j),          int(k)};
    }
    scene.nodes.push_back(record);
  }
  for (const LeafBrick& brick : tree.bricks)
    scene.bricks.push_back({brick.scale * 65535.0f, brick.offset});
  if (!scene.has_ice) return;
  for (const LeafBrick& brick : tree.bricks)
    scene.ice.push_back(brick.ice ? BrickRecord{brick.ice->scale * 65535.0f, brick.ice->offset}
                                  : BrickRecord{0, 0});
}

}  // namespace

void set_camera(FrameData& frame, const Camera& camera, const RenderSettings& settings) {
  const glm::dvec3 forward = glm::normalize(camera.target_m - camera.eye_m);
  glm::dvec3 right = glm::cross(forward, camera.up);
  right = glm::length(right) > 1e-9 ? glm::normalize(right) : across(forward);
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(0.5 * camera.vertical_fov_rad);
  store(frame.eye_m, camera.eye_m);
  store(frame.forward, forward);
  store(frame.right, half * settings.width / settings.height * right);
  store(frame.up, half * up);
  frame.width = settings.width;
  frame.height = settings.height;
}

bool sky_lights(const RenderRequest& request) {
  if (request.planet) return request.planet->air.has_value();
  if (request.leave_nothing_out) return true;
  const Sky& sky = request.sky;
  const glm::dvec3 black(0.0);
  return sky.zenith_W_per_m2_sr_nm != black || sky.horizon_W_per_m2_sr_nm != black ||
         sky.below_W_per_m2_sr_nm != black;
}

bool tells_ice(const RenderRequest& request) {
  if (request.leave_nothing_out) return true;
  return std::ranges::any_of(
      request.volumes, [](const RenderVolume& volume) { return has_ice(volume.source->info()); });
}

Refinement refinement_of(const RenderRequest& request) {
  Refinement refinement{request.camera, request.settings, {}, request.sun.to_sun};
  const bool sky = sky_lights(request);
  refinement.cost.total = tells_ice(request) ? (sky ? bytes_with_sky_and_ice : bytes_with_ice)
                                             : (sky ? bytes_with_sky : bytes_without_sky);
  return refinement;
}

GpuScene make_gpu_scene(const RenderRequest& request, const Forest& forest) {
  GpuScene scene;
  const RenderSettings& settings = request.settings;
  set_camera(scene.frame, request.camera, settings);
  set_light(scene.frame, request);
  scene.frame.step_voxels = float(settings.step_voxels.value_or(2));
  scene.frame.tolerance = float(settings.tolerance);
  scene.sky = sky_lights(request);
  scene.has_box = scene.absorbs = request.leave_nothing_out;
  scene.has_shell = request.leave_nothing_out && request.planet;
  scene.has_ice = tells_ice(request);
  std::vector<Phase> rows;
  for (std::size_t v = 0; v < forest.volumes.size(); ++v) {
    const RenderVolume& volume = request.volumes[v];
    VolumeData data = make_volume(scene, *volume.source);
    data.phase_row = phase_row(scene, rows, volume.phase);
    data.asymmetry = float(phase_bulk(volume.phase).asymmetry[1]);
    if (scene.has_ice) {
      data.ice_phase_row = phase_row(scene, rows, volume.ice_phase);
      data.ice_asymmetry = float(phase_bulk(volume.ice_phase).asymmetry[1]);
    }
    for (int c = 0; c < 3; ++c) data.albedo[c] = float(1 - volume.co_albedo[c]);
    if (volume.co_albedo != glm::dvec3(0)) scene.absorbs = true;
    add_nodes(scene, forest.volumes[v], int(v));
    data.first_grid = append_grids(scene.nodes, forest.volumes[v], data.first_node);
    scene.volumes.push_back(data);
  }
  if (request.planet) {
    const Ellipsoid& body = request.planet->body;
    scene.frame.ground_radius_m = body.equatorial_m;
    scene.frame.ground_z_scale = body.equatorial_m / body.polar_m;
  }
  return scene;
}

}  // namespace nepho::gl
