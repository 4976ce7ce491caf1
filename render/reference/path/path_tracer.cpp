#include "reference/path/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "optics/phase_table.h"
#include "tree/source_verbs.h"

namespace nepho {
namespace {

// Roulette for the ways to the sun: those with less than this (throughput times phase function,
// 1/sr) are few, and each counts as if it had so much. Even scattering has 0.08; of light that came
// from all sides with an asymmetry of 0.85, a fifth of the ways are left, and 0.6 of the CPU time,
// with as much noise as before.
constexpr double kFaintWay_per_sr = 0.12;

// Paths that a scattering sends towards the sun, in the mean.
constexpr double kBranches = 0.25;
// Of a direction in the peak around the sun, 1/sr: paths of greater ones are kept although little
// is left of them, or they would be spikes again.
constexpr double kStrongWay_per_sr = 0.12;

double square(double x) {
  return x * x;
}

// Of a technique of this density, where another could have led there as well.
double power_weight(double own, double other) {
#if defined(NEPHO_MUTANT_NO_MIS)
  (void)own, (void)other;
  return 1;
#endif
  return own > 0 ? 1 / (1 + square(other / own)) : 0;
}

// Henyey-Greenstein of the same asymmetry, that of 550 nm.
PhaseSampler smooth(const Phase& phase) {
  return PhaseSampler(
      {.kind = PhaseKind::kHenyeyGreenstein, .asymmetry = phase_bulk(phase).asymmetry[1]});
}

double mean(const glm::dvec3& c) {
  return (c.r + c.g + c.b) / 3;
}

double most(const glm::dvec3& c) {
  return std::max({c.r, c.g, c.b});
}

}  // namespace

// A path under way. `throughput` times what comes in is its sample, for each wavelength; divided by
// the mean of the three wavelengths' densities (relative to the hero's) rather than the hero's own.
struct PathTracer::Path {
  Ray ray;
  int hero;
  Random& random;
  glm::dvec3 throughput{1.0};
  glm::dvec3 densities{1.0};  // of the phase functions so far, over the hero's
  double last_density = 0;    // of the last direction, mean of the wavelengths; 0: from the eye
  bool alive = true;
  bool on_ground = false;  // its last turn
  PathSample result = {};

  void add(const glm::dvec3& radiance) { result.radiance_W_per_m2_sr_nm += radiance; }
  // What a wavelength's light counts on this path.
  glm::dvec3 weights() const { return throughput * densities / mean(densities); }
  // Roulette by what is left of the path and how much it matters, never by its length.
  void thin_out(double importance = 1) {
    const double survive = most(throughput) * importance;
    if (survive >= 1) return;
    if (random.uniform() >= survive) alive = false;
    throughput /= survive;
  }
};

PathTracer::PathTracer(const Forest& forest, const RenderRequest& request, PathSettings settings)
    : medium_(forest),
      around_(request, settings.sun_radius_rad),
      exact_orders_(settings.exact_orders) {
  if (request.planet && request.planet->air) {
    air_.emplace(*request.planet->air, request.planet->body);
    aerosol_ = PhaseSampler::cornette_shanks(air_->aerosol_asymmetry());
    grey_ = false;
  }
  for (const RenderVolume& volume : request.volumes) {
    phases_.emplace_back(volume.phase);
    ice_phases_.emplace_back(has_ice(volume.source->info()) ? volume.ice_phase : volume.phase);
    smooth_phases_.emplace_back(smooth(volume.phase));
    smooth_ice_phases_.emplace_back(smooth(volume.ice_phase));
    co_albedos_.push_back(volume.co_albedo);
    grey_ = grey_ && !air_ && phases_.back().grey() && ice_phases_.back().grey();
  }
  if (most(around_.sun_W_per_m2_nm()) > 0)
    for (const PhaseSampler& phase : phases_)
      if (!peak_ && phase.has_peak()) peak_ = &phase;
}

const PhaseSampler& PathTracer::phase(const PathMedium::Collision& collision) const {
  return (collision.ice ? ice_phases_ : phases_)[std::size_t(collision.volume)];
}

const PhaseSampler& PathTracer::smooth_phase(const PathMedium::Collision& collision) const {
  return (collision.ice ? smooth_ice_phases_ : smooth_phases_)[std::size_t(collision.volume)];
}

glm::dvec3 PathTracer::scattered(const PathMedium::Collision& collision,
                                 const glm::dvec3& direction, int wavelength,
                                 Random& random) const {
  return turned(direction, phase(collision).sample(wavelength, random), random);
}

PathSample PathTracer::sample(const Ray& ray, Random& random) const {
  Path path{.ray = ray, .hero = grey_ ? 1 : int(3 * random.uniform()), .random = random};
  if (air_) {  // its free paths depend on the wavelength: no mixture
    path.densities = glm::dvec3{0.0};
    path.densities[path.hero] = 1;
  }
  follow(path);
  return path.result;
}

void PathTracer::follow(Path& path) const {
  while (path.alive) {
    double ground_m = kNoDistance_m;
    const PhaseSampler* phase = next_scattering(path, ground_m);
#if defined(NEPHO_MUTANT_BOUNCE_CAP)
    if (path.result.scatterings > 64) break;
#endif
    path.on_ground = false;
    if (phase) {
      light_at_collision(path, *phase);
      scatter(path, *phase);
    } else if (path.alive) {
      const bool ground = ground_m < kNoDistance_m;
      if (ground && around_.ground_scatters() && meet_ground(path, ground_m)) continue;
      if (!(ground && around_.ground_scatters())) leave(path, ground);
      break;
    }
  }
}

// Not before scatterings that are smoothed.
bool PathTracer::branches(const Path& path) const {
  return peak_ && (exact_orders_ < 0 || path.result.scatterings < exact_orders_);
}

// Collisions before the ground: free paths are short within clouds, and terrain, whose search is
// long, is looked for no further than the first of them.
const PhaseSampler* PathTracer::next_scattering(Path& path, double& ground_m) const {
  Random& random = path.random;
  const double sea_m = around_.sea_m(path.ray);
  const PathMedium::Collision hit = medium_.collide(path.ray, sea_m, random);
  double reach_m = std::min(sea_m, hit.t_m);
  PathAir::Collision in_air;
  if (air_) in_air = air_->collide(path.ray, reach_m, path.hero, random);
  if (in_air.event != PathAir::Event::kNone) reach_m = in_air.t_m;
  ground_m = around_.ground_m(path.ray, path.on_ground, reach_m);
  if (ground_m < kNoDistance_m) return nullptr;
  if (air_) {
    if (in_air.event == PathAir::Event::kAbsorbed) path.alive = false;
    if (in_air.event != PathAir::Event::kNone) {
      path.ray.origin_m += in_air.t_m * path.ray.direction;
      if (!path.alive) return nullptr;
      ++path.result.scatterings;
      return in_air.event == PathAir::Event::kRayleigh ? &molecules_ : &aerosol_;
    }
  }
  if (hit.volume < 0) return nullptr;
  path.ray.origin_m += hit.t_m * path.ray.direction;
  ++path.result.scatterings;
#if defined(NEPHO_MUTANT_NO_CO_ALBEDO)
  const glm::dvec3 lost{0.0};
#else
  const glm::dvec3& lost = co_albedos_[std::size_t(hit.volume)];
#endif
  // By the co-albedo: 1 - 4e-7 has few digits left, and 4e-7 all of them.
  const double absorbed = std::min({lost.r, lost.g, lost.b});
  if (absorbed > 0) {
    if (random.uniform() < absorbed) {
      path.alive = false;
      return nullptr;
    }
    path.throughput *= (1.0 - lost) / (1 - absorbed);
  }
  const bool exact = exact_orders_ < 0 || path.result.scatterings <= exact_orders_;
  return exact ? &phase(hit) : &smooth_phase(hit);
}

double PathTracer::passed(const Path& path, const Ray& ray) const {
  const double clouds = medium_.transmittance(ray, kNoDistance_m, path.random);
  if (!air_ || !(clouds > 0)) return clouds;
  return clouds * air_->transmittance(ray, kNoDistance_m, path.hero, path.random);
}

// The sun, by a direction of its disc.
void PathTracer::light_at_collision(Path& path, const PhaseSampler& phase) const {
  const double near =
      most(path.weights() * phase.values(one_minus_cos(path.ray.direction, around_.sun_centre())));
  const double kept = std::min(1.0, near / kFaintWay_per_sr);
  if (kept < 1 && path.random.uniform() >= kept) return;
  const glm::dvec3 to_sun = around_.to_sun(path.random);
  const Ray ray{path.ray.origin_m, to_sun};
  if (around_.ground_hides(ray)) return;
  const glm::dvec3 value = phase.values(one_minus_cos(path.ray.direction, to_sun));
  const double density = mean(value);
  const double own = around_.sun_density(to_sun);
  const double part = around_.beam() ? 1 : power_weight(own, density);
  const glm::dvec3 light = part / kept * path.weights() * value * around_.sun_W_per_m2_nm();
  if (!(most(light) > 0)) return;
  path.add(light * passed(path, ray));
}

void PathTracer::scatter(Path& path, const PhaseSampler& phase) const {
  if (branches(path) && path.random.uniform() < kBranches) {
    Path branch = path;
    branch.result.radiance_W_per_m2_sr_nm = glm::dvec3{0.0};
    const glm::dvec3 direction =
        turned(around_.sun_centre(), peak_->sample_peak(path.hero, path.random), path.random);
    turn(branch, phase, direction, one_minus_cos(path.ray.direction, direction));
    follow(branch);
    path.add(branch.result.radiance_W_per_m2_sr_nm);
  }
  const Turn own = phase.sample(path.hero, path.random);
  turn(path, phase, turned(path.ray.direction, own, path.random), own.one_minus_cos);
}

// Of a path, by whichever of the two ways to draw its direction.
void PathTracer::turn(Path& path, const PhaseSampler& phase, const glm::dvec3& direction,
                      double one_minus_cos) const {
  const glm::dvec3 value = phase.values(one_minus_cos);
  path.ray.direction = direction;
  path.last_density = mean(value);
  if (!branches(path)) {
    if (!phase.grey()) path.densities *= value / value[path.hero];
    path.thin_out();
    return;
  }
  const glm::dvec3 peak = peak_->peak_values(nepho::one_minus_cos(direction, around_.sun_centre()));
#if defined(NEPHO_MUTANT_BRANCH_TWICE)
  const glm::dvec3 both = value;
#else
  const glm::dvec3 both = value + kBranches * peak;
#endif
  path.throughput *= value / both;
  if (!grey_) path.densities *= both / both[path.hero];
  path.thin_out(std::max(1.0, most(peak) / kStrongWay_per_sr));
}

// Light on the ground, and the way on. False where the path ends.
bool PathTracer::meet_ground(Path& path, double ground_m) const {
  const glm::dvec3 point_m = path.ray.origin_m + ground_m * path.ray.direction;
  const glm::dvec3 to_eye = -path.ray.direction;
  const Surroundings::Spot spot = around_.spot(point_m);
  const glm::dvec3 to_sun = around_.to_sun(path.random);
  const Ray ray{point_m, to_sun};
  const double own = around_.sun_density(to_sun);
  const double part = around_.beam() ? 1 : power_weight(own, around_.density(spot, to_eye, to_sun));
  const glm::dvec3 light =
      part * path.weights() * around_.reflect(spot, to_eye, to_sun) * around_.sun_W_per_m2_nm();
  if (most(light) > 0 && !around_.ground_hides(ray, true)) path.add(light * passed(path, ray));

  const Surroundings::Way way = around_.sample(spot, to_eye, path.random);
  const glm::dvec3 reflected = around_.reflect(spot, to_eye, way.direction);
  if (!(way.density > 0) || !(most(reflected) > 0)) return false;
  path.throughput *= reflected / way.density;
  path.ray = {point_m, way.direction};
  path.on_ground = true;
  path.last_density = way.density;
  path.thin_out();
  return path.alive;
}

void PathTracer::leave(Path& path, bool ground) const {
  const glm::dvec3& direction = path.ray.direction;
  glm::dvec3 seen = around_.background_W_per_m2_sr_nm(direction, ground);
  const bool from_eye = !(path.last_density > 0);
  if (!ground && (!from_eye || around_.shows_sun())) {
    const double own = around_.sun_density(direction);
    if (own > 0)
      seen += (from_eye ? 1 : power_weight(path.last_density, own)) *
              around_.disc_W_per_m2_sr_nm(direction);
  }
  path.add(path.weights() * seen);
}

}  // namespace nepho
