#pragma once

#include <array>

namespace nepho {

// What the interim light model misses, as measured on plane slabs: rms difference between its
// radiance and the truth (adding-doubling, HG g = 0.85, no absorption) over the mean truth, by the
// optical depth along the view, the scattering angle and the number of octaves (1 = single
// scattering). Both sides of slabs of optical depth 0.1 .. 128, sun and view at cosines 0.2 .. 1.
// Says nothing of horizontal light transport, nor of other phase functions.
inline constexpr std::array<double, 5> kViewDepthEdges = {0.25, 1, 2, 4, 8};  // the last: and above
inline constexpr std::array<double, 2> kScatteringAngleEdges_deg = {30, 90};
inline constexpr int kTableOctaves = 8;
using LightModelRow = std::array<std::array<double, 3>, 6>;  // [depth bin][angle bin]

const LightModelRow& light_model_row(int octaves);  // beyond the table: its last
int view_depth_bin(double optical_depth);
int scattering_angle_bin(double one_minus_cos);
double light_model_error(int octaves, double view_optical_depth, double one_minus_cos);

// The light model's radiance of a slab in closed form, for a sun of irradiance 1.
struct SlabView {
  double tau, mu0, mu, one_minus_cos;
  bool from_above;
};
double slab_radiance(const SlabView& view, int octaves, double asymmetry);

}  // namespace nepho
