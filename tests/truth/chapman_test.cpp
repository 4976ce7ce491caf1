#include <numbers>

#include "truth_support.h"
#include "truth_table.h"

// Rays through an exponential atmosphere, against Chapman's function: by the transmittance that is
// estimated, and by the part of rays that do not collide.

namespace nepho::test {
namespace {

constexpr double kRadius_m = 6371000;  // of the table

struct Slant {
  double scale_m, height_m, zenith_deg;
};
void PrintTo(const Slant& slant, std::ostream* out) {
  *out << slant.scale_m << " " << slant.height_m << " " << slant.zenith_deg;
}

std::vector<Compared> run(const Slant& slant, double planted = 1) {
  const TruthTable table(NEPHO_TRUTH_DIR "/chapman.csv");
  std::size_t row = 0;
  while (table.at(row, "H_m") != slant.scale_m || table.at(row, "h_m") != slant.height_m ||
         table.at(row, "zenith_deg") != slant.zenith_deg)
    ++row;
  // Of optical depth 1 along the ray. Trilinear cells of H / 25 add (1 / 25)^2 / 12 = 1.3e-4 to it,
  // and 10 scale heights leave 5e-5 out.
  const double per_m =
      std::exp(slant.height_m / slant.scale_m) / (slant.scale_m * table.at(row, "Chapman"));
  Medium medium;
  medium.add(
      std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0.0, 10 * slant.scale_m),
      Lattice(std::vector<SplitMask>(5, kSplitZ)),
      [&](const glm::dvec3& p) {
        return planted * per_m * std::exp((kRadius_m - glm::length(p)) / slant.scale_m);
      },
      hg(0));
  const PathMedium& air = medium.tracer().medium();
  const glm::dvec3 up = glm::normalize(glm::dvec3{1, 0.97, -0.2});  // near an edge of the cube
  const glm::dvec3 level = glm::normalize(glm::cross(up, glm::dvec3{0.3, 0.1, 1}));
  const double zenith_rad = slant.zenith_deg * std::numbers::pi / 180;
  const Ray ray{(kRadius_m + slant.height_m) * up,
                std::cos(zenith_rad) * up + std::sin(zenith_rad) * level};
  // The depth's precision is that of the transmittance, at depth 1.
  const auto [passed, free] = measure_to<2>(1, [&](Random& random) {
    const double transmittance = air.transmittance(ray, kNoDistance_m, random);
    return std::array{transmittance, double(air.collide(ray, kNoDistance_m, random).volume < 0)};
  });
  const auto depth = [](const Estimate& part) {
    return Estimate{-std::log(part.value), part.standard_error / part.value};
  };
  EXPECT_EQ(air.violations(), 0u);
  const Estimate exact{1, 2e-4};
  return {{"depth by ratio tracking", depth(passed), exact},
          {"depth by collisions", depth(free), exact}};
}

class Slants : public testing::TestWithParam<Slant> {};
TEST_P(Slants, HaveChapmansDepth) {
  const Slant& slant = GetParam();
  expect_agreement("Chapman, H " + std::to_string(int(slant.scale_m)) + " m, from " +
                       std::to_string(int(slant.height_m)) + " m at " +
                       std::to_string(int(slant.zenith_deg)) + " degrees",
                   run(slant));
}
INSTANTIATE_TEST_SUITE_P(Truth, Slants,
                         testing::Values(Slant{8000, 0, 0}, Slant{8000, 0, 90},
                                         Slant{8000, 10000, 92}, Slant{1200, 2000, 85},
                                         Slant{1200, 0, 90}),
                         [](const auto& with) {
                           return "h" + std::to_string(int(with.param.height_m)) + "_H" +
                                  std::to_string(int(with.param.scale_m)) + "_at" +
                                  std::to_string(int(with.param.zenith_deg));
                         });

TEST(ChapmanBias, OfExtinctionIsCaught) {
  expect_caught("Chapman", run({8000, 0, 90}, 1 + kBias));
}

}  // namespace
}  // namespace nepho::test
