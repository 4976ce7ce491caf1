#include "optics/phase_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "optics/hg_draine.h"
#include "optics/mie_table.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

using std::numbers::pi;

constexpr std::array<MieRow, kMieRadii_m.size()> kRows{{
#include "optics/mie_table.inc"
}};

std::string with_unit(double number, const char* unit) {
  return std::to_string(number) + unit;
}

// The two rows around a radius, and the part of the second, linear in the logarithm of the radius.
struct RowBlend {
  const MieRow &below, &above;
  double part;
  double operator()(double low, double high) const { return low + part * (high - low); }
};
RowBlend blend_rows(double radius_m) {
  constexpr double tolerance = 1e-9;  // of a radius that went through text
  if (!(radius_m >= kMieRadii_m.front() * (1 - tolerance) &&
        radius_m <= kMieRadii_m.back() * (1 + tolerance)))
    throw Error({"effective radius outside the Mie table", "phase", "4 um .. 30 um",
                 with_unit(radius_m * 1e6, " um"), "use henyey_greenstein for other particles"});
  std::size_t above = 1;
  while (above + 1 < kRows.size() && kRows[above].effective_radius_m < radius_m) ++above;
  const MieRow &low = kRows[above - 1], &high = kRows[above];
  return {low, high,
          std::log(radius_m / low.effective_radius_m) /
              std::log(high.effective_radius_m / low.effective_radius_m)};
}

std::vector<float> mie_table(double radius_m) {
  const RowBlend blend = blend_rows(radius_m);
  std::vector<float> table(3 * std::size_t(kPhaseTexels));
  for (std::size_t w = 0; w < 3; ++w)
    for (std::size_t texel = 0; texel < std::size_t(kPhaseTexels); ++texel)
      table[3 * texel + w] = float(kMieTableStep * blend(blend.below.log_phase_1e4[w][texel],
                                                         blend.above.log_phase_1e4[w][texel]) -
                                   std::log(4 * pi));
  return table;
}

void check_asymmetry(double g) {
  if (!(std::abs(g) < 1))
    throw Error(
        {"Henyey-Greenstein asymmetry out of range", "phase", "-1 < g < 1", with_unit(g, ""), ""});
}

// Of a formula that takes 1 - cos and knows no colours.
template <class Formula>
std::vector<float> grey_table(Formula&& formula) {
  std::vector<float> table;
  table.reserve(3 * std::size_t(kPhaseTexels));
  for (int texel = 0; texel < kPhaseTexels; ++texel) {
    const double sine = std::sin(phase_texel_angle_rad(texel) / 2);
    table.insert(table.end(), 3, float(std::log(formula(2 * sine * sine))));
  }
  return table;
}

std::vector<float> raw_table(const Phase& phase) {
  switch (phase.kind) {
    case PhaseKind::kMie:
      return mie_table(phase.effective_radius_m);
    case PhaseKind::kHenyeyGreenstein:
      check_asymmetry(phase.asymmetry);
      return grey_table([&](double down) { return f64::hg_phase(down, phase.asymmetry); });
    case PhaseKind::kHgDraine:
      break;
  }
  const HgDraine fit = hg_draine_fit(phase.effective_radius_m);
  return grey_table([&](double down) { return fit.value(down); });
}

}  // namespace

const std::array<MieRow, kMieRadii_m.size()>& mie_rows() {
  return kRows;
}

double phase_texel_angle_rad(int texel) {
  const double u = double(texel) / (kPhaseTexels - 1);
  return pi * u * u;
}

PhaseMoments phase_table_moments(const std::vector<float>& table, int wavelength, int end) {
  // 4-point Gauss in each interval of u; the element is 2 pi sin(theta) dtheta, dtheta = 2 pi u du.
  constexpr std::array<double, 4> node{0.069431844202973714, 0.330009478207571868,
                                       0.669990521792428132, 0.930568155797026286};
  constexpr std::array<double, 4> weight{0.173927422568726929, 0.326072577431273071,
                                         0.326072577431273071, 0.173927422568726929};
  PhaseMoments moments;
  double first = 0;
  for (std::size_t texel = 0; texel < std::size_t(end); ++texel)
    for (std::size_t k = 0; k < node.size(); ++k) {
      const double low = table[3 * texel + std::size_t(wavelength)];
      const double high = table[3 * texel + 3 + std::size_t(wavelength)];
      const double u = (double(texel) + node[k]) / (kPhaseTexels - 1), theta = pi * u * u;
      const double part = weight[k] / (kPhaseTexels - 1) * std::exp(low + node[k] * (high - low)) *
                          2 * pi * std::sin(theta) * 2 * pi * u;
      moments.integral += part;
      first += part * std::cos(theta);
    }
  moments.asymmetry = first / moments.integral;
  return moments;
}

std::vector<float> phase_table(const Phase& phase) {
  std::vector<float> table = raw_table(phase);
  for (int w = 0; w < 3; ++w) {
    const float excess = float(std::log(phase_table_moments(table, w).integral));
    for (std::size_t texel = 0; texel < std::size_t(kPhaseTexels); ++texel)
      table[3 * texel + std::size_t(w)] -= excess;
  }
  return table;
}

PhaseBulk phase_bulk(const Phase& phase) {
  PhaseBulk bulk;
  if (phase.kind != PhaseKind::kMie) {
    const bool fit = phase.kind == PhaseKind::kHgDraine;
    if (!fit) check_asymmetry(phase.asymmetry);
    bulk.asymmetry.fill(fit ? hg_draine_fit(phase.effective_radius_m).asymmetry()
                            : phase.asymmetry);
    bulk.extinction_efficiency.fill(2);
    return bulk;
  }
  const RowBlend blend = blend_rows(phase.effective_radius_m);
  const PhaseBulk &low = blend.below.bulk, &high = blend.above.bulk;
  for (std::size_t w = 0; w < 3; ++w) {
    bulk.asymmetry[w] = blend(low.asymmetry[w], high.asymmetry[w]);
    bulk.extinction_efficiency[w] =
        blend(low.extinction_efficiency[w], high.extinction_efficiency[w]);
    bulk.co_albedo[w] = blend(low.co_albedo[w], high.co_albedo[w]);
  }
  return bulk;
}

}  // namespace nepho
