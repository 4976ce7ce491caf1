#include <gtest/gtest.h>

#include <numbers>

#include "analytic_field.h"
#include "bricks/quantise.h"
#include "march_support.h"
#include "random.h"

namespace nepho {
namespace {

using test::FieldSource;
using test::FixedLevel;
constexpr double kSide_m = 1000;

double depth(const LevelSet& levels, const Ray& ray) {
  return RayMarch(levels, test::request_of({})).optical_depth(ray);
}

const FieldSource& cloud_source() {
  static const FieldSource source(test::box(kSide_m), test::isotropic(3),
                                  [](glm::dvec3 p) { return test::cloud(7.0 / kSide_m * p); });
  return source;
}

// The decoded field by point lookup: no walk, no walls.
double decoded_at(const LevelSet& levels, glm::dvec3 p_m) {
  const VolumeInfo& info = levels.info(0);
  const RootPosition at = info.chart->locate(p_m);
  const Index3& n = info.lattice.cells(info.lattice.max_level());
  Index3 cell;
  for (int a = 0; a < 3; ++a) {
    const double x = at.q[a] * n[std::size_t(a)];
    if (x < 0 || x > n[std::size_t(a)]) return 0;
    cell[std::size_t(a)] = std::min(std::uint32_t(x), n[std::size_t(a)] - 1);
  }
  const LevelLeaf leaf = levels.leaf(0, at.root, cell);
  if (leaf.kind == NodeKind::kEmpty) return 0;
  if (leaf.kind == NodeKind::kConstant) return leaf.constant_per_m;
  const Index3& own = info.lattice.cells(leaf.key.level());
  double sum = 0;
  for (std::uint32_t c = 0; c < 8; ++c) {
    double weight = 1;
    Index3 s;
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = at.q[int(a)] * own[a] - 8.0 * leaf.key.ijk()[a];
      const double low = std::clamp(std::floor(x), 0.0, 7.0);
      const std::uint32_t up = c >> a & 1;
      weight *= up ? x - low : 1 - (x - low);
      s[a] = std::uint32_t(low) + up;
    }
    sum += weight * double(decode(leaf.brick->codes[brick_offset(s[0], s[1], s[2])],
                                  leaf.brick->scale, leaf.brick->offset));
  }
  return sum;
}

double brute_force(const LevelSet& levels, const Ray& ray, double length_m, int steps) {
  double sum = 0;
  for (int s = 0; s < steps; ++s)
    sum += decoded_at(levels, ray.origin_m + (s + 0.5) * length_m / steps * ray.direction);
  return sum * length_m / steps;
}

Forest forest_of(const BrickSource& source, double tolerance, int max_level = 31) {
  Refinement refinement;
  refinement.camera = {.eye_m = {500, -3000, 400}, .target_m = {500, 500, 500}};
  refinement.settings.tolerance = tolerance;
  refinement.settings.max_level = max_level;
  const RenderVolume volume = test::volume_of(source);
  return build_forest({&volume, 1}, refinement);
}

TEST(OpticalDepth, EqualsBruteForceAlongRandomRays) {
  const Forest forest = forest_of(cloud_source(), 1.5);
  const CutLevels cut(forest);
  const RenderVolume volume = test::volume_of(cloud_source());
  const FinestLevels finest({&volume, 1}, 8);
  std::set<int> levels_used;
  for (const LeafBrick& brick : forest.volumes[0].bricks) levels_used.insert(brick.key.level());
  ASSERT_GE(levels_used.size(), 2u) << "the cut was meant to mix levels";
  test::Random random;
  double worst = 0, most = 0;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 target{random.uniform(100, 900), random.uniform(100, 900),
                            random.uniform(100, 900)};
    const glm::dvec3 direction = random.direction();
    const Ray ray{target - (i % 3 ? 2000.0 : 0.0) * direction, direction};
    for (const LevelSet* levels :
         {static_cast<const LevelSet*>(&cut), static_cast<const LevelSet*>(&finest)}) {
      const double exact = depth(*levels, ray), brute = brute_force(*levels, ray, 4000, 40000);
      worst = std::max(worst, std::abs(exact - brute));
      most = std::max(most, exact);
    }
  }
  std::printf("worst difference %.2e of optical depths up to %.2f\n", worst, most);
  EXPECT_GT(most, 1);
  EXPECT_LT(worst, 1e-4 * most);  // the brute force jumps at faces between levels
}

TEST(OpticalDepth, OfATrilinearFieldIsItsCubicsIntegral) {
  const auto field = [](glm::dvec3 p) {
    const glm::dvec3 q = p / kSide_m;
    return 0.01 * (1 + q.x) * (1 + 2 * q.y) * (2 - q.z);
  };
  test::Random random;
  for (int level = 0; level <= 2; ++level) {
    const FieldSource source(test::box(kSide_m), test::isotropic(level), field);
    const FixedLevel levels({&source}, level);
    for (int i = 0; i < 40; ++i) {
      const glm::dvec3 a{random.uniform(0, 1000), random.uniform(0, 1000), 0};
      const glm::dvec3 b{random.uniform(0, 1000), random.uniform(0, 1000), kSide_m};
      const double length_m = glm::length(b - a);
      const double exact = length_m / 6 * (field(a) + 4 * field((a + b) / 2.0) + field(b));
      // Half a 16-bit step of the largest value.
      EXPECT_NEAR(depth(levels, {a - (b - a), glm::normalize(b - a)}), exact,
                  0.12 / 65535 / 2 * length_m);
    }
  }
}

TEST(OpticalDepth, AlongWallsEdgesAndCornersAndFromInside) {
  const FieldSource source(test::box(kSide_m), test::isotropic(2), [](glm::dvec3) { return 0.01; });
  const FixedLevel levels({&source}, 2);
  const RenderVolume volume = test::volume_of(source);
  const FinestLevels whole({&volume, 1}, 1);
  const double tau = 0.01 * kSide_m, ulps = 1e-9 * tau;
  const auto both = [&](const Ray& ray, double expected) {
    EXPECT_NEAR(depth(whole, ray), double(float(0.01)) * expected / 0.01, ulps);
    EXPECT_NEAR(depth(levels, ray), expected, 2e-5 * expected + ulps);
  };
  for (const double y : {0.0, 125.0, 500.0, 1000.0, 333.0})
    for (const double z : {0.0, 250.0, 1000.0, 77.0})
      for (const double sign : {-1.0, 1.0}) {
        both({{500 - 3000 * sign, y, z}, {sign, 0, 0}}, tau);
        both({{y, z, 500 - 3000 * sign}, {0, 0, sign}}, tau);
      }
  const glm::dvec3 diagonal = glm::normalize(glm::dvec3{1, 1, 1});
  both({-500.0 * diagonal, diagonal}, tau * std::sqrt(3.0));
  both({glm::dvec3{1500.0}, -diagonal}, tau * std::sqrt(3.0));
  const glm::dvec3 edge = glm::normalize(glm::dvec3{1, 1, 0});
  both({{-100, -100, 1000}, edge}, tau * std::sqrt(2.0));
  both({{500, 500, 500}, {0, 0, 1}}, tau / 2);
  both({{500, 500, 500}, {0, -1, 0}}, tau / 2);
  both({{500, 500, 1000.001}, {1, 0, 0}}, 0);
  both({{500, 500, 1500}, {0, 0, 1}}, 0);
  both({{-3000, 500, 1e-9}, {1, 0, 0}}, tau);
}

TEST(OpticalDepth, PiecesAreBoundedByTheCellsARayCanCross) {
  const FixedLevel levels({&cloud_source()}, 3);
  test::Random random;
  std::size_t most = 0;
  for (int i = 0; i < 200; ++i) {
    glm::dvec3 d = random.direction();
    if (i % 4 == 0) d[i / 4 % 3] = 0;
    if (i % 8 == 0) d = {d.x == 0 ? 0 : 1, d.y == 0 ? 0 : 1, d.z == 0 ? 0 : 1};
    d = glm::normalize(d);
    const glm::dvec3 corner{std::round(random.uniform(0, 64)), std::round(random.uniform(0, 64)),
                            std::round(random.uniform(0, 64))};
    VolumeWalk walk(levels, 0, {kSide_m / 64 * corner - 2000.0 * d, d}, kNoDistance_m, true);
    double end_m = -1;
    while (walk.next()) {
      if (end_m >= 0) {
        EXPECT_EQ(walk.t0_m(), end_m);
      }
      EXPECT_GE(walk.t1_m(), walk.t0_m());
      end_m = walk.t1_m();
    }
    most = std::max(most, walk.pieces());
  }
  std::printf("most pieces %zu\n", most);
  EXPECT_LE(most, 3 * 64u + 3u);
}

// 1.4 of the closed forms: tau = sigma0 s sqrt(2 pi) exp(-b^2 / 2 s^2); interpolation errs by h^2.
TEST(OpticalDepth, OfAGaussianBlobConvergesAsTheSquareOfTheCell) {
  constexpr double s_m = 110, sigma0_per_m = 0.02;
  const auto blob = [](glm::dvec3 p) {
    const glm::dvec3 d = p - glm::dvec3{500.0};
    return sigma0_per_m * std::exp(-glm::dot(d, d) / (2 * s_m * s_m));
  };
  std::array<double, 4> error{};
  for (int level = 0; level < 4; ++level) {
    const FieldSource source(test::box(kSide_m), test::isotropic(level), blob);
    const FixedLevel levels({&source}, level);
    test::Random random;
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 d = random.direction();
      const glm::dvec3 side = glm::normalize(glm::cross(d, random.direction()));
      const double b_m = random.uniform(0, 150);
      const double exact = sigma0_per_m * s_m * std::sqrt(2 * std::numbers::pi) *
                           std::exp(-b_m * b_m / (2 * s_m * s_m));
      const double found = depth(levels, {glm::dvec3{500.0} + b_m * side - 2000.0 * d, d});
      error[std::size_t(level)] = std::max(error[std::size_t(level)], std::abs(found / exact - 1));
    }
    std::printf("cell %.2f s: worst relative error %.2e\n", kSide_m / (8 << level) / s_m,
                error[std::size_t(level)]);
  }
  EXPECT_NEAR(std::log2(error[1] / error[3]) / 2, 2, 0.3);
  EXPECT_LT(error[3], 0.01);
}

TEST(OpticalDepth, OfASphereIsItsChordToOneVoxel) {
  constexpr double radius_m = 350, k_per_m = 0.02;
  const FieldSource source(test::box(kSide_m), test::isotropic(3), [](glm::dvec3 p) {
    return glm::length(p - glm::dvec3{500.0}) <= radius_m ? k_per_m : 0.0;
  });
  const RenderVolume volume = test::volume_of(source);
  const FinestLevels finest({&volume, 1}, 16);
  test::Random random;
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 d = random.direction(),
                     side = glm::normalize(glm::cross(d, random.direction()));
    const double b_m = random.uniform(0, 250);
    const double chord_m = 2 * std::sqrt(radius_m * radius_m - b_m * b_m);
    EXPECT_NEAR(depth(finest, {glm::dvec3{500.0} + b_m * side - 3000.0 * d, d}), k_per_m * chord_m,
                k_per_m * 2 * std::sqrt(3.0) * kSide_m / 64);
  }
}

TEST(OpticalDepth, APeriodicSlabRepeatsAlongSlantedRays) {
  const FieldSource wavy(test::box(kSide_m, {true, true}), test::isotropic(2), [](glm::dvec3 p) {
    return 0.01 * (1.1 + std::sin(2 * std::numbers::pi * p.x / kSide_m));
  });
  const RenderVolume volume = test::volume_of(wavy);
  const FinestLevels finest({&volume, 1}, 16);
  for (const double mu : {1.0, 0.5, 0.1, 0.03})
    for (const double azimuth : {0.3, 2.0, -1.0}) {
      const double sine = std::sqrt(1 - mu * mu);
      const glm::dvec3 d{sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
      const Ray ray{{-4321, 987, -700}, d};
      const double brute = brute_force(finest, ray, 1700 / mu, 200000);
      EXPECT_NEAR(depth(finest, ray), brute, 1e-4 * brute);
    }
  // A level ray never leaves: endless where there is anything, and the walk ends all the same.
  EXPECT_TRUE(std::isinf(depth(finest, {{0, 0, 500}, {1, 0, 0}})));
  EXPECT_EQ(depth(finest, {{0, 0, kSide_m + 1}, {1, 0, 0}}), 0);
}

TEST(OpticalDepth, FromFarAwayIsTheSame) {
  const FixedLevel levels({&cloud_source()}, 3);
  RenderRequest request = test::request_of({test::volume_of(cloud_source())});
  const RayMarch march(levels, request);
  test::Random random;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 d = random.direction();
    const glm::dvec3 target{500 + random.uniform(-300, 300), 500, 500};
    const double near = march.trace({target - 2000.0 * d, d}).optical_depth;
    const double far = march.trace({target - 1e9 * d, d}).optical_depth;
    EXPECT_NEAR(far, near, 1e-6 * near + 1e-6);
  }
}

}  // namespace
}  // namespace nepho
