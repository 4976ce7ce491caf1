// Stiff cases of traced paths: each computes its naive form beside the project's.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/accumulator.h"
#include "expect_stable.h"
#include "march_support.h"
#include "reference/path/path_tracer.h"

namespace nepho::test {
namespace {

using Real = long double;
constexpr double kSide_m = 1000, kInfinity = std::numeric_limits<double>::infinity();

TEST(Paths, TurnsKeepTheirSine) {
  double worst = 0, naive = 0;
  for (const double g : {-0.9999, -0.5, 1e-4, 0.85, 0.99, 0.999, 0.9999})
    for (int step = 0; step < 400; ++step) {
      const double end = 0.5 * std::pow(10, -0.06 * (step / 2)), u = step % 2 ? end : 1 - end;
      const Real q = 1 - Real(u), d = (1 - Real(g)) * q + (1 + Real(g)) * Real(u);
      const Real exact = 2 * (1 - Real(g) * Real(g)) / (d * d) *
                         std::sqrt(Real(u) * q * (1 + Real(g) * Real(u)) * (1 - Real(g) * q));
      worst = std::max(worst, double(std::abs(Real(sample_hg(g, u).sine) / exact - 1)));
      const double root = (1 - g * g) / (1 - g + 2 * g * u);
      const double cosine = (1 + g * g - root * root) / (2 * g);
      const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
      naive = std::max(naive, double(std::abs(Real(sine) / exact - 1)));
    }
  // No branch for the isotropic case, and both ends.
  for (const double u : {0.0, 0.25, 1.0}) {
    EXPECT_EQ(sample_hg(0, u).one_minus_cos, 2 * (1 - u));
    EXPECT_TRUE(std::isfinite(sample_hg(0.9999, u).sine));
  }
  expect_stable("07", worst, 1e-9, naive, "relative");
}

// Distribution function of Draine's cosine, from -1: by Gauss-Legendre of 3 points in short steps.
struct DraineDistribution {
  static constexpr int kSteps = 20000;
  std::vector<double> sums{0};
  DraineDistribution(double g, double alpha) {
    for (int i = 0; i < kSteps; ++i) {
      const double middle = 2 * (i + 0.5) / kSteps - 1, half = 1.0 / kSteps;
      double sum = 0;
      for (const auto& [at, weight] :
           {std::pair{-std::sqrt(0.6), 5 / 9.0}, {0.0, 8 / 9.0}, {std::sqrt(0.6), 5 / 9.0}})
        sum += weight * draine_phase(1 - (middle + half * at), g, alpha);
      sums.push_back(sums.back() + 2 * std::numbers::pi * half * sum);
    }
  }
  double operator()(double mu) const {
    const double at = std::clamp((mu + 1) / 2 * kSteps, 0.0, double(kSteps));
    const auto i = std::min(std::size_t(at), std::size_t(kSteps - 1));
    return sums[i] + (at - double(i)) * (sums[i + 1] - sums[i]);
  }
};

// Kolmogorov's statistic: the largest distance between both distribution functions, times sqrt(n).
double kolmogorov(std::vector<double> mu, const DraineDistribution& distribution) {
  const double n = double(mu.size());
  for (const double value : mu)
    if (!std::isfinite(value)) return kInfinity;
  std::ranges::sort(mu);
  double worst = 0;
  for (std::size_t i = 0; i < mu.size(); ++i) {
    const double f = distribution(mu[i]);
    worst = std::max({worst, f - double(i) / n, double(i + 1) / n - f});
  }
  return worst * std::sqrt(n);
}

// The inverse of Draine's distribution by radicals (Jendersie and d'Eon 2023,
// doi:10.1145/3587421.3595409, supplement).
template <class T>
T draine_by_radicals(T u, T g, T a) {
  const T g2 = g * g, g3 = g * g2, g4 = g2 * g2, g6 = g2 * g4, square = (1 + g2) * (1 + g2);
  const T t1a = -a + a * g4;
  const T t2 = -1296 * (-1 + g2) * (a - a * g2) * t1a * (4 * g2 + a * square);
  const T t3 = 3 * g2 * (1 + g * (-1 + 2 * u)) + a * (2 + g2 + g3 * (1 + 2 * g2) * (-1 + 2 * u));
  const T t4a = 432 * t1a * t1a * t1a + t2 + 432 * (a - a * g2) * t3 * t3;
  const T t4b = -144 * a * g2 + 288 * a * g4 - 144 * a * g6;
  const T t4 = std::cbrt(t4a + std::sqrt(-4 * t4b * t4b * t4b + t4a * t4a)), two = std::cbrt(T(2));
  const T t6 =
      (2 * t1a + 48 * two * (-(a * g2) + 2 * a * g4 - a * g6) / t4 + t4 / (3 * two)) / (a - a * g2);
  const T root = std::sqrt(6 * (1 + g2) + t6);
  const T last = std::sqrt(6 * (1 + g2) - 8 * t3 / (a * (-1 + g2) * root) - t6);
  const T half = (last - root) / 2;
  return (1 + g2 - half * half) / (2 * g);
}

TEST(Paths, DrainesFunctionIsSampled) {
  constexpr int n = 100000;
  double worst = 0, naive = 0;
  for (const auto& [g, alpha] : {std::pair{0.594, 27.1}, {0.1, 0.5}, {0.01, 1.0}}) {
    const DraineDistribution distribution(g, alpha);
    EXPECT_NEAR(distribution.sums.back(), 1, 1e-9);
    Random random(7, 1, 0);
    std::vector<double> drawn, usual, in_double;
    for (int i = 0; i < n; ++i) {
      drawn.push_back(1 - sample_draine(g, alpha, random).one_minus_cos);
      const double u = (i + 0.5) / n;
      usual.push_back(double(draine_by_radicals(float(u), float(g), float(alpha))));
      in_double.push_back(draine_by_radicals(u, g, alpha));
    }
    if (g > 0.05) {
      EXPECT_LE(kolmogorov(in_double, distribution), 0.1);  // the radicals are right
    }
    worst = std::max(worst, kolmogorov(drawn, distribution));
    naive = std::max(naive, kolmogorov(usual, distribution));
  }
  expect_stable("09", worst, 1.63, naive, "Kolmogorov's statistic, p = 0.01");
}

TEST(Paths, FreePathsHaveATail) {
  constexpr double depth = 16.65;
  constexpr std::size_t blocks = 512, each = 250000;
  std::vector<int> beyond(blocks, 0);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    Random random(11, block, 0);
    for (std::size_t i = 0; i < each; ++i) beyond[block] += random.depth() > depth;
  });
  double count = 0;
  for (const int b : beyond) count += b;
  const double expected = double(blocks * each) * std::exp(-depth);
  const double sigma = std::sqrt(expected);
  // 24 bits: the largest number below 1 is a depth of 16.6.
  const double most = -std::log(0x1p-24);
  const double naive = most > depth ? 0 : expected / sigma;
  expect_stable("41", std::abs(count - expected) / sigma, 2.5, naive,
                "standard deviations of the number of depths over 16.65");
}

struct Slab {
  FieldSource source;
  RenderRequest request;
  Forest forest;
  Slab(double tau, const Phase& phase)
      : source(box(kSide_m, {true, true}), isotropic(0),
               [=](glm::dvec3) { return tau / kSide_m; }) {
    RenderVolume volume = volume_of(source);
    volume.phase = phase;
    request = request_of({volume});
    Refinement refinement;
    refinement.camera = {.eye_m = {500, -3000, 400}, .target_m = {500, 500, 500}};
    forest = build_forest(request.volumes, refinement);
  }
};

// Under an even sky and over black ground a slab shows its albedo; 0.999310608 by adding-doubling
// (Hansen and Travis 1974) at an optical depth of 16384, g = 0.85, straight down.
TEST(Paths, ThickSlabsReflect) {
  constexpr double tau = 16384, truth = 0.999310608, g = 0.85;
  constexpr std::size_t paths = 300;
  Slab slab(tau, {.kind = PhaseKind::kHenyeyGreenstein, .asymmetry = g});
  slab.request.sun.irradiance_W_per_m2_nm = glm::dvec3(0);
  slab.request.sky.zenith_W_per_m2_sr_nm = slab.request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(1);
  slab.request.sky.below_W_per_m2_sr_nm = glm::dvec3(0);
  const PathTracer tracer(slab.forest, slab.request);
  const Ray down{{500, 500, 1500}, {0, 0, -1}};
  std::vector<double> seen(paths), capped(paths);
  tbb::parallel_for(std::size_t{0}, paths, [&](std::size_t i) {
    Random random(3, i, 0);
    const PathSample sample = tracer.sample(down, random);
    seen[i] = sample.radiance_W_per_m2_sr_nm.g;
    capped[i] = sample.scatterings <= 64 ? seen[i] : 0;
  });
  MeanVariance mean, with_cap;
  for (std::size_t i = 0; i < paths; ++i) mean.add(seen[i]), with_cap.add(capped[i]);
  expect_stable("32", std::abs(mean.mean() / truth - 1), 5e-3,
                std::abs(with_cap.mean() / truth - 1), "of the albedo");
}

// Beside the sun, through a cloud of droplets: their forward peak against a disc of 6.9e-5 sr.
TEST(Paths, TheSunBesideItself) {
  constexpr std::size_t paths = 16384;
  Slab slab(2, {.kind = PhaseKind::kMie, .effective_radius_m = 10e-6});
  slab.request.sun.to_sun = glm::normalize(glm::dvec3(0.5, 0, 0.8));
  const PathTracer tracer(slab.forest, slab.request);
  const glm::dvec3 to_sun = slab.request.sun.to_sun;
  const Ray up{{500, 500, -100}, glm::normalize(to_sun + glm::dvec3(0, 0.03, 0))};
  const double disc_sr = 2 * std::numbers::pi * (1 - std::cos(0.004675));
  const auto history = [&](std::size_t i) {  // the sun met by chance alone
    Random random(5, i, 0);
    Ray ray = up;
    int scatterings = 0;
    while (true) {
      const auto hit = tracer.medium().collide(ray, kNoDistance_m, random);
      if (hit.volume < 0) break;
      ray.origin_m += hit.t_m * ray.direction;
      ray.direction = tracer.scattered(hit, ray.direction, 1, random);
      ++scatterings;
    }
    const bool met = scatterings > 0 && glm::dot(ray.direction, to_sun) > std::cos(0.004675);
    return met ? slab.request.sun.irradiance_W_per_m2_nm.g / disc_sr : 0.0;
  };
  std::vector<double> seen(paths), chance(paths);
  tbb::parallel_for(std::size_t{0}, paths, [&](std::size_t i) {
    Random random(4, i, 0);
    seen[i] = tracer.sample(up, random).radiance_W_per_m2_sr_nm.g;
    chance[i] = history(i);
  });
  MeanVariance half, all, usual;
  for (std::size_t i = 0; i < paths; ++i) {
    if (i % 2) half.add(seen[i]);
    all.add(seen[i]), usual.add(chance[i]);
  }
  // Twice the paths, half the variance: no outlier rules it.
  EXPECT_NEAR(std::pow(half.standard_error() / all.standard_error(), 2), 2, 0.4);
  EXPECT_NEAR(usual.mean(), all.mean(), 5 * usual.standard_error() + 5 * all.standard_error());
  expect_stable("43", all.standard_error() / all.mean(), 0.03, usual.standard_error() / all.mean(),
                "relative standard error of 16384 paths");
}

}  // namespace
}  // namespace nepho::test
