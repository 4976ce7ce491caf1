#include <numbers>

#include "truth_support.h"

// Directions to the sun and from the ground follow the density that they tell.

namespace nepho::test {
namespace {

using std::numbers::pi;

TEST(SunDisc, IsSampledEvenly) {
  constexpr std::size_t bins = 50, count = 200000;
  for (const double radius_rad : {1e-4, 0.004675, 0.3}) {
    RenderRequest request;
    request.sun.to_sun = glm::normalize(glm::dvec3{0.3, -0.5, 0.8});
    const Surroundings around(request, radius_rad);
    // Solid angle of the disc, without cancellation.
    const double most = 2 * std::pow(std::sin(radius_rad / 2), 2);
    std::array<double, bins> counts{}, expected;
    expected.fill(double(count) / bins);
    for (std::size_t i = 0; i < count; ++i) {
      Random random(case_seed(), i, 0);
      const glm::dvec3 way = around.to_sun(random);
      const double down = one_minus_cos(way, request.sun.to_sun);
      EXPECT_LT(down, most * (1 + 1e-9));
      ++counts[std::min(std::size_t(down / most * bins), bins - 1)];
      if (down < most * (1 - 1e-9)) {
        EXPECT_NEAR(around.sun_density(way) * 2 * pi * most, 1, 1e-9);
      }
    }
    EXPECT_GT(chi_square(counts, expected).p, kAccept);
    EXPECT_EQ(around.sun_density(-request.sun.to_sun), 0);
    // All of its light: radiance times solid angle is the irradiance.
    EXPECT_NEAR(around.disc_W_per_m2_sr_nm(request.sun.to_sun).g * 2 * pi * most, 1, 1e-9);
  }
}

// A sea's and a land's directions: bins even in the cosine from straight up and in azimuth, their
// expectation from density(). Those below the horizon, which bring nothing, are one bin: waves seen
// from behind mirror the eye down there, and density() leaves them out.
struct Water {
  std::string name;
  double water, wind_m_per_s, mu;
};
void PrintTo(const Water& water, std::ostream* out) {
  *out << water.name;
}

class Grounds : public testing::TestWithParam<Water> {};
TEST_P(Grounds, AreSampledByTheirDensity) {
  constexpr int rings = 40, sectors = 24, fine = 24;
  RenderRequest request;
  request.planet.emplace();
  request.planet->body = Ellipsoid::sphere(6.4e6);
  request.planet->air.reset();
  request.planet->ground.wind_m_per_s = GetParam().wind_m_per_s;
  const Surroundings around(request, 0.004675);
  Surroundings::Spot spot = around.spot({0, 0, 6.4e6});
  spot.water = GetParam().water;
  const double mu = GetParam().mu;
  const glm::dvec3 to_eye{std::sqrt((1 - mu) * (1 + mu)), 0, mu};
  const auto direction = [](double z, double azimuth) {
    const double s = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
    return glm::dvec3{s * std::cos(azimuth), s * std::sin(azimuth), z};
  };
  std::vector<double> expected(rings * sectors), counts(rings * sectors);
  double integral = 0;
  for (int r = 0; r < rings * fine; ++r)
    for (int a = 0; a < sectors * fine; ++a) {
      const glm::dvec3 way = direction(-1 + 2 * (r + 0.5) / (rings * fine),
                                       -pi + 2 * pi * (a + 0.5) / (sectors * fine));
      const double part =
          around.density(spot, to_eye, way) * 4 * pi / (double(rings * fine) * (sectors * fine));
      expected[std::size_t(r / fine * sectors + a / fine)] += part;
      integral += part;
    }
  EXPECT_NEAR(integral, 1, 2e-3);
  const auto count = std::size_t(200000 * sample_factor());
  double above = 0;
  for (int r = 0; r < rings / 2; ++r)
    for (int a = 0; a < sectors; ++a) expected[std::size_t(r * sectors + a)] = 0;
  for (const double e : expected) above += e;
  expected.front() = std::max(0.0, 1 - above);
  const double all = above + expected.front();
  for (double& e : expected) e *= double(count) / all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(case_seed(), i, 0);
    const Surroundings::Way way = around.sample(spot, to_eye, random);
    EXPECT_NEAR(way.density, around.density(spot, to_eye, way.direction), 1e-12 * way.density);
    if (way.direction.z < 0) {
      ++counts.front();
      continue;
    }
    const int ring = std::min(int((way.direction.z + 1) / 2 * rings), rings - 1);
    const double turn = (std::atan2(way.direction.y, way.direction.x) + pi) / (2 * pi);
    ++counts[std::size_t(ring * sectors + std::min(int(turn * sectors), sectors - 1))];
  }
  const ChiSquare fit = chi_square(counts, expected);
  std::printf("truth: | chi-square of the ground | integral %.6f | p %.4f |\n", integral, fit.p);
  EXPECT_GT(fit.p, kAccept);
}
INSTANTIATE_TEST_SUITE_P(Truth, Grounds,
                         testing::Values(Water{"land", 0, 6, 0.3}, Water{"sea_from_above", 1, 6, 1},
                                         Water{"sea", 1, 6, 0.6}, Water{"rough_sea", 1, 20, 0.8},
                                         Water{"coast", 0.5, 10, 0.5}),
                         [](const auto& with) { return with.param.name; });

}  // namespace
}  // namespace nepho::test
