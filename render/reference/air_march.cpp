#include "reference/air_march.h"

#include <algorithm>
#include <cmath>

#include "air/air_path.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr int kMaxHalvings = 10;

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

AirDensity density_at(const Air& air, double height_m) {
  AirDensity density = air_density(air, height_m);
#if defined(NEPHO_MUTANT_REFERENCE_HALF_AIR)
  density.extinction_per_m -= 0.5 * density.rayleigh_per_m;
  density.rayleigh_per_m *= 0.5;
#endif
  return density;
}

}  // namespace

// What a ray collects.
struct AirMarch::Sum {
  glm::dvec3 &radiance, &transmittance;
  double scale = 0;  // luminance that errors are compared with
};

AirMarch::AirMarch(const PlanetModel& planet, const Ray& ray, double eye_m, double shadows_m,
                   Lit lit, double tolerance)
    : planet_(planet),
      ray_(ray),
      eye_m_(eye_m),
      shadows_m_(shadows_m),
      tolerance_(tolerance),
      inside_(planet.in_air(ray)),
      lit_(std::move(lit)) {
  if (!planet.has_air()) return;
  const glm::dvec3 apart = planet.to_sun() - ray.direction;
  const double one_minus_cos = 0.5 * glm::dot(apart, apart);
  rayleigh_ = f64::rayleigh_phase(one_minus_cos);
  aerosol_ = f64::cornette_shanks_phase(one_minus_cos, planet.air().aerosol_asymmetry);
}

glm::dvec3 AirMarch::extinction_per_m(double t_m) const {
  if (!(t_m >= inside_.begin_m && t_m <= inside_.end_m)) return glm::dvec3{0.0};
  const double height_m = planet_.place(ray_.origin_m + t_m * ray_.direction).height_m;
  return density_at(planet_.air(), std::min(height_m, planet_.air().top_m)).extinction_per_m;
}

AirKnot AirMarch::knot(double t_m) const {
  AirKnot knot;
  if (!(t_m >= inside_.begin_m && t_m <= inside_.end_m)) return knot;
  const glm::dvec3 point_m = ray_.origin_m + t_m * ray_.direction;
  PlanetModel::Place place = planet_.place(point_m);
  place.height_m = std::min(place.height_m, planet_.air().top_m);  // but for the last digit
  const AirDensity density = density_at(planet_.air(), place.height_m);
  knot.extinction_per_m = density.extinction_per_m;
  const glm::dvec3 sun = planet_.sun_W_per_m2_nm(place);
  const AirLight light = planet_.air_light(place);
  const double mu = planet_.mu(point_m, ray_.direction);
  for (int c = 0; c < 3; ++c) {
    const double r = density.rayleigh_per_m[c], a = density.aerosol_per_m[c];
    knot.sunlit[c] = f64::air_emission(r, a, sun[c], rayleigh_, aerosol_, 0, 0, mu);
    knot.other[c] = f64::air_emission(r, a, 0, rayleigh_, aerosol_, light.multiple[c],
                                      light.multiple_p2[c], mu);
  }
  return knot;
}

AirMarch::Node AirMarch::node(double t_m) const {
  const glm::dvec3 point_m = ray_.origin_m + t_m * ray_.direction;
  Node node{t_m, knot(t_m), planet_.place(point_m)};
#if !defined(NEPHO_MUTANT_REFERENCE_NO_AIR_SHADOW)
  if (luminance(node.knot.sunlit) > 0 && planet_.lowest_towards_sun_m(node.place) < shadows_m_)
    node.lit = lit_(point_m);
#endif
  return node;
}

// Extinction quadratic, emission times transmittance by Simpson.
AirMarch::Panel AirMarch::panel(const Node& a, const Node& m, const Node& b) {
  const double d = b.t_m - a.t_m;
  const glm::dvec3 &k0 = a.knot.extinction_per_m, &k1 = m.knot.extinction_per_m,
                   &k2 = b.knot.extinction_per_m;
  const glm::dvec3 half_way = glm::exp(-d / 24 * (5.0 * k0 + 8.0 * k1 - k2));
  const glm::dvec3 through = glm::exp(-d / 6 * (k0 + 4.0 * k1 + k2));
  return {d / 6 * (a.emission() + 4.0 * half_way * m.emission() + through * b.emission()), through};
}

// Ends of panels: at the profiles' kinks and scales, and so close that few shadows are missed.
std::vector<double> AirMarch::cuts(double begin_m, double end_m) const {
  const glm::dvec3 start_m = ray_.origin_m + begin_m * ray_.direction;
  const double mu = planet_.mu(start_m, ray_.direction);
  const AirPath path(planet_.radius_m(), planet_.place(start_m).height_m, mu);
  const double stretch = planet_.stretch(ray_.direction);
  std::vector<double> ends;
  double before = begin_m;
  for (const double u_m : path.cuts(path.start_m(), path.start_m() + (end_m - begin_m) * stretch,
                                    air_cut_heights(planet_.air()))) {
    const double end = std::min(begin_m + (u_m - path.start_m()) / stretch, end_m);
    // Shadows are where this piece is low.
    const auto low = [&](double t) {
      return planet_.lowest_towards_sun_m(planet_.place(ray_.origin_m + t * ray_.direction)) <
             shadows_m_;
    };
    if (end > before && (low(before) || low(end)))
      for (double t = before;;) {
        t += 0.2 * (t + eye_m_) + 500;
        if (t >= end) break;
        ends.push_back(t);
      }
    ends.push_back(end);
    before = end;
  }
  if (ends.empty() || ends.back() < end_m) ends.push_back(end_m);
  return ends;
}

void AirMarch::refine(const Node& a, const Node& m, const Node& b, int halvings, Sum& sum) const {
  const Node q1 = node(0.5 * (a.t_m + m.t_m)), q2 = node(0.5 * (m.t_m + b.t_m));
  const Panel whole = panel(a, m, b), first = panel(a, q1, m), second = panel(m, q2, b);
  const glm::dvec3 both = first.radiance + first.transmittance * second.radiance;
  const glm::dvec3 seen = sum.transmittance;
  const double error = std::abs(luminance(seen * (both - whole.radiance)));
  const glm::dvec3 through = first.transmittance * second.transmittance;
  const double lost = std::abs(luminance(seen * (through - whole.transmittance)));
  const double scale = std::max(sum.scale, luminance(sum.radiance));
  if (halvings < kMaxHalvings && (error > tolerance_ * scale || lost > tolerance_)) {
    refine(a, q1, m, halvings + 1, sum);
    refine(m, q2, b, halvings + 1, sum);
    return;
  }
  sum.radiance += seen * both;
  sum.transmittance *= through;
}

void AirMarch::add(double begin_m, double end_m, glm::dvec3& radiance,
                   glm::dvec3& transmittance) const {
  begin_m = std::max(begin_m, inside_.begin_m);
  end_m = std::min(end_m, inside_.end_m);
  if (!(end_m > begin_m)) return;
  Sum sum{radiance, transmittance};
  std::vector<Node> nodes{node(begin_m)};
  glm::dvec3 light{0.0}, through = transmittance;
  for (const double end : cuts(begin_m, end_m)) {
    if (!(end > nodes.back().t_m)) continue;
    nodes.push_back(node(0.5 * (nodes.back().t_m + end)));
    nodes.push_back(node(end));
    const std::size_t n = nodes.size();
    const Panel rough = panel(nodes[n - 3], nodes[n - 2], nodes[n - 1]);
    light += through * rough.radiance;
    through *= rough.transmittance;
  }
  sum.scale = luminance(radiance + light);
  for (std::size_t n = 2; n < nodes.size(); n += 2)
    refine(nodes[n - 2], nodes[n - 1], nodes[n], 0, sum);
}

}  // namespace nepho
