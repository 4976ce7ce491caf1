#include "reference/trace.h"

#include <algorithm>
#include <cmath>

#include "optics/phase_table.h"
#include "physics/physics_cpp.h"

namespace nepho {
namespace {

constexpr int kMaxHalvings = 16;
constexpr double kLeastWeight_per_m = 1e-30;  // sources where no volume has extinction: their mean
constexpr double kAirTolerance = 3e-4;        // of an interval of air alone
constexpr double kAirStep = 0.2;              // optical depth of air in a step of cloud

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

glm::dvec3 table_phase(const std::vector<float>& table, double one_minus_cos) {
  const double at = f64::phase_table_coordinate(one_minus_cos) * (kPhaseTexels - 1);
  const auto i = std::size_t(std::clamp(int(at), 0, kPhaseTexels - 2));
  glm::dvec3 phase;
  for (std::size_t c = 0; c < 3; ++c) {
    const double low = double(table[3 * i + c]), high = double(table[3 * i + 3 + c]);
    phase[int(c)] = std::exp(low + (at - double(i)) * (high - low));
  }
  return phase;
}

}  // namespace

RayMarch::Trace::Trace(const RayMarch& march, const Ray& ray, double eye_m)
    : march_(march), ray_(ray) {
  const glm::dvec3 apart = glm::normalize(march.request_.sun.to_sun) - ray.direction;
  const double one_minus_cos = 0.5 * glm::dot(apart, apart);
  for (std::size_t v = 0; v < march.levels_.size(); ++v) {
    const Look& look = march.looks_[v];
    scattering_.push_back(octaves(look.phase_table, look.asymmetry, one_minus_cos));
    ice_scattering_.emplace_back();
    if (!look.ice_phase_table.empty())
      ice_scattering_.back() = octaves(look.ice_phase_table, look.ice_asymmetry, one_minus_cos);
  }
  if (!march.planet_ || !march.planet_->has_air()) return;
  const auto lit = [&march](const glm::dvec3& point_m) { return march.sun_passed(point_m); };
  air_.emplace(*march.planet_, ray, eye_m, march.cloud_top_m_, lit, kAirTolerance);
}

RayMarch::Trace::Octaves RayMarch::Trace::octaves(const std::vector<float>& table, double asymmetry,
                                                  double one_minus_cos) const {
  Octaves terms{table_phase(table, one_minus_cos)};
  for (int n = 1; n < march_.octaves_; ++n)
    terms.emplace_back(f64::octave_scattering(n) *
                       f64::hg_phase(one_minus_cos, f64::octave_asymmetry(n, asymmetry)));
  return terms;
}

double RayMarch::Trace::passed() const {
  return std::max({transmittance_.r, transmittance_.g, transmittance_.b});
}

MarchResult RayMarch::Trace::run() {
  const double ground_m =
      march_.planet_ ? march_.planet_->surface().distance_m(ray_) : march_.ground_.distance_m(ray_);
  march_clouds(ground_m);
  if (march_.planet_)
    add_planet(ground_m);
  else
    add_background(ground_m < kNoDistance_m);
  return result_;
}

void RayMarch::Trace::march_clouds(double last_m) {
  for (std::size_t v = 0; v < march_.levels_.size(); ++v) {
    walks_.emplace_back(march_.levels_, v, ray_, last_m, false);
    active_.push_back(walks_.back().next());
  }
  double t = 0;
  while (passed() >= march_.settings_.least_transmittance) {
    double end = kNoDistance_m;
    bool something = false;
    for (std::size_t v = 0; v < walks_.size(); ++v) {
      while (active_[v] && walks_[v].t1_m() <= t) active_[v] = walks_[v].next();
      if (!active_[v]) continue;
      const bool ahead = walks_[v].t0_m() > t;
      end = std::min(end, ahead ? walks_[v].t0_m() : walks_[v].t1_m());
      something = something || present(v, t);
    }
    if (end >= kNoDistance_m) break;
    if (something) add_interval(t, end);
    t = end;
  }
}

bool RayMarch::Trace::present(std::size_t v, double t_m) const {
  return active_[v] && walks_[v].t0_m() <= t_m && walks_[v].kind() != NodeKind::kEmpty;
}

void RayMarch::Trace::add_interval(double t0_m, double t1_m) {
  volumes_.clear();
  int steps = 1;
  for (std::size_t v = 0; v < walks_.size(); ++v) {
    if (!present(v, t0_m)) continue;
    volumes_.push_back(v);
    steps = std::max(steps, walks_[v].sub_steps(t1_m - t0_m));
  }
  const double h = (t1_m - t0_m) / steps;
  for (int s = 0; s < steps; ++s) {
    const double a = t0_m + s * h, b = s + 1 == steps ? t1_m : a + h;
    if (!(step_depth(a, b) > 0)) continue;
    add_air(a);
    const End first = last_.t_m == a ? last_ : end_at(a);
    last_ = end_at(b);
    if (march_.settings_.lights && !air_)
      add_looked_up(first, last_, source(first), source(last_), 0);
    else
      add_step(first, last_, 0);
    air_to_m_ = b;
  }
}

// Air alone, up to here.
void RayMarch::Trace::add_air(double t_m) {
  if (air_ && t_m > air_to_m_)
    air_->add(air_to_m_, t_m, result_.radiance_W_per_m2_sr_nm, transmittance_);
  air_to_m_ = t_m;
}

// A step begins where the last one ended: its light is kept.
RayMarch::Trace::End RayMarch::Trace::end_at(double t_m) const {
  End end{t_m, march_.light_at(ray_.origin_m + t_m * ray_.direction), {}};
  if (!air_) return end;
  end.air = air_->knot(t_m);
  end.air.sunlit *= std::exp(-end.light.tau_sun);
  return end;
}

double RayMarch::Trace::total_extinction_per_m(double t_m) const {
  double sum = 0;
  for (const std::size_t v : volumes_) sum += walks_[v].extinction_per_m(t_m);
  return sum;
}

double RayMarch::Trace::step_depth(double t0_m, double t1_m) const {
  return f64::simpson_optical_depth(total_extinction_per_m(t0_m),
                                    total_extinction_per_m((t0_m + t1_m) / 2),
                                    total_extinction_per_m(t1_m), t1_m - t0_m);
}

glm::dvec3 RayMarch::Trace::air_depth(const End& first, const End& last) const {
  if (!air_) return glm::dvec3{0.0};
  const glm::dvec3 middle = air_->extinction_per_m((first.t_m + last.t_m) / 2);
  return (last.t_m - first.t_m) / 6 *
         (first.air.extinction_per_m + 4.0 * middle + last.air.extinction_per_m);
}

// Cloud of optical depth x with air of optical depth y between and around its drops: the air dims
// the cloud's source, which stays linear in x; the cloud dims the air's emission, linear in t.
void RayMarch::Trace::add_step(const End& first, const End& last, int halvings) {
  const double x = step_depth(first.t_m, last.t_m), length_m = last.t_m - first.t_m;
  const glm::dvec3 y = air_depth(first, last);
  const glm::dvec3 s0 = source(first), s1 = glm::exp(-y) * source(last);
  const glm::dvec3 j0 = length_m * (first.air.sunlit + first.air.other),
                   j1 = length_m * (last.air.sunlit + last.air.other);
  const double l0 = luminance(s0), l1 = luminance(s1);
  if (halvings < march_.settings_.least_halvings ||
      (halvings < kMaxHalvings && (too_curved(l0, l1, -std::expm1(-x), std::max(l0, l1)) ||
                                   too_curved(luminance(j0), luminance(j1), 1, std::max(l0, l1)) ||
                                   std::max({y.r, y.g, y.b}) > kAirStep))) {
    const End middle = end_at((first.t_m + last.t_m) / 2);
    add_step(first, middle, halvings + 1);
    add_step(middle, last, halvings + 1);
    return;
  }
  for (int c = 0; c < 3; ++c) {
#if defined(NEPHO_MUTANT_EULER)
    const double scattered = transmittance_[c] * s0[c] * x;
#else
    const double scattered = transmittance_[c] * f64::step_radiance(s0[c], s1[c], x);
#endif
    result_.scattered_W_per_m2_sr_nm[c] += scattered;
    result_.radiance_W_per_m2_sr_nm[c] += scattered;
    if (air_)
      result_.radiance_W_per_m2_sr_nm[c] +=
          transmittance_[c] *
          (j0[c] * f64::exp_e0(x + y[c]) + (j1[c] - j0[c]) * f64::exp_w1(x + y[c]));
  }
  transmittance_ *= std::exp(-x);
  if (air_) transmittance_ *= glm::exp(-y);
  result_.optical_depth += x;
}

// Where light costs a look-up: the step against its halves, in optical depth (a shell's cells are
// curved) and light, extrapolated from both; the error of linear sources goes with the cube of a
// step's optical depth.
void RayMarch::Trace::add_looked_up(const End& first, const End& last, const glm::dvec3& s0,
                                    const glm::dvec3& s1, int halvings) {
  const End middle = end_at((first.t_m + last.t_m) / 2);
  const glm::dvec3 sm = source(middle);
  const double x1 = step_depth(first.t_m, middle.t_m), x2 = step_depth(middle.t_m, last.t_m);
  const double x = x1 + x2, split = x > 0 ? x1 * x2 / (x * x) : 0.25;
  const double rest = split > 0.125 ? (1 - 3 * split) / (3 * split) : 0;
  const double x_whole = step_depth(first.t_m, last.t_m);
  glm::dvec3 whole, halves;
  for (int c = 0; c < 3; ++c) {
    whole[c] = f64::step_radiance(s0[c], s1[c], x_whole);
    halves[c] =
        f64::step_radiance(s0[c], sm[c], x1) + std::exp(-x1) * f64::step_radiance(sm[c], s1[c], x2);
  }
  const double error = passed() * luminance(glm::abs(halves - whole));
  const double scale = luminance(result_.radiance_W_per_m2_sr_nm) + passed() * luminance(halves);
  if (halvings < kMaxHalvings && error > march_.settings_.source_tolerance * scale) {
    add_looked_up(first, middle, s0, sm, halvings + 1);
    add_looked_up(middle, last, sm, s1, halvings + 1);
    return;
  }
  const glm::dvec3 scattered = transmittance_ * (halves + rest * (halves - whole));
  result_.scattered_W_per_m2_sr_nm += scattered;
  result_.radiance_W_per_m2_sr_nm += scattered;
  transmittance_ *= std::exp(-x);
  result_.optical_depth += x;
}

// Whether a source that is not linear between s0 and s1 may matter: it counts `weight` times, of
// what is collected or of `most`.
bool RayMarch::Trace::too_curved(double s0, double s1, double weight, double most) const {
  const double larger = std::max(s0, s1), least = std::min(s0, s1);
  if (!(larger > 0)) return false;
  const double folds = least > 0 ? std::min(std::log(larger / least), 4.0) : 4.0;
  const double error = passed() * weight * (larger - least) * folds / 8;
  const double scale = luminance(result_.radiance_W_per_m2_sr_nm) + passed() * most;
  return error > march_.settings_.source_tolerance * scale;
}

// Of one volume: its own tile's, where a picture's light is asked for.
RayMarch::Light RayMarch::Trace::light_of(std::size_t volume, const End& end) const {
  Light light = end.light;
  if (!march_.settings_.lights) return light;
  const glm::dvec4 seen = walks_[volume].light(*march_.settings_.lights, end.t_m);
  light.tau_sun = seen[0];
  light.visible_up = seen[1];
  light.visible_side = seen[2];
  light.visible_down = seen[3];
  return light;
}

glm::dvec3 RayMarch::Trace::phases(std::size_t volume, const End& end, double tau_sun) const {
  const Octaves &all = scattering_[volume], &ice = ice_scattering_[volume];
#if defined(NEPHO_MUTANT_REFERENCE_NO_ICE)
  const double part = 0;
#else
  const double part = ice.empty() ? 0 : walks_[volume].ice_part(end.t_m);
#endif
  glm::dvec3 sum{0.0};
  for (int n = 0; n < march_.octaves_; ++n) {
    const auto i = std::size_t(n);
    const glm::dvec3 phase = part > 0 ? all[i] + part * (ice[i] - all[i]) : all[i];
    sum += phase * f64::octave_transmittance(n, tau_sun);
  }
  return sum;
}

glm::dvec3 RayMarch::Trace::source(const End& end) const {
  const RenderRequest& request = march_.request_;
  glm::dvec3 sum{0.0};
  double weights = 0;
  for (const std::size_t v : volumes_) {
    const double k = std::max(walks_[v].extinction_per_m(end.t_m), kLeastWeight_per_m);
    const Light at = light_of(v, end);
    glm::dvec3 ambient{0.0};
    if (march_.sky_lights_)
      for (int c = 0; c < 3; ++c)
        ambient[c] = f64::sky_source(at.visible_up, at.visible_side, at.visible_down, at.sky.up[c],
                                     at.sky.side[c], at.sky.down[c]);
    sum += k * (1.0 - request.volumes[v].co_albedo) *
           (at.sun_part * phases(v, end, at.tau_sun) * at.sun_W_per_m2_nm + ambient);
    weights += k;
  }
  return sum / weights;
}

void RayMarch::Trace::add_background(bool ground) {
  const Sky& sky = march_.request_.sky;
  const double sine = glm::dot(ray_.direction, march_.sky_axes_[0]);
  for (int c = 0; c < 3; ++c) {
    const double below = sky.below_W_per_m2_sr_nm[c];
    result_.radiance_W_per_m2_sr_nm[c] +=
        transmittance_[c] * (ground ? below
                                    : f64::sky_radiance(sine, sky.zenith_W_per_m2_sr_nm[c],
                                                        sky.horizon_W_per_m2_sr_nm[c], below));
  }
}

void RayMarch::Trace::add_planet(double ground_m) {
  if (passed() < march_.settings_.least_transmittance) return;
  add_air(ground_m);
  const PlanetModel& planet = *march_.planet_;
  const auto depth = [this](const Ray& ray) { return march_.optical_depth(ray); };
  result_.radiance_W_per_m2_sr_nm +=
      transmittance_ * (ground_m < kNoDistance_m
                            ? planet.ground_W_per_m2_sr_nm(ray_, ground_m, depth)
                            : planet.beyond_W_per_m2_sr_nm(ray_.direction));
}

}  // namespace nepho
