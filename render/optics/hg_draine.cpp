#include "optics/hg_draine.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr double kLeast_um = 5, kMost_um = 50;  // diameters

double draine_norm(double g, double alpha) {
  return 1 + alpha * (1 + 2 * g * g) / 3;
}

}  // namespace

double draine_phase(double one_minus_cos, double g, double alpha) {
  const double mu = 1 - one_minus_cos;
  return f64::hg_phase(one_minus_cos, g) * (1 + alpha * mu * mu) / draine_norm(g, alpha);
}

double HgDraine::value(double one_minus_cos) const {
#if defined(NEPHO_MUTANT_DRAINE_WITHOUT_NORM)
  const double mu = 1 - one_minus_cos;
  const double draine = f64::hg_phase(one_minus_cos, draine_asymmetry) * (1 + alpha * mu * mu);
#else
  const double draine = draine_phase(one_minus_cos, draine_asymmetry, alpha);
#endif
  return (1 - draine_part) * f64::hg_phase(one_minus_cos, peak_asymmetry) + draine_part * draine;
}

double HgDraine::asymmetry() const {
  const double g = draine_asymmetry;
  const double draine = g * (1 + alpha * (3 + 2 * g * g) / 5) / draine_norm(g, alpha);
  return (1 - draine_part) * peak_asymmetry + draine_part * draine;
}

HgDraine hg_draine_fit(double effective_radius_m) {
  constexpr double tolerance = 1e-9;  // of a radius that went through text
  const double d = 2e6 * effective_radius_m;
  if (!(d >= kLeast_um * (1 - tolerance) && d <= kMost_um * (1 + tolerance)))
    throw Error({"effective radius outside the fit of HG + Draine", "phase", "2.5 um .. 25 um",
                 std::to_string(effective_radius_m * 1e6) + " um",
                 "use mie (4 .. 30 um) or henyey_greenstein"});
  return {.peak_asymmetry = std::exp(-0.0990567 / (d - 1.67154)),
          .draine_asymmetry = std::exp(-2.20679 / (d + 3.91029) - 0.428934),
          .alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825)),
          .draine_part = std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
}

}  // namespace nepho
