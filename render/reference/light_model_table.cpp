#include "reference/light_model_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr std::array<LightModelRow, kTableOctaves> kTable = {{
#include "reference/light_model_table.inc"
}};

}  // namespace

const LightModelRow& light_model_row(int octaves) {
  return kTable[std::size_t(std::clamp(octaves, 1, kTableOctaves) - 1)];
}

int view_depth_bin(double optical_depth) {
  return int(std::ranges::upper_bound(kViewDepthEdges, optical_depth) - kViewDepthEdges.begin());
}

int scattering_angle_bin(double one_minus_cos) {
  const double angle_deg =
      2 * std::asin(std::sqrt(std::clamp(one_minus_cos / 2, 0.0, 1.0))) * 180 / std::numbers::pi;
  return int(std::ranges::upper_bound(kScatteringAngleEdges_deg, angle_deg) -
             kScatteringAngleEdges_deg.begin());
}

double light_model_error(int octaves, double view_optical_depth, double one_minus_cos) {
  return light_model_row(octaves)[std::size_t(view_depth_bin(view_optical_depth))]
                                 [std::size_t(scattering_angle_bin(one_minus_cos))];
}

double slab_radiance(const SlabView& view, int octaves, double asymmetry) {
  double sum = 0;
  for (int n = 0; n < octaves; ++n) {
    const double fade = std::pow(f64::octave_b, n) / view.mu0;
    const double a = 1 / view.mu;
    double path = 0;  // integral of exp(-fade t) exp(-a t_to_eye) a dt
    if (view.from_above) {
      path = a * view.tau * f64::exp_e0(view.tau * (a + fade));
    } else {
      // e^-(a tau) - e^-(fade tau) over their difference, from the larger of the two.
      path = a * view.tau * std::exp(-view.tau * std::min(a, fade)) *
             f64::exp_e0(view.tau * std::abs(a - fade));
    }
    sum += f64::octave_scattering(n) * path *
           f64::hg_phase(view.one_minus_cos, f64::octave_asymmetry(n, asymmetry));
  }
  return sum;
}

}  // namespace nepho
