#include "reference/ray_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "optics/phase_table.h"
#include "physics/physics_cpp.h"
#include "reference/walk.h"

namespace nepho {
namespace {

constexpr double kOpaque = 1e4;  // a shadow ray ends there
constexpr int kMaxHalvings = 16;
constexpr double kLeastWeight_per_m = 1e-30;  // sources where no volume has extinction: their mean

double luminance(const glm::dvec3& c) {
  return f64::luminance(c.r, c.g, c.b);
}

// A direction across `up`, whichever: the renderer's choice.
glm::dvec3 across(const glm::dvec3& up) {
  const glm::dvec3 other =
      std::abs(up.x) < 0.6 ? glm::dvec3{1.0, 0.0, 0.0} : glm::dvec3{0.0, 1.0, 0.0};
  return glm::normalize(glm::cross(up, other));
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

std::array<glm::dvec3, 3> sky_axes(const glm::dvec3& up) {
  const glm::dvec3 east = across(up);
  return {up, east, glm::cross(up, east)};
}

Ray camera_ray(const Camera& camera, int width, int height, int x, int y) {
  const glm::dvec3 forward = glm::normalize(camera.target_m - camera.eye_m);
  glm::dvec3 right = glm::cross(forward, camera.up);
  right = glm::length(right) > 1e-9 ? glm::normalize(right) : across(forward);
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(camera.vertical_fov_rad / 2);
  const double u = (2.0 * x + 1) / width - 1, v = 1 - (2.0 * y + 1) / height;
  return {camera.eye_m,
          glm::normalize(forward + half * (u * (double(width) / height) * right + v * up))};
}

// Phase functions towards the eye times a^n, per volume and octave.
struct RayMarch::Lamp {
  std::vector<std::vector<glm::dvec3>> scattering;  // [volume][octave]
};

RayMarch::RayMarch(const LevelSet& levels, const RenderRequest& request, MarchSettings settings)
    : levels_(levels), request_(request), settings_(settings) {
  const Sky& sky = request.sky;
  sky_lights_ = luminance(sky.zenith_W_per_m2_sr_nm + sky.horizon_W_per_m2_sr_nm +
                          sky.below_W_per_m2_sr_nm) > 0;
  octaves_ = request.settings.light == nepho::Light::kOctaves ? request.settings.octaves : 1;
  sky_axes_ = sky_axes(glm::normalize(sky.up));
  for (std::size_t v = 0; v < levels.size(); ++v) ground_.add(*levels.info(v).chart);
  for (const RenderVolume& volume : request.volumes) {
    phase_tables_.push_back(phase_table(volume.phase));
    asymmetry_.push_back(phase_bulk(volume.phase).asymmetry[1]);
  }
}

double RayMarch::optical_depth(const Ray& ray, double t_max_m) const {
  t_max_m = std::min(t_max_m, ground_.distance_m(ray));
  double tau = 0;
  for (std::size_t v = 0; v < levels_.size(); ++v) {
    VolumeWalk walk(levels_, v, ray, t_max_m, true);
    const double before = tau;
    while (tau < kOpaque && walk.next()) {
      const double length_m = walk.t1_m() - walk.t0_m();
      if (walk.kind() == NodeKind::kEmpty || !(length_m > 0)) continue;
      if (walk.kind() == NodeKind::kConstant) {
        tau += length_m * walk.extinction_per_m(walk.t0_m());
        continue;
      }
      const int steps = walk.sub_steps(length_m);
      const double h = length_m / steps;
      double k0 = walk.extinction_per_m(walk.t0_m());
      for (int s = 0; s < steps; ++s) {
        const double t = walk.t0_m() + s * h, k1 = walk.extinction_per_m(t + h);
        tau += f64::simpson_optical_depth(k0, walk.extinction_per_m(t + h / 2), k1, h);
        k0 = k1;
      }
    }
    if (walk.endless() && tau > before) return std::numeric_limits<double>::infinity();
  }
  return tau;
}

double RayMarch::visibility(const glm::dvec3& point_m, const glm::dvec3& direction) const {
  const double tau = optical_depth({point_m, direction});
  return request_.settings.light == nepho::Light::kSingle ? std::exp(-tau)
                                                          : f64::sky_visibility(tau);
}

RayMarch::Light RayMarch::light_at(const glm::dvec3& point_m) const {
  Light light;
  const glm::dvec3 to_sun = glm::normalize(request_.sun.to_sun);
  light.tau_sun = optical_depth({point_m, to_sun});
  light.sun_part = ground_.sun_part(point_m, to_sun);
  if (!sky_lights_) return light;
  const auto& [up, east, north] = sky_axes_;
  light.visible_up = visibility(point_m, up);
  light.visible_side = (visibility(point_m, east) + visibility(point_m, -east) +
                        visibility(point_m, north) + visibility(point_m, -north)) /
                       4;
  light.visible_down = visibility(point_m, -up);
  return light;
}

// One view ray under way.
class RayMarch::Trace {
 public:
  Trace(const RayMarch& march, const Ray& ray) : march_(march), ray_(ray) {
    const glm::dvec3 apart = glm::normalize(march.request_.sun.to_sun) - ray.direction;
    const double one_minus_cos = 0.5 * glm::dot(apart, apart);
    for (std::size_t v = 0; v < march.levels_.size(); ++v) {
      std::vector<glm::dvec3>& terms = lamp_.scattering.emplace_back();
      terms.push_back(table_phase(march.phase_tables_[v], one_minus_cos));
      for (int n = 1; n < march.octaves_; ++n)
        terms.emplace_back(
            f64::octave_scattering(n) *
            f64::hg_phase(one_minus_cos, f64::octave_asymmetry(n, march.asymmetry_[v])));
    }
  }

  MarchResult run() {
    const double ground_m = march_.ground_.distance_m(ray_);
    for (std::size_t v = 0; v < march_.levels_.size(); ++v) {
      walks_.emplace_back(march_.levels_, v, ray_, ground_m, false);
      active_.push_back(walks_.back().next());
    }
    double t = 0;
    while (transmittance_ >= march_.settings_.least_transmittance) {
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
    result_.scattered_W_per_m2_sr_nm = result_.radiance_W_per_m2_sr_nm;
    add_background(ground_m < kNoDistance_m);
    return result_;
  }

 private:
  struct End {  // of a step
    double t_m = -1;
    Light light;
  };

  bool present(std::size_t v, double t_m) const {
    return active_[v] && walks_[v].t0_m() <= t_m && walks_[v].kind() != NodeKind::kEmpty;
  }

  void add_interval(double t0_m, double t1_m) {
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
      const End first = last_.t_m == a ? last_ : end_at(a);
      last_ = end_at(b);
      add_step(first, last_, 0);
    }
  }

  // A step begins where the last one ended: its light is kept.
  End end_at(double t_m) const {
    return {t_m, march_.light_at(ray_.origin_m + t_m * ray_.direction)};
  }

  double total_extinction_per_m(double t_m) const {
    double sum = 0;
    for (const std::size_t v : volumes_) sum += walks_[v].extinction_per_m(t_m);
    return sum;
  }

  double step_depth(double t0_m, double t1_m) const {
    return f64::simpson_optical_depth(total_extinction_per_m(t0_m),
                                      total_extinction_per_m((t0_m + t1_m) / 2),
                                      total_extinction_per_m(t1_m), t1_m - t0_m);
  }

  void add_step(const End& first, const End& last, int halvings) {
    const double x = step_depth(first.t_m, last.t_m);
    const glm::dvec3 s0 = source(first), s1 = source(last);
    if (halvings < kMaxHalvings && too_curved(luminance(s0), luminance(s1), x)) {
      const End middle = end_at((first.t_m + last.t_m) / 2);
      add_step(first, middle, halvings + 1);
      add_step(middle, last, halvings + 1);
      return;
    }
    for (int c = 0; c < 3; ++c)
#if defined(NEPHO_MUTANT_EULER)
      result_.radiance_W_per_m2_sr_nm[c] += transmittance_ * s0[c] * x;
#else
      result_.radiance_W_per_m2_sr_nm[c] += transmittance_ * f64::step_radiance(s0[c], s1[c], x);
#endif
    transmittance_ *= std::exp(-x);
    result_.optical_depth += x;
  }

  bool too_curved(double s0, double s1, double x) const {
    const double most = std::max(s0, s1), least = std::min(s0, s1);
    if (!(most > 0)) return false;
    const double folds = least > 0 ? std::min(std::log(most / least), 4.0) : 4.0;
    const double error = transmittance_ * -std::expm1(-x) * (most - least) * folds / 8;
    const double scale = luminance(result_.radiance_W_per_m2_sr_nm) + transmittance_ * most;
    return error > march_.settings_.source_tolerance * scale;
  }

  glm::dvec3 source(const End& end) const {
    const Light& at = end.light;
    const RenderRequest& request = march_.request_;
    glm::dvec3 ambient;
    if (march_.sky_lights_)
      for (int c = 0; c < 3; ++c)
        ambient[c] = f64::sky_source(
            at.visible_up, at.visible_side, at.visible_down, request.sky.zenith_W_per_m2_sr_nm[c],
            request.sky.horizon_W_per_m2_sr_nm[c], request.sky.below_W_per_m2_sr_nm[c]);
    glm::dvec3 sum;
    double weights = 0;
    for (const std::size_t v : volumes_) {
      glm::dvec3 scattered;
      for (int n = 0; n < march_.octaves_; ++n)
        scattered += lamp_.scattering[v][std::size_t(n)] * f64::octave_transmittance(n, at.tau_sun);
      const double k = std::max(walks_[v].extinction_per_m(end.t_m), kLeastWeight_per_m);
      sum += k * (1.0 - request.volumes[v].co_albedo) *
             (at.sun_part * scattered * request.sun.irradiance_W_per_m2_nm + ambient);
      weights += k;
    }
    return sum / weights;
  }

  void add_background(bool ground) {
    const Sky& sky = march_.request_.sky;
    const double sine = glm::dot(ray_.direction, march_.sky_axes_[0]);
    for (int c = 0; c < 3; ++c) {
      const double below = sky.below_W_per_m2_sr_nm[c];
      result_.radiance_W_per_m2_sr_nm[c] +=
          transmittance_ * (ground ? below
                                   : f64::sky_radiance(sine, sky.zenith_W_per_m2_sr_nm[c],
                                                       sky.horizon_W_per_m2_sr_nm[c], below));
    }
  }

  const RayMarch& march_;
  Ray ray_;
  Lamp lamp_;
  std::vector<VolumeWalk> walks_;
  std::vector<char> active_;
  std::vector<std::size_t> volumes_;  // those with something in this interval
  End last_;
  double transmittance_ = 1;
  MarchResult result_;
};

MarchResult RayMarch::trace(const Ray& ray) const {
  // From far away a world position keeps few digits of a cell: begin at the first chart.
  double entry_m = kNoDistance_m;
  for (std::size_t v = 0; v < levels_.size(); ++v) {
    const ChartRay::Start start = chart_ray(levels_.info(v), ray)->start(kNoDistance_m);
    if (start.end_m > start.t_m) entry_m = std::min(entry_m, start.t_m);
  }
  if (entry_m >= kNoDistance_m) entry_m = 0;
  return Trace(*this, {ray.origin_m + entry_m * ray.direction, ray.direction}).run();
}

}  // namespace nepho
