#include <gtest/gtest.h>

#include <numbers>

#include "analytic_field.h"
#include "march_support.h"
#include "physics/physics_cpp.h"
#include "random.h"

namespace nepho {
namespace {

using std::numbers::pi;
using test::FieldSource;
using test::FixedLevel;

constexpr double kSide_m = 1000;

glm::dvec3 towards(double mu, double azimuth_rad) {
  const double sine = std::sqrt((1 - mu) * (1 + mu));
  return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), mu};
}

struct Geometry {
  double mu, mu0, azimuth_rad;
  bool up;
};
const std::vector<Geometry> kGeometries = {
    {1, 1, 0, true},      {0.5, 0.5, 0.7, true},  {0.2, 0.9, 2, true}, {0.7, 0.3, 3, true},
    {0.9, 0.5, 1, false}, {0.5, 0.5, 0.3, false}, {0.2, 0.8, 2, false}};

RenderRequest slab_request(const BrickSource& source, const Geometry& g) {
  RenderRequest request = test::request_of({test::volume_of(source)});
  request.sun.to_sun = towards(g.mu0, 0);
  return request;
}
// A ray that meets the slab from above (sees what goes up) or from below.
Ray slab_ray(const Geometry& g) {
  const glm::dvec3 to_eye = towards(g.mu, g.azimuth_rad) * glm::dvec3(1, 1, g.up ? 1 : -1);
  const glm::dvec3 at{500, 500, g.up ? kSide_m : 0.0};
  return {at + 100.0 * to_eye, -to_eye};
}
// Closed form of single scattering: I = w P / (4 pi) ...
double single_scattering(const Geometry& g, double tau, double asymmetry) {
  const glm::dvec3 apart = towards(g.mu0, 0) - slab_ray(g).direction;
  const double p = f64::hg_phase(0.5 * glm::dot(apart, apart), asymmetry);
  if (g.up) return p * g.mu0 / (g.mu + g.mu0) * -std::expm1(-tau * (1 / g.mu + 1 / g.mu0));
  const double x = tau * (1 / g.mu - 1 / g.mu0);
  const double e0 = x == 0 ? 1 : -std::expm1(-x) / x;
  return p * tau / g.mu * std::exp(-tau / g.mu0) * e0;
}

TEST(Radiance, SingleScatteringInASlabIsTheClosedForm) {
  for (const double tau : {0.01, 1.0, 8.0}) {
    const FieldSource source(test::box(kSide_m, {true, true}), test::isotropic(1),
                             [&](glm::dvec3) { return tau / kSide_m; });
    const RenderVolume volume = test::volume_of(source);
    const FinestLevels levels({&volume, 1}, 1);
    for (const Geometry& g : kGeometries)
      for (const double tolerance : {1e-4, 1e-7}) {
        const RayMarch march(levels, slab_request(source, g),
                             {.source_tolerance = tolerance, .least_transmittance = 0});
        const double found = march.trace(slab_ray(g)).radiance_W_per_m2_sr_nm.g;
        // A table's logarithm is linear between texels: 2e-5 of the phase function.
        const double exact = single_scattering(g, tau, 0.85);
        EXPECT_NEAR(found, exact, (tolerance > 1e-5 ? 2e-3 : 3e-5) * exact)
            << tau << " " << g.mu << " " << g.mu0 << " " << g.up << " " << tolerance;
      }
  }
}

TEST(Radiance, CellExactStepsConvergeAsTheSquareOfTheCell) {
  constexpr double tau = 6;
  const FieldSource source(test::box(kSide_m, {true, true}), test::isotropic(3),
                           [](glm::dvec3) { return tau / kSide_m; });
  const Geometry g{0.9, 0.3, 1, true};
  std::array<double, 4> error{};
  for (int level = 0; level < 4; ++level) {
    const FixedLevel levels({&source}, level);
    const RayMarch march(levels, slab_request(source, g), {.source_tolerance = 1e9});
    error[std::size_t(level)] = std::abs(
        march.trace(slab_ray(g)).radiance_W_per_m2_sr_nm.g / single_scattering(g, tau, 0.85) - 1);
    std::printf("%d cells: %.2e\n", 8 << level, error[std::size_t(level)]);
  }
  EXPECT_NEAR(std::log2(error[0] / error[2]) / 2, 2, 0.3);
}

TEST(Radiance, OctavesAddTheirOwnClosedForms) {
  constexpr double tau = 3;
  const FieldSource source(test::box(kSide_m, {true, true}), test::isotropic(0),
                           [](glm::dvec3) { return tau / kSide_m; });
  const RenderVolume volume = test::volume_of(source);
  const FinestLevels levels({&volume, 1}, 1);
  const Geometry g{0.8, 0.6, 1, true};
  RenderRequest request = slab_request(source, g);
  request.settings.light = Light::kOctaves;
  request.settings.octaves = 5;
  const glm::dvec3 apart = towards(g.mu0, 0) - slab_ray(g).direction;
  double exact = 0;
  for (int n = 0; n < 5; ++n) {
    const double p = f64::hg_phase(0.5 * glm::dot(apart, apart), f64::octave_asymmetry(n, 0.85));
    const double fade = std::pow(f64::octave_b, n) / g.mu0;
    exact +=
        f64::octave_scattering(n) * p / (1 + fade * g.mu) * -std::expm1(-tau * (1 / g.mu + fade));
  }
  const RayMarch march(levels, request, {.source_tolerance = 1e-7});
  EXPECT_NEAR(march.trace(slab_ray(g)).radiance_W_per_m2_sr_nm.g, exact, 3e-5 * exact);
}

// In a uniform sky of radiance 1 and without absorption, light that is scattered in replaces what
// is scattered out wherever every direction is visible: a thin cloud is invisible to first order.
TEST(Radiance, AThinCloudInAUniformSkyIsInvisible) {
  const FieldSource source(test::box(kSide_m), test::isotropic(0),
                           [](glm::dvec3) { return 1e-3 / kSide_m; });
  const RenderVolume volume = test::volume_of(source);
  const FinestLevels levels({&volume, 1}, 1);
  RenderRequest request = test::request_of({volume}, Light::kOctaves);
  request.sun.irradiance_W_per_m2_nm = glm::dvec3{0.0};
  request.sky.zenith_W_per_m2_sr_nm = request.sky.horizon_W_per_m2_sr_nm =
      request.sky.below_W_per_m2_sr_nm = glm::dvec3{1.0};
  const MarchResult seen = RayMarch(levels, request).trace({{500, -500, 400}, {0, 1, 0}});
  EXPECT_NEAR(seen.optical_depth, 1e-3, 1e-9);
  EXPECT_NEAR(seen.radiance_W_per_m2_sr_nm.g, 1, 1e-6);
  request.volumes[0].co_albedo = glm::dvec3{1.0};
  const MarchResult black = RayMarch(levels, request).trace({{500, -500, 400}, {0, 1, 0}});
  EXPECT_NEAR(black.radiance_W_per_m2_sr_nm.g, std::exp(-1e-3), 1e-9);
}

double blob(glm::dvec3 p) {
  return 8 * test::cloud(7.0 / kSide_m * p);
}
double fog(glm::dvec3 p) {
  return 0.004 * (1 - 0.5 * p.z / kSide_m);
}

TEST(Radiance, OverlappingVolumesAddInAnyOrder) {
  const FieldSource a(test::box(kSide_m), test::isotropic(2), blob);
  const FieldSource b(test::box(kSide_m), test::isotropic(2), fog);
  const FieldSource both(test::box(kSide_m), test::isotropic(2),
                         [](glm::dvec3 p) { return blob(p) + fog(p); });
  const std::vector<std::vector<const BrickSource*>> orders = {{&a, &b}, {&b, &a}, {&both}};
  std::array<std::vector<MarchResult>, 3> seen;
  for (std::size_t o = 0; o < 3; ++o) {
    std::vector<RenderVolume> volumes;
    for (const BrickSource* source : orders[o]) volumes.push_back(test::volume_of(*source));
    const FinestLevels levels(volumes, 8);
    RenderRequest request = test::request_of(volumes, Light::kOctaves);
    request.sun.to_sun = towards(0.5, 1);
    request.sky.zenith_W_per_m2_sr_nm = glm::dvec3{0.05};
    const RayMarch march(levels, request);
    test::Random random;
    for (int i = 0; i < 12; ++i) {
      const glm::dvec3 to{random.uniform(200, 800), random.uniform(200, 800),
                          random.uniform(200, 800)};
      const glm::dvec3 d = random.direction();
      seen[o].push_back(march.trace({to - (i % 2 ? 1500.0 : 0.0) * d, d}));
    }
  }
  for (std::size_t i = 0; i < seen[0].size(); ++i) {
    const double sum = seen[2][i].radiance_W_per_m2_sr_nm.g;
    EXPECT_NEAR(seen[0][i].radiance_W_per_m2_sr_nm.g, seen[1][i].radiance_W_per_m2_sr_nm.g,
                1e-12 * sum);
    EXPECT_NEAR(seen[0][i].radiance_W_per_m2_sr_nm.g, sum, 5e-4 * sum);
    EXPECT_NEAR(seen[0][i].optical_depth, seen[2][i].optical_depth,
                1e-4 * seen[2][i].optical_depth);
  }
}

// Half the extinction twice is the whole; with different albedos each scatters its own share.
TEST(Radiance, SourcesAreWeightedByTheirOwnScattering) {
  constexpr double tau = 2;
  const FieldSource half(test::box(kSide_m, {true, true}), test::isotropic(0),
                         [](glm::dvec3) { return 0.5 * tau / kSide_m; });
  std::vector<RenderVolume> volumes = {test::volume_of(half, 0.85), test::volume_of(half, 0.2)};
  volumes[1].co_albedo = glm::dvec3{0.25};
  const FinestLevels levels(volumes, 1);
  const Geometry g{0.8, 0.6, 1, true};
  RenderRequest request = slab_request(half, g);
  request.volumes = volumes;
  const double exact =
      0.5 * single_scattering(g, tau, 0.85) + 0.5 * 0.75 * single_scattering(g, tau, 0.2);
  const RayMarch march(levels, request, {.source_tolerance = 1e-7});
  EXPECT_NEAR(march.trace(slab_ray(g)).radiance_W_per_m2_sr_nm.g, exact, 3e-5 * exact);
}

TEST(Radiance, CutAtTheFinestLevelSeesWhatTheSourceSees) {
  const FieldSource source(test::box(kSide_m), test::isotropic(3), blob);
  std::vector<RenderVolume> volumes = {test::volume_of(source)};
  Refinement refinement;
  refinement.camera = {.eye_m = {500, -1500, 500}, .target_m = {500, 500, 500}};
  refinement.settings.tolerance = 1e-12;
  const Forest forest = build_forest(volumes, refinement);
  const CutLevels cut(forest);
  const NoisyCutLevels noisy(forest, 7), again(forest, 7), other(forest, 8);
  const FinestLevels finest(volumes, 8), cramped(volumes, 0.01);
  const RenderRequest request = test::request_of(volumes);
  double noise = 0;
  for (int i = 0; i < 30; ++i) {
    const Ray ray = camera_ray(refinement.camera, 6, 5, i % 6, i / 6);
    const auto depth = [&](const LevelSet& levels) {
      return RayMarch(levels, request).trace(ray).optical_depth;
    };
    const double exact = depth(finest);
    EXPECT_NEAR(depth(cut), exact, 1e-12 + 1e-10 * exact);
    EXPECT_EQ(depth(cramped), exact) << "a small cache costs time only";
    EXPECT_EQ(depth(noisy), depth(again));
    noise = std::max(noise, std::abs(depth(noisy) - depth(other)));
    EXPECT_NEAR(depth(noisy), exact, 1e-4 * (0.1 + exact));
  }
  EXPECT_GT(noise, 0);
  EXPECT_GT(cramped.bricks_read(), finest.bricks_read());
}

}  // namespace
}  // namespace nepho
