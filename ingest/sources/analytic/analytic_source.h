#pragma once

#include <memory>

#include "api/source_module.h"

namespace nepho::analytic {

// Clouds in closed form, the truth scenes. Parameters, all optional; SI, lengths in the volume's
// local frame (x right, y ahead, z up; `place` puts it on the ground):
//
//   kind              constant | slab | sphere | gaussian | exponential | step_cloud | cube |
//                     half_space
//   chart             box | shell (constant, slab, exponential, gaussian only)
//   optical_depth     10; vertical through the whole layer, along a cube's edge or a diameter.
//                     step_cloud: optical_depth_left 2, optical_depth_right 18; half_space: 1000
//   extinction_per_m  instead of it: in the middle, or at the bottom of an exponential.
//                     step_cloud: extinction_left_per_m, extinction_right_per_m
//   asymmetry         Henyey-Greenstein g; else Mie of effective_radius_m (1e-5)
//   co_albedo         1 - single scattering albedo, all wavelengths (0)
//   max_level         5 (shell: 6)
//   split_axes        auto | xyz | xy | z | x | xy_xyz (xy while wider than aspect (4) x height).
//                     auto leaves out an axis along which nothing varies
//
//   box               size_x_m, size_y_m, size_z_m (1000; step_cloud 500, 500, 250; cube: size_m),
//                     shear_xz, shear_yz (0: how far the top leans, per height),
//                     center_x_m, center_y_m (0), base_z_m (0) or center_z_m.
//                     slab, step_cloud, half_space, exponential repeat in x and y for ever
//   shell             body_radius_m (absent: WGS84), bottom_m (0), top_m (16000)
//   sphere            radius_m (500), edge_m (one finest voxel): width of its rim
//   gaussian          sigma_m (200), cutoff_sigmas (5); shell: centre at `place`, sigma_z_m
//   exponential       scale_height_m (an eighth of the layer)
//
// Samples are `point`. Plane faces lie on the chart's walls: a slab's chart is the slab. Balls keep
// a layer of zero samples inside the chart's faces.
std::unique_ptr<BrickSource> open_source(const SourceRequest& request);

}  // namespace nepho::analytic
