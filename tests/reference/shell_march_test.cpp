#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "march_support.h"
#include "physics/physics_cpp.h"
#include "random.h"
#include "reference/chart_rays.h"

namespace nepho {
namespace {

using std::numbers::pi;
using test::FieldSource;
using test::FixedLevel;

constexpr double kRadius_m = 6371000;  // of the table

std::vector<SplitMask> layers(int splits) {
  return std::vector<SplitMask>(std::size_t(splits), kSplitZ);
}

// Any direction from a point at a height over the middle of nowhere in particular.
Ray upward(double height_m, double zenith_rad, double azimuth_rad) {
  const glm::dvec3 up = glm::normalize(glm::dvec3{0.3, -0.8, 0.52});
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3{0, 0, 1}, up));
  const glm::dvec3 north = glm::cross(up, east);
  return {(kRadius_m + height_m) * up,
          std::cos(zenith_rad) * up + std::sin(zenith_rad) * (std::cos(azimuth_rad) * north +
                                                              std::sin(azimuth_rad) * east)};
}

// Steps as a ray's, small and large, forwards and back.
TEST(ShellMarch, NearAnglesAreThoseOfTheArcTangent) {
  for (const double step : {1e-7, 3e-4, 0.013, 0.4}) {
    NearAngle near;
    double worst = 0, x = -1.1;
    for (int n = 0; n < 20000 && x < 1.1; ++n, x += n % 3 == 0 ? -step / 2 : step) {
      if (n == 3000) x = 0.7;
      worst = std::max(worst, std::abs(near.of(x) - std::atan(x)));
    }
    EXPECT_LE(worst, 2.3e-16) << step;
  }
}

TEST(ShellMarch, ExponentialLayerIsChapmansFunction) {
  constexpr double scale_height_m = 1200, ground_per_m = 1e-3, top_m = 40000;
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0.0, top_m);
  const FieldSource source(chart, Lattice(layers(6)), [&](glm::dvec3 p) {
    return ground_per_m * std::exp(-(glm::length(p) - kRadius_m) / scale_height_m);
  });
  const FixedLevel levels({&source}, 6);
  const RayMarch march(levels, test::request_of({}));
  std::ifstream table(NEPHO_TRUTH_DIR "/chapman.csv");
  ASSERT_TRUE(table) << NEPHO_TRUTH_DIR;
  std::string line;
  double worst = 0;
  int rows = 0;
  while (std::getline(table, line)) {
    double scale_m, h_m, zenith_deg, chapman;
    char comma;
    std::istringstream row(line);
    if (!(row >> scale_m >> comma >> h_m >> comma >> zenith_deg >> comma >> chapman)) continue;
    if (scale_m != scale_height_m || h_m > 2000) continue;
    // Below the horizon the ray must miss the ground.
    if (zenith_deg > 90 && (kRadius_m + h_m) * std::sin(zenith_deg * pi / 180) < kRadius_m)
      continue;
    const double exact = ground_per_m * scale_height_m * std::exp(-h_m / scale_height_m) * chapman;
    for (const double azimuth : {0.0, 1.1, 4.0})
      worst = std::max(
          worst,
          std::abs(march.optical_depth(upward(h_m, zenith_deg * pi / 180, azimuth)) / exact - 1));
    ++rows;
  }
  EXPECT_GE(rows, 24);
  // Linear interpolation over cells of 78 m: (78 / 1200)^2 / 12 = 3.5e-4.
  test::report_accuracy("reference march", "exponential layer on the shell against Chapman", worst,
                        2e-3, "relative");
  EXPECT_LT(worst, 2e-3);
}

// All chords of a shell of constant extinction, through faces, edges and the gap below its bottom.
TEST(ShellMarch, ConstantShellIsTheLengthOfItsChords) {
  constexpr double bottom_m = 2000, top_m = 9000, k_per_m = 1e-4;
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), bottom_m, top_m);
  const FieldSource source(chart, Lattice({kSplitXyz, kSplitXy}),
                           [](glm::dvec3) { return k_per_m; });
  const FixedLevel levels({&source}, 2);
  const RayMarch march(levels, test::request_of({}));
  test::Random random;
  const auto chord_m = [](double radius_m, double miss_m) {
    return miss_m < radius_m ? 2 * std::sqrt((radius_m - miss_m) * (radius_m + miss_m)) : 0.0;
  };
  int gaps = 0, faces = 0;
  double worst = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 d = random.direction();
    const glm::dvec3 side = glm::normalize(glm::cross(d, random.direction()));
    const double miss_m = kRadius_m + random.uniform(100, 8900);
    const double exact =
        k_per_m * (chord_m(kRadius_m + top_m, miss_m) - chord_m(kRadius_m + bottom_m, miss_m));
    gaps += miss_m < kRadius_m + bottom_m;
    const Ray ray{miss_m * side - 1e7 * d, d};
    faces +=
        chart->locate(miss_m * side - 3e5 * d).root != chart->locate(miss_m * side + 3e5 * d).root;
    // A shell's cells of constant extinction decode to within half a step.
    worst = std::max(worst, std::abs(march.optical_depth(ray) / exact - 1));
  }
  EXPECT_GT(gaps, 20);
  EXPECT_GT(faces, 20);
  EXPECT_LT(worst, 2e-5);
}

TEST(ShellMarch, PiecesFollowTheirCellsAcrossFacesOfTheEllipsoid) {
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::wgs84(), -500.0, 12000.0);
  const FieldSource source(chart, Lattice({kSplitXy, kSplitXyz}), [](glm::dvec3) { return 1e-4; });
  const FixedLevel levels({&source}, 2);
  const Index3& n = source.info().lattice.cells(2);
  test::Random random;
  std::size_t most = 0;
  double worst_cells = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 to = geodetic_to_ecef_m(Ellipsoid::wgs84(), random.uniform(-pi / 2, pi / 2),
                                             random.uniform(-pi, pi), random.uniform(0, 11000));
    const glm::dvec3 up = glm::normalize(to), across = glm::cross(up, random.direction());
    glm::dvec3 d = glm::normalize(glm::normalize(across) + random.uniform(-0.05, 0.05) * up);
    if (i % 5 == 0) d = random.direction();
    const Ray ray{to - (i % 2 ? 4e5 : 0.0) * d, d};
    const auto frame = chart_ray(source.info(), ray);
    VolumeWalk walk(levels, 0, ray, kNoDistance_m, false);
    while (walk.next()) {
      const double middle_m = (walk.t0_m() + walk.t1_m()) / 2;
      const glm::dvec3 p = ray.origin_m + middle_m * ray.direction;
      const glm::dvec3 at = glm::dvec3(n[0], n[1], n[2]) * chart->coordinates(walk.root(), p);
      for (int a = 0; a < 3; ++a) {
        const auto axis = std::size_t(a);
        worst_cells = std::max({worst_cells, double(walk.block().low[axis]) - at[a],
                                at[a] - double(walk.block().high[axis])});
      }
    }
    most = std::max(most, walk.pieces());
  }
  std::printf("worst excursion %.1e cells, most pieces %zu\n", worst_cells, most);
  EXPECT_LT(worst_cells, 1e-6);
  EXPECT_LE(most, 4 * 3 * 32u);
}

// lattice.md 5: within 2e-4 of (mean of the cell's corners) * length. In wide, low cells of a field
// that varies by a factor of 3 from sample to sample.
TEST(ShellMarch, SubStepsKeepOpticalDepthWithinTheirBound) {
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0.0, 16000.0);
  const FieldSource source(chart, Lattice({kSplitXyz}), [](glm::dvec3 p) {
    return 1e-4 * (0.5 + test::value_noise(p / 911.0));
  });
  const FixedLevel levels({&source}, 1);
  test::Random random;
  double worst = 0;
  int most_steps = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 up = random.direction(),
                     d = glm::normalize(glm::cross(up, random.direction()));
    const glm::dvec3 lowest = (kRadius_m + random.uniform(10, 15900)) * up;
    VolumeWalk walk(levels, 0, {lowest - 1e6 * d, d}, kNoDistance_m, false);
    while (walk.next()) {
      const double length_m = walk.t1_m() - walk.t0_m();
      if (length_m < 1) continue;
      const auto simpson = [&](int steps) {
        double sum = 0;
        for (int s = 0; s < steps; ++s) {
          const double h = length_m / steps, t = walk.t0_m() + s * h;
          sum += h / 6 *
                 (walk.extinction_per_m(t) + 4 * walk.extinction_per_m(t + h / 2) +
                  walk.extinction_per_m(t + h));
        }
        return sum;
      };
      const int steps = walk.sub_steps(length_m);
      most_steps = std::max(most_steps, steps);
      // Corners are 0.5e-4 .. 1.5e-4: their mean is 1e-4, give or take what the bound has to spare.
      worst = std::max(worst, std::abs(simpson(steps) - simpson(64)) / (1e-4 * length_m));
    }
  }
  std::printf("up to %d sub-steps\n", most_steps);
  test::report_accuracy("reference march", "sub-steps of curved cells", worst, 2e-4,
                        "of mean extinction * length");
  EXPECT_LT(worst, 2e-4);
  EXPECT_GE(most_steps, 4);
}

TEST(ShellMarch, TheGroundStopsTheSunAndTheEye) {
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0.0, 8000.0);
  const FieldSource source(chart, Lattice(layers(1)), [](glm::dvec3) { return 1e-5; });
  const FixedLevel levels({&source}, 1);
  RenderRequest request = test::request_of({test::volume_of(source)});
  request.sky.below_W_per_m2_sr_nm = {1, 2, 3};
  request.sun.irradiance_W_per_m2_nm = glm::dvec3{0.0};
  const RayMarch march(levels, request);
  EXPECT_NEAR(march.optical_depth(upward(1000, pi, 0)), 1000 * 1e-5, 1e-8);
  EXPECT_GT(march.optical_depth(upward(0, pi / 2 - 1e-6, 0)), 0);
  const MarchResult down = march.trace(upward(1.7, pi, 0));
  EXPECT_NEAR(down.optical_depth, 1.7e-5, 1e-8);
  EXPECT_NEAR(down.radiance_W_per_m2_sr_nm.g, 2, 1e-3);
}

// At sea level half of the disc is up when its middle is on the horizon, all or nothing of it
// 0.004675 rad above or below; 10 km up the horizon lies 3.21 degrees lower.
TEST(ShellMarch, TheSunSetsBehindThePlanet) {
  const auto part = [](double height_m, double elevation_rad) {
    return f64::sun_above_horizon(kRadius_m, height_m, std::sin(elevation_rad));
  };
  EXPECT_NEAR(part(0, 0), 0.5, 1e-6);
  EXPECT_EQ(part(0, 0.0047), 1);
  EXPECT_EQ(part(0, -0.0047), 0);
  const double dip_rad = std::acos(kRadius_m / (kRadius_m + 10e3));
  EXPECT_NEAR(part(10e3, -dip_rad), 0.5, 1e-4);
  EXPECT_EQ(part(10e3, -dip_rad + 0.0048), 1);
  EXPECT_EQ(part(10e3, -dip_rad - 0.0048), 0);
}

}  // namespace
}  // namespace nepho
