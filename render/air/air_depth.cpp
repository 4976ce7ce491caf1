#include <algorithm>
#include <cmath>

#include "air/air_depth.h"
#include "air/air_path.h"
#include "air/gauss.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr int kNodes = 5;

// Integrals of the three profiles over u0 .. u1.
glm::dvec3 amounts_m(const Air& air, const AirPath& path, double u0_m, double u1_m,
                     const std::vector<double>& heights_m) {
  static const GaussRule rule(kNodes);
  glm::dvec3 sum{0.0};
  const std::vector<double> cuts = path.cuts(u0_m, u1_m, heights_m);
  for (std::size_t p = 1; p < cuts.size(); ++p) {
    const double length_m = cuts[p] - cuts[p - 1];
    for (std::size_t n = 0; n < rule.node.size(); ++n) {
      const double h_m = path.height_m(cuts[p - 1] + rule.node[n] * length_m);
      sum += rule.weight[n] * length_m *
             glm::dvec3{f64::air_exponential(h_m, air.rayleigh_scale_m),
                        f64::air_exponential(h_m, air.aerosol_scale_m),
                        f64::air_ozone(h_m, air.ozone_low_m, air.ozone_peak_m, air.ozone_high_m)};
    }
  }
  return sum;
}

}  // namespace

AirPath::AirPath(double radius_m, double height_m, double mu) : radius_m_(radius_m) {
#if defined(NEPHO_MUTANT_FLAT_AIR)
  radius_m_ = radius_m *= 2;
#endif
  const double r_m = radius_m + height_m;
  const double sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
  start_m_ = r_m * mu;
  lowest_m_ = height_m - r_m * mu * mu / (1 + sine);
  lowest_radius_m_ = r_m * sine;
}

double AirPath::height_m(double u_m) const {
  return lowest_m_ + u_m * u_m / (lowest_radius_m_ + std::hypot(lowest_radius_m_, u_m));
}

double AirPath::rise_m(double height_m) const {
  const double above = (height_m - lowest_m_) * (2 * radius_m_ + height_m + lowest_m_);
  return above > 0 ? std::sqrt(above) : 0;
}

std::vector<double> AirPath::cuts(double u0_m, double u1_m,
                                  const std::vector<double>& heights_m) const {
  std::vector<double> cuts;
  cuts.reserve(2 * heights_m.size() + 3);
  cuts.push_back(u0_m);
  const auto add = [&](double u_m) {
    if (u_m > cuts.back() && u_m < u1_m) cuts.push_back(u_m);
  };
  for (auto h = heights_m.rbegin(); h != heights_m.rend(); ++h)
    if (*h > lowest_m_) add(-rise_m(*h));
  add(0);
  for (const double h_m : heights_m)
    if (h_m > lowest_m_) add(rise_m(h_m));
  if (u1_m > u0_m) cuts.push_back(u1_m);
  return cuts;
}

std::vector<double> air_cut_heights(const Air& air) {
  std::vector<double> heights_m{0, air.ozone_low_m, air.ozone_peak_m, air.ozone_high_m, air.top_m};
  for (const double scale_m : {air.rayleigh_scale_m, air.aerosol_scale_m})
    for (const double times : {0.5, 1.5, 4.0, 8.0}) heights_m.push_back(times * scale_m);
  std::erase_if(heights_m, [&](double h_m) { return !(h_m >= 0 && h_m <= air.top_m); });
  std::ranges::sort(heights_m);
  return heights_m;
}

AirDepth::AirDepth(const Air& air, double radius_m)
    : air_(air), radius_m_(radius_m), cuts_m_(air_cut_heights(air)) {}

glm::dvec3 AirDepth::operator()(double height_m, double mu, double length_m) const {
  const AirPath path(radius_m_, height_m, mu);
  const double top_m = path.top_m(air_);
  const double u0_m = std::max(path.start_m(), -top_m);
  const double u1_m = std::min(path.start_m() + length_m, top_m);
  if (!(u1_m > u0_m)) return glm::dvec3{0.0};
  const glm::dvec3 amount_m = amounts_m(air_, path, u0_m, u1_m, cuts_m_);
  return amount_m.x * air_.rayleigh_per_m + amount_m.y * air_.aerosol_extinction_per_m +
         amount_m.z * air_.ozone_per_m;
}

glm::dvec3 air_optical_depth(const Air& air, double radius_m, double height_m, double mu,
                             double length_m) {
  return AirDepth(air, radius_m)(height_m, mu, length_m);
}

}  // namespace nepho
