#include <numbers>

#include "slab_view.h"
#include "truth_table.h"

// Slabs too thick to see through, that scatter evenly: Chandrasekhar (1950), Radiative Transfer,
// III. I = w / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0), and the plane albedo 1 - sqrt(1 - w) H(mu0).

namespace nepho::test {
namespace {

struct HalfSpace {
  std::string name, column;
  double ssa, depth, mu_sun, mu;
};
void PrintTo(const HalfSpace& space, std::ostream* out) {
  *out << space.name;
}

const std::vector<HalfSpace> kSpaces{{"ssa_5", "H_w0.5", 0.5, 30, 0.5, 1},
                                     {"ssa_9", "H_w0.9", 0.9, 60, 1, 0.3},
                                     {"ssa_99", "H_w0.99", 0.99, 120, 0.2, 0.7},
                                     {"ssa_999", "H_w0.999", 0.999, 200, 0.8, 0.5}};

double h_function(const std::string& column, double mu) {
  const TruthTable table(NEPHO_TRUTH_DIR "/chandrasekhar_h.csv");
  std::size_t row = 0;
  while (std::abs(table.at(row, "mu") - mu) > 1e-9) ++row;
  return table.at(row, column);
}

std::vector<Compared> run(const HalfSpace& space, double co_albedo_more = 0) {
  Medium medium;
  add_slab(medium, Profile::kEven, space.depth, hg(0), 1 - space.ssa + co_albedo_more);
  SlabRow view;
  view.mu_sun = space.mu_sun, view.mu = space.mu, view.azimuth_deg = 135;
  add_sun(medium, view.to_sun());
  const PathTracer& tracer = medium.tracer();
  const double h_sun = h_function(space.column, space.mu_sun);
  const double exact = space.ssa / (4 * std::numbers::pi) * space.mu_sun /
                       (space.mu + space.mu_sun) * h_function(space.column, space.mu) * h_sun;
  const Ray down{{50, 50, kSlab_m + 1}, -view.to_sun()};
  const auto ours = measure_to<1>(
      1, [&](Random& random) { return std::array{double(!walk(tracer, down, random).absorbed)}; });
  return {{"radiance", slab_radiance(tracer, view, Seen::kFromAbove), {exact}},
          {"plane albedo", ours[0], {1 - std::sqrt(1 - space.ssa) * h_sun}}};
}

class HalfSpaces : public testing::TestWithParam<HalfSpace> {};
TEST_P(HalfSpaces, FollowChandrasekhar) {
  expect_agreement("half-space " + GetParam().name, run(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Truth, HalfSpaces, testing::ValuesIn(kSpaces),
                         [](const auto& with) { return with.param.name; });

TEST(HalfSpaceBias, OfAlbedoIsCaught) {
  expect_caught("half-space ssa_9", run(kSpaces[1], kBias));
}

// Without absorption a slab lets sqrt(3) H(mu0) / (3 tau + 6 q) through, and reflects the rest;
// 1e-5 off at this depth. q is Hopf's.
TEST(HalfSpaces, WithoutAbsorptionKeepWhatGoesThrough) {
  constexpr double hopf = 0.7104460895, depth = 10, mu_sun = 0.6;
  Medium medium;
  add_slab(medium, Profile::kEven, depth, hg(0), 0);
  const PathTracer& tracer = medium.tracer();
  const double through = std::sqrt(3) * h_function("H_w1", mu_sun) / (3 * depth + 6 * hopf);
  const Ray down{{50, 50, kSlab_m + 1}, {0.8, 0, -mu_sun}};
  const auto ours = measure_to<2>(1, [&](Random& random) {
    const bool up = walk(tracer, down, random).ray.direction.z > 0;
    return std::array{double(up), double(!up)};
  });
  expect_agreement("half-space, slab of tau 10",
                   {{"R", ours[0], {1 - through}}, {"T", ours[1], {through}}});
}

}  // namespace
}  // namespace nepho::test
