#include "analytic_field.h"
#include "truth_support.h"

// White furnaces: where nothing absorbs and light comes from all sides alike, nothing can be seen.

namespace nepho::test {
namespace {

struct Furnace {
  std::string name;
  double asymmetry;
  int volumes;
  bool shell, periodic;
};
void PrintTo(const Furnace& furnace, std::ostream* out) {
  *out << furnace.name;
}

void add_cloud(Medium& medium, const Furnace& furnace, const Phase& phase) {
  std::shared_ptr<const Chart> chart = std::make_shared<BoxChart>(
      glm::dvec3{-500}, glm::dmat3(1000.0), Periodic{furnace.periodic, furnace.periodic});
  if (furnace.shell) chart = std::make_shared<ShellChart>(Ellipsoid::sphere(500), -400.0, 0.0);
  for (int v = 0; v < furnace.volumes; ++v)
    medium.add(
        chart, isotropic(2),
        [&](const glm::dvec3& p) { return 3 * cloud(p / 200.0 + double(v)) + 3e-4; }, phase);
  medium.request.sky.zenith_W_per_m2_sr_nm = medium.request.sky.horizon_W_per_m2_sr_nm =
      medium.request.sky.below_W_per_m2_sr_nm = glm::dvec3{1.0};
}

// Rays from all sides through the middle kilometre.
Ray inward(Random& random) {
  const glm::dvec3 out = turned({0, 0, 1}, sample_hg(0, random.uniform()), random);
  return {2000.0 * out, turned(-out, sample_hg(0.97, random.uniform()), random)};
}

// Henyey-Greenstein is sampled by its own density: each single path must bring 1, to rounding.
class Furnaces : public testing::TestWithParam<Furnace> {};
TEST_P(Furnaces, AreWhiteOnEachPath) {
  Medium medium;
  add_cloud(medium, GetParam(), hg(GetParam().asymmetry));
  const PathTracer& tracer = medium.tracer();
  const auto means = measure<2>(1, 20000, [&](Random& random) {
    const PathSample path = tracer.sample(inward(random), random);
    double off = 0;
    for (int c = 0; c < 3; ++c) off = std::max(off, std::abs(path.radiance_W_per_m2_sr_nm[c] - 1));
    return std::array{off < 1e-12 ? 0.0 : 1.0, double(path.scatterings)};
  });
  EXPECT_EQ(means[0].mean(), 0);
  EXPECT_GT(means[1].mean(), 1);  // there is a cloud
  EXPECT_EQ(tracer.medium().violations(), 0u);
}
const std::vector<Furnace> kFurnaces{{"box", 0.85, 1, false, false},
                                     {"two_in_a_box", -0.5, 2, false, false},
                                     {"peaked_without_end", 0.9999, 1, false, true},
                                     {"shell", 0, 1, true, false}};
INSTANTIATE_TEST_SUITE_P(Truth, Furnaces, testing::ValuesIn(kFurnaces),
                         [](const auto& with) { return with.param.name; });

// Droplets turn red, green and blue by other angles: white on average.
std::vector<Compared> droplets(double radius_um, double co_albedo = 0) {
  Medium medium;
  add_cloud(medium, kFurnaces[0], {.effective_radius_m = radius_um * 1e-6});
  medium.request.volumes.front().co_albedo = glm::dvec3{co_albedo};
  const PathTracer& tracer = medium.tracer();
  const auto ours = measure_to<3>(1, [&](Random& random) {
    const glm::dvec3 c = tracer.sample(inward(random), random).radiance_W_per_m2_sr_nm;
    return std::array{c.r, c.g, c.b};
  });
  return {{"red", ours[0], {1}}, {"green", ours[1], {1}}, {"blue", ours[2], {1}}};
}
class DropletFurnaces : public testing::TestWithParam<int> {};
TEST_P(DropletFurnaces, AreWhiteOnAverage) {
  expect_agreement("furnace of " + std::to_string(GetParam()) + " um", droplets(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Truth, DropletFurnaces, testing::Values(4, 10, 30),
                         testing::PrintToStringParamName());

TEST(FurnaceBias, OfAlbedoIsCaught) {
  expect_caught("furnace of 10 um", droplets(10, kBias));
}

}  // namespace
}  // namespace nepho::test
