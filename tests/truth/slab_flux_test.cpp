#include "truth_support.h"
#include "truth_table.h"

// Plane albedo and transmission of slabs, by histories that begin at the sun, against
// adding-doubling.

namespace nepho::test {
namespace {

struct SlabFlux {
  std::string name;
  double g, ssa, depth, mu_sun;
  Profile profile;
  bool reflection, transmission;  // which of the two is measured
};
void PrintTo(const SlabFlux& slab, std::ostream* out) {
  *out << slab.name;
}

constexpr Profile kEven = Profile::kEven, kTent = Profile::kTent;
const std::vector<SlabFlux> kSlabs{
    {"g0_tau1", 0, 1, 1, 0.5, kEven, true, true},
    {"g0_tau8_absorbing", 0, 0.9, 8, 1, kTent, true, false},
    {"g75_tau01", 0.75, 1, 0.1, 0.2, kTent, true, true},
    {"g75_tau8", 0.75, 1, 8, 0.5, kTent, true, true},
    {"g75_tau32_dim", 0.75, 0.999, 32, 1, kEven, true, false},
    {"g75_tau2_absorbing", 0.75, 0.9, 2, 0.2, kTent, true, true},
    {"g85_tau01", 0.85, 1, 0.1, 0.2, kEven, true, true},
    {"g85_tau1", 0.85, 1, 1, 1, kEven, true, true},
    {"g85_tau4", 0.85, 1, 4, 0.5, kTent, true, true},
    {"g85_tau8", 0.85, 1, 8, 1, kEven, true, true},
    {"g85_tau16", 0.85, 1, 16, 0.2, kTent, true, true},
    {"g85_tau32", 0.85, 1, 32, 1, kEven, true, true},
    {"g85_tau128", 0.85, 1, 128, 0.5, kEven, true, false},
    {"g85_tau128_dim", 0.85, 0.999, 128, 1, kTent, true, false},
    {"g85_tau8_absorbing", 0.85, 0.9, 8, 0.5, kEven, true, true},
    {"g85_tau128_absorbing", 0.85, 0.9, 128, 0.2, kTent, true, false},
    {"backward_tau16", -0.5, 0.9999, 16, 1, kTent, true, false},
    {"backward_tau1", -0.5, 0.5, 1, 0.5, kEven, true, true},
    {"g95_tau16", 0.95, 1, 16, 1, kTent, true, true},
};

std::vector<Compared> run(const SlabFlux& slab, double planted = 1) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_flux.csv");
  std::size_t row = 0;
  while (table.at(row, "g") != slab.g || table.at(row, "ssa") != slab.ssa ||
         table.at(row, "tau") != slab.depth || table.at(row, "mu0") != slab.mu_sun)
    ++row;
  Medium medium;
  add_slab(medium, slab.profile, planted * slab.depth, hg(slab.g), 1 - slab.ssa);
  const PathTracer& tracer = medium.tracer();
  const Ray down{{50, 50, kSlab_m + 1},
                 {std::sqrt((1 - slab.mu_sun) * (1 + slab.mu_sun)), 0, -slab.mu_sun}};
  const auto history = [&](Random& random) {
    const Escape escape = walk(tracer, down, random);
    const bool up = escape.ray.direction.z > 0;
    return std::array{double(!escape.absorbed && up), double(!escape.absorbed && !up)};
  };
  // A part p of n histories has the relative variance (1 - p) / (n p).
  const Estimate exact[2] = {{table.at(row, "R")}, {table.at(row, "T_total")}};
  double count = 8192;
  for (int i = 0; i < 2; ++i)
    if (i == 0 ? slab.reflection : slab.transmission)
      count = std::max(count, (1 / exact[i].value - 1) / std::pow(kPrecision, 2));
  const auto means = measure<2>(1, std::size_t(count * sample_factor()), history);
  std::vector<Compared> all;
  if (slab.reflection) all.push_back({"R", mean_of(means[0]), exact[0]});
  if (slab.transmission) all.push_back({"T", mean_of(means[1]), exact[1]});
  EXPECT_EQ(tracer.medium().violations(), 0u);
  return all;
}

class SlabFluxes : public testing::TestWithParam<SlabFlux> {};
TEST_P(SlabFluxes, AreThoseOfTheTable) {
  expect_agreement("slab flux " + GetParam().name, run(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Truth, SlabFluxes, testing::ValuesIn(kSlabs),
                         [](const auto& with) { return with.param.name; });

TEST(SlabFluxBias, OfExtinctionIsCaught) {
  const SlabFlux thin{"g85_tau1", 0.85, 1, 1, 1, kTent, true, false};
  expect_caught("slab flux g85_tau1", run(thin, 1 + kBias));
}

}  // namespace
}  // namespace nepho::test
