#pragma once

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "field_source.h"
#include "reference/path/path_picture.h"
#include "statistics.h"

namespace nepho::test {

// The path tracer against numbers from elsewhere. Every number is measured to kPrecision or better,
// so that one that is off by kBias is caught with a chance above kPower at p <= kAccept; whoever
// compares asserts that chance (compare.cpp).
inline constexpr double kBias = 0.02, kPower = 0.9, kPrecision = 0.004;

// NEPHO_TRUTH_SAMPLES of the environment, 1 without it: how many times the samples of a quick run.
double sample_factor();

// Of the test that runs: no two of them share random numbers.
std::uint64_t case_seed();

template <std::size_t N>
using Means = std::array<MeanVariance, N>;

// Means of the N numbers that history(random) gives, over `count` of them, in blocks that run side
// by side; the same for any number of threads.
template <std::size_t N, class History>
Means<N> measure(std::uint64_t seed, std::size_t count, History&& history) {
  constexpr std::size_t kBlock = 2048;
  std::vector<Means<N>> blocks((count + kBlock - 1) / kBlock);
  seed ^= case_seed();
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) {
      Random random(seed, i, 0);
      const std::array<double, N> values = history(random);
      for (std::size_t n = 0; n < N; ++n) blocks[b][n].add(values[n]);
    }
  });
  Means<N> all{};
  for (const Means<N>& block : blocks)
    for (std::size_t n = 0; n < N; ++n) all[n].add(block[n]);
  return all;
}

// As many histories as all N need for this relative standard error, by a pilot run of others.
template <std::size_t N, class History>
std::array<Estimate, N> measure_to(std::uint64_t seed, History&& history,
                                   double precision = kPrecision) {
  constexpr double kPilot = 8192, kMost = 4e7;
  double needed = 0;
  for (const MeanVariance& m : measure<N>(~seed, std::size_t(kPilot), history))
    needed = std::max(needed, m.variance() / std::pow(m.mean() * precision, 2));
  const double count = std::clamp(needed, kPilot, kMost) * sample_factor();
  std::array<Estimate, N> estimates;
  const Means<N> means = measure<N>(seed, std::size_t(count), history);
  for (std::size_t n = 0; n < N; ++n) estimates[n] = mean_of(means[n]);
  return estimates;
}

struct Compared {
  std::string what;
  Estimate ours, truth;
};
// Each agrees at p > kAccept, and would not with kBias; printed, and rows of the accuracy report.
void expect_agreement(const std::string& name, const std::vector<Compared>& all);
// The same with a mistake of kBias planted: one of them at least does not agree.
void expect_caught(const std::string& name, const std::vector<Compared>& all);

inline Phase hg(double g) {
  return {.kind = PhaseKind::kHenyeyGreenstein, .asymmetry = g};
}

// Volumes and what is around them. The sun is a beam, unless its radius is set, and
// no phase function is smoothed.
class Medium {
 public:
  RenderRequest request;
  PathSettings settings{.sun_radius_rad = 0, .exact_orders = -1};

  Medium();
  RenderVolume& add(std::shared_ptr<const BrickSource> source, const Phase& phase,
                    double co_albedo = 0);
  template <class Field>
  RenderVolume& add(std::shared_ptr<const Chart> chart, Lattice lattice, Field&& field,
                    const Phase& phase, double co_albedo = 0) {
    return add(std::make_shared<FieldSource>(std::move(chart), std::move(lattice), field), phase,
               co_albedo);
  }
  // Over the finest bricks; the volumes stay as they are from now on.
  const PathTracer& tracer();

 private:
  std::vector<std::shared_ptr<const BrickSource>> sources_;
  Forest forest_;
  std::unique_ptr<PathTracer> tracer_;
};

// A history that begins at a light: until it is absorbed or leaves. reach(ray) is how far the
// medium goes, at most.
struct Escape {
  Ray ray;  // from the last collision
  int scatterings = 0;
  bool absorbed = false;
};
template <class Reach>
Escape walk(const PathTracer& tracer, const Ray& ray, Random& random, Reach&& reach,
            int wavelength = 1) {
  Escape escape{.ray = ray};
  while (true) {
    const auto hit = tracer.medium().collide(escape.ray, reach(escape.ray), random);
    if (hit.volume < 0) return escape;
    escape.ray.origin_m += hit.t_m * escape.ray.direction;
    escape.absorbed = random.uniform() < tracer.co_albedo(hit, wavelength);
    if (escape.absorbed) return escape;
    ++escape.scatterings;
    escape.ray.direction = tracer.scattered(hit, escape.ray.direction, wavelength, random);
  }
}
inline Escape walk(const PathTracer& tracer, const Ray& ray, Random& random, int wavelength = 1) {
  return walk(
      tracer, ray, random, [](const Ray&) { return kNoDistance_m; }, wavelength);
}

// By the cosine law into the half-space around a unit normal.
glm::dvec3 cosine_law(const glm::dvec3& normal, Random& random);

// A slab between z = 0 and 100 m without end, as a periodic box: even, or a tent of the same
// optical depth, which takes null collisions.
inline constexpr double kSlab_m = 100;
enum class Profile { kEven, kTent };
void add_slab(Medium& medium, Profile profile, double optical_depth, const Phase& phase,
              double co_albedo);

// An even sphere of 1 km about the origin, as a shell that leaves 1e-9 of its volume out in the
// middle. The optical depth is that of its diameter.
inline constexpr double kBallRadius_m = 500;
void add_ball(Medium& medium, double optical_depth, const Phase& phase, double co_albedo = 0);

}  // namespace nepho::test
