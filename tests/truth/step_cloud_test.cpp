#include <numbers>

#include "truth_support.h"
#include "truth_table.h"

// The step cloud of I3RC phase 1 (Cahalan et al. 2005, doi:10.1175/BAMS-86-9-1275): 500 m without
// end, optical depth 2 on the left and 18 on the right, 250 m thick, g = 0.85. 32 columns against
// histories of another program; the sun's photons go towards +x.

namespace nepho::test {
namespace {

constexpr std::size_t kColumns = 32;
constexpr double kWidth_m = 500, kHeight_m = 250;
// Steps are ramps of two voxels of 0.24 m about them; a mean free path is 14 m or more.
constexpr int kSplitsX = 8;

struct Sky32 {
  std::string name;
  double sun_zenith_deg, ssa;
};
void PrintTo(const Sky32& sky, std::ostream* out) {
  *out << sky.name;
}
const std::vector<Sky32> kSkies{{"overhead", 0, 1},
                                {"overhead_absorbing", 0, 0.99},
                                {"slanted", 60, 1},
                                {"slanted_absorbing", 60, 0.99}};

using Columns = std::array<Estimate, kColumns>;

Columns truth(const Sky32& sky, const std::string& what) {
  const TruthTable table(NEPHO_TRUTH_DIR "/step_cloud.csv");
  std::size_t first = 0;
  while (table.at(first, "sza_deg") != sky.sun_zenith_deg || table.at(first, "ssa") != sky.ssa)
    ++first;
  Columns columns;
  for (std::size_t c = 0; c < kColumns; ++c)
    columns[c] = {table.at(first + c, what), table.at(first + c, what + "_se")};
  return columns;
}
Estimate mean_of(const Columns& columns) {
  Estimate mean;
  for (const Estimate& column : columns) {
    mean.value += column.value / kColumns;
    mean.standard_error = std::hypot(mean.standard_error, column.standard_error / kColumns);
  }
  return mean;
}

std::array<Estimate, kColumns / 4> by_fours(const Columns& columns) {
  std::array<Estimate, kColumns / 4> fours{};
  for (std::size_t c = 0; c < kColumns; ++c) {
    Estimate& four = fours[c / 4];
    four.value += columns[c].value / 4;
    four.standard_error = std::hypot(four.standard_error, columns[c].standard_error / 4);
  }
  return fours;
}

double step_per_m(const glm::dvec3& p) {
  const double left = 2 / kHeight_m, right = 18 / kHeight_m;
  const double at = p.x / kWidth_m;
  if (at == 0 || at == 0.5 || at == 1) return 0.5 * (left + right);
  return at < 0.5 ? left : right;
}

glm::dvec3 to_sun(const Sky32& sky) {
  const double zenith_rad = sky.sun_zenith_deg * 0.017453292519943295;
  return {-std::sin(zenith_rad), 0, std::cos(zenith_rad)};
}

void add_step(Medium& medium, const Sky32& sky, double co_albedo_more) {
  glm::dmat3 edges_m(kWidth_m);
  edges_m[2] = {0, 0, kHeight_m};
  medium.add(std::make_shared<BoxChart>(glm::dvec3{0.0}, edges_m, Periodic{true, true}),
             Lattice(std::vector<SplitMask>(kSplitsX, SplitMask{0b001})), step_per_m, hg(0.85),
             1 - sky.ssa + co_albedo_more);
  medium.request.sun = {.to_sun = to_sun(sky), .irradiance_W_per_m2_nm = glm::dvec3{1.0}};
}

std::size_t column_of(double x_m) {
  const double period = x_m / kWidth_m - std::floor(x_m / kWidth_m);
  return std::min(std::size_t(period * kColumns), kColumns - 1);
}

struct Answer {
  Columns columns;
  Estimate mean;
};
Answer answer_of(const MeanVariance* columns, const MeanVariance& mean) {
  Answer answer;
  for (std::size_t c = 0; c < kColumns; ++c) answer.columns[c] = test::mean_of(columns[c]);
  answer.mean = test::mean_of(mean);
  return answer;
}

// Reflected and transmitted, by the column where they leave.
std::array<Answer, 2> fluxes(const Sky32& sky, double co_albedo_more = 0) {
  Medium medium;
  add_step(medium, sky, co_albedo_more);
  const PathTracer& tracer = medium.tracer();
  const auto count = std::size_t(200000 * sample_factor());
  const auto means = measure<2 * kColumns + 2>(1, count, [&](Random& random) {
    const Ray in{{kWidth_m * random.uniform(), 0, kHeight_m}, -to_sun(sky)};
    const Escape escape = walk(tracer, in, random);
    std::array<double, 2 * kColumns + 2> hits{};
    if (escape.absorbed) return hits;
    const glm::dvec3 &p = escape.ray.origin_m, &d = escape.ray.direction;
    const std::size_t down = d.z > 0 ? 0 : 1;
    const double t_m = ((down ? 0 : kHeight_m) - p.z) / d.z;
    hits[down * kColumns + column_of(p.x + t_m * d.x)] = kColumns;
    hits[2 * kColumns + down] = 1;
    return hits;
  });
  EXPECT_EQ(tracer.medium().violations(), 0u);
  return {answer_of(means.data(), means[2 * kColumns]),
          answer_of(means.data() + kColumns, means[2 * kColumns + 1])};
}

Answer nadir(const Sky32& sky) {
  Medium medium;
  add_step(medium, sky, 0);
  const PathTracer& tracer = medium.tracer();
  const auto count = std::size_t(560000 * sample_factor());
  const auto means = measure<kColumns + 1>(2, count, [&](Random& random) {
    const double x_m = kWidth_m * random.uniform();
    const Ray ray{{x_m, 0, kHeight_m + 1}, {0, 0, -1}};
    const double radiance = tracer.sample(ray, random).radiance_W_per_m2_sr_nm[1];
    std::array<double, kColumns + 1> seen{};
    seen[column_of(x_m)] = kColumns * radiance;
    seen[kColumns] = radiance;
    return seen;
  });
  return answer_of(means.data(), means[kColumns]);
}

class StepClouds : public testing::TestWithParam<Sky32> {};
TEST_P(StepClouds, PassOnTheFluxOfTheTable) {
  const auto [reflected, transmitted] = fluxes(GetParam());
  const Columns up = truth(GetParam(), "R"), down = truth(GetParam(), "T");
  EXPECT_GT(z_per_pixel(reflected.columns, up).p, kAccept);
  EXPECT_GT(z_per_pixel(transmitted.columns, down).p, kAccept);
  expect_agreement("step cloud " + GetParam().name,
                   {{"R", reflected.mean, mean_of(up)}, {"T", transmitted.mean, mean_of(down)}});
}
INSTANTIATE_TEST_SUITE_P(Truth, StepClouds, testing::ValuesIn(kSkies),
                         [](const auto& with) { return with.param.name; });

// Few paths from the eye bring most of the light, those that meet the sun's forward peak. So the 32
// columns are tested by fours, and 2 % is caught on the mean of the four skies rather than on each.
TEST(StepCloudNadir, RadiancesAreThoseOfTheTable) {
  Estimate mean;
  for (const Sky32& sky : kSkies) {
    const Answer ours = nadir(sky);
    const Columns exact = truth(sky, "nadir");
    EXPECT_GT(z_per_pixel(by_fours(ours.columns), by_fours(exact)).p, kAccept) << sky.name;
    const Estimate all = mean_of(exact);
    mean.value += ours.mean.value / all.value / double(kSkies.size());
    mean.standard_error = std::hypot(mean.standard_error,
                                     ours.mean.standard_error / all.value / double(kSkies.size()));
  }
  expect_agreement("step cloud", {{"nadir radiance, over truth's", mean, {1, 5e-4}}});
}

TEST(StepCloudBias, OfAlbedoIsCaught) {
  const auto [reflected, transmitted] = fluxes(kSkies[2], kBias);
  expect_caught("step cloud slanted", {{"R", reflected.mean, mean_of(truth(kSkies[2], "R"))}});
}

}  // namespace
}  // namespace nepho::test
