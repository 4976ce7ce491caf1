#include <numbers>

#include "truth_support.h"
#include "truth_table.h"

// Where an even sphere in a beam sends its light, against histories of another program.

namespace nepho::test {
namespace {

constexpr std::size_t kBins = 40;

struct Curve {
  std::array<Estimate, kBins> ours, truth;  // part of the beam's power, by cosine
  std::vector<Compared> sums;
};

Curve run(double depth, double histories, double co_albedo = 0) {
  const TruthTable table(NEPHO_TRUTH_DIR "/sphere_phase_curve.csv");
  const double bin_sr = 2 * std::numbers::pi * 2 / kBins;
  Curve curve;
  std::size_t first = 0;
  while (table.at(first, "tau") != depth) ++first;
  for (std::size_t b = 0; b < kBins; ++b)
    curve.truth[b] = {bin_sr * table.at(first + b, "per_sr"),
                      bin_sr * table.at(first + b, "per_sr_se")};
  Medium medium;
  add_ball(medium, depth, hg(0.85), co_albedo);
  const PathTracer& tracer = medium.tracer();
  // Bins; then the two halves, and what goes straight through.
  constexpr std::size_t kBack = kBins, kForth = kBins + 1, kStraight = kBins + 2;
  const auto count = std::size_t(histories * sample_factor());
  const auto means = measure<kBins + 3>(1, count, [&](Random& random) {
    const double r = kBallRadius_m * std::sqrt(random.uniform());
    const double azimuth = 2 * std::numbers::pi * random.uniform();
    const Ray in{{r * std::cos(azimuth), r * std::sin(azimuth), -2 * kBallRadius_m}, {0, 0, 1}};
    const Escape escape = walk(tracer, in, random);
    std::array<double, kBins + 3> hits{};
    if (escape.absorbed) return hits;
    if (escape.scatterings == 0) {
      hits[kStraight] = 1;
      return hits;
    }
    const double mu = escape.ray.direction.z;
    hits[std::min(std::size_t((mu + 1) / 2 * kBins), kBins - 1)] = 1;
    hits[mu < 0 ? kBack : kForth] = 1;
    return hits;
  });
  for (std::size_t b = 0; b < kBins; ++b) curve.ours[b] = mean_of(means[b]);
  Estimate halves[2];
  for (std::size_t b = 0; b < kBins; ++b) {
    Estimate& half = halves[b < kBins / 2 ? 0 : 1];
    half.value += curve.truth[b].value;
    half.standard_error = std::hypot(half.standard_error, curve.truth[b].standard_error);
  }
  curve.sums = {{"back", mean_of(means[kBack]), halves[0]},
                {"forth", mean_of(means[kForth]), halves[1]}};
  if (depth < 5) {
    const double straight = 2 * (1 - (1 + depth) * std::exp(-depth)) / (depth * depth);
    curve.sums.push_back({"straight", mean_of(means[kStraight]), {straight}});
  }
  return curve;
}

struct Sphere {
  double depth, histories;
};
void PrintTo(const Sphere& sphere, std::ostream* out) {
  *out << sphere.depth;
}
class Spheres : public testing::TestWithParam<Sphere> {};
TEST_P(Spheres, ScatterAsInTheTable) {
  const Curve curve = run(GetParam().depth, GetParam().histories);
  EXPECT_GT(z_per_pixel(curve.ours, curve.truth).p, kAccept);
  expect_agreement("sphere of tau " + std::to_string(int(GetParam().depth)), curve.sums);
}
INSTANTIATE_TEST_SUITE_P(Truth, Spheres,
                         testing::Values(Sphere{2, 1.5e6}, Sphere{10, 3e5}, Sphere{50, 1e5}),
                         [](const auto& with) {
                           return "tau" + std::to_string(int(with.param.depth));
                         });

TEST(SphereBias, OfAlbedoIsCaught) {
  expect_caught("sphere of tau 10", run(10, 3e5, kBias).sums);
}

}  // namespace
}  // namespace nepho::test
