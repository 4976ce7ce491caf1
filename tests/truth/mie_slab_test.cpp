#include "slab_view.h"
#include "truth_table.h"

// Slabs of droplets (10 um, 550 nm, overhead sun) against adding-doubling with 900 moments of their
// phase function. The renderer's table has an asymmetry within 5e-4 of those, and a curve of 0.5 %:
// that is truth's standard error here.

namespace nepho::test {
namespace {

constexpr double kOfFlux = 1.5e-3, kOfRadiance = 2.5e-3;

double truth(double depth, const char* column) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_mie.csv");
  std::size_t row = 0;
  while (table.at(row, "tau") != depth) ++row;
  return table.at(row, column);
}

std::vector<Compared> fluxes(double depth, double planted = 1) {
  Medium medium;
  add_slab(medium, Profile::kTent, planted * depth, Phase{}, 0);
  const PathTracer& tracer = medium.tracer();
  const Ray down{{50, 50, kSlab_m + 1}, {0, 0, -1}};
  const auto history = [&](Random& random) {
    const bool up = walk(tracer, down, random).ray.direction.z > 0;
    return std::array{double(up), double(!up)};
  };
  const auto ours = measure_to<2>(1, history);
  std::vector<Compared> all;
  for (const auto& [name, estimate] : {std::pair{"R", ours[0]}, std::pair{"T_total", ours[1]}}) {
    const double exact = truth(depth, name);
    all.push_back({name, estimate, {exact, kOfFlux * exact}});
  }
  return all;
}

class MieSlabs : public testing::TestWithParam<int> {};
TEST_P(MieSlabs, PassOnTheFluxOfTheTable) {
  expect_agreement("Mie slab, tau " + std::to_string(GetParam()), fluxes(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Truth, MieSlabs, testing::Values(4, 8, 16),
                         testing::PrintToStringParamName());

TEST(MieSlabBias, OfExtinctionIsCaught) {
  expect_caught("Mie slab, tau 4", fluxes(4, 1 + kBias));
}

// From the eye, with three wavelengths on one path. The sun is wide: of a beam's light most comes
// by few paths, those in the peak of the phase function; a disc of this radius is met by the phase
// function as well, and changes this radiance by less than kOfRadiance.
class MieRadiances : public testing::TestWithParam<int> {};
TEST_P(MieRadiances, AreThoseOfTheTable) {
  constexpr double disc_rad = 0.1;
  Medium medium;
  add_slab(medium, Profile::kEven, GetParam(), Phase{}, 0);
  add_sun(medium, {0, 0, 1}, disc_rad);
  SlabRow view;
  view.mu_sun = 1, view.mu = 0.5;
  const double exact = truth(GetParam(), "I_up_mu0.5");
  expect_agreement("Mie slab, tau " + std::to_string(GetParam()),
                   {{"I_up",
                     slab_radiance(medium.tracer(), view, Seen::kFromAbove),
                     {exact, kOfRadiance * exact}}});
}
INSTANTIATE_TEST_SUITE_P(Truth, MieRadiances, testing::Values(8),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace nepho::test
