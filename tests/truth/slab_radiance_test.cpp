#include "slab_view.h"
#include "truth_table.h"

// Radiance of slabs, by paths from the eye that end at the sun, against adding-doubling.

namespace nepho::test {
namespace {

struct Case {
  std::string name;
  double g, ssa, depth;
  SlabRow view;
  Profile profile;
  bool up = true, down = false;  // at the top, and at the base
  double sun_radius_rad = 0;
};
void PrintTo(const Case& slab, std::ostream* out) {
  *out << slab.name;
}

SlabRow angles(double mu_sun, double mu, double azimuth_deg) {
  SlabRow row;
  row.mu_sun = mu_sun, row.mu = mu, row.azimuth_deg = azimuth_deg;
  return row;
}

constexpr Profile kEven = Profile::kEven, kTent = Profile::kTent;
// A disc of this radius changes radiances of thick cloud by a thousandth or less.
constexpr double kDisc_rad = 0.03, kOfDisc = 1e-3;
const std::vector<Case> kCases{
    {"g0_tau1", 0, 1, 1, angles(0.5, 0.5, 90), kTent, true, true},
    {"g0_tau32", 0, 1, 32, angles(1, 0.5, 0), kEven},
    {"g0_tau8_absorbing", 0, 0.9, 8, angles(0.5, 1, 0), kTent},
    {"g75_tau1_forward", 0.75, 1, 1, angles(0.5, 0.2, 0), kEven, true, true},
    {"g75_tau8", 0.75, 1, 8, angles(1, 0.5, 0), kTent},
    {"g85_tau1_forward", 0.85, 1, 1, angles(0.5, 0.2, 0), kTent, true, true},
    {"g85_tau8", 0.85, 1, 8, angles(0.5, 0.2, 90), kEven},
    {"g85_tau8_absorbing", 0.85, 0.9, 8, angles(0.5, 0.2, 0), kTent, true, false},
    {"g85_tau32", 0.85, 1, 32, angles(1, 0.5, 0), kEven},
    {"g85_tau32_dim", 0.85, 0.999, 32, angles(0.5, 0.2, 0), kEven},
    {"of_a_disc_g75_tau8", 0.75, 1, 8, angles(1, 0.5, 0), kEven, true, false, kDisc_rad},
    {"of_a_disc_g0_tau32", 0, 1, 32, angles(1, 0.5, 0), kEven, true, false, kDisc_rad},
};

std::vector<Compared> run(const Case& slab, double co_albedo_more = 0) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_radiance.csv");
  const SlabRow& view = slab.view;
  std::size_t row = 0;
  while (table.at(row, "g") != slab.g || table.at(row, "ssa") != slab.ssa ||
         table.at(row, "tau") != slab.depth || table.at(row, "mu0") != view.mu_sun ||
         table.at(row, "mu") != view.mu || table.at(row, "dphi_deg") != view.azimuth_deg)
    ++row;
  Medium medium;
  add_slab(medium, slab.profile, slab.depth, hg(slab.g), 1 - slab.ssa + co_albedo_more);
  add_sun(medium, view.to_sun(), slab.sun_radius_rad);
  std::vector<Compared> all;
  const double off = slab.sun_radius_rad > 0 ? kOfDisc : 0;
  const auto compare = [&](const char* name, Seen seen) {
    const double exact = table.at(row, name);
    all.push_back({name, slab_radiance(medium.tracer(), view, seen), {exact, off * exact}});
  };
  if (slab.up) compare("I_up", Seen::kFromAbove);
  if (slab.down) compare("I_down", Seen::kFromBelow);
  EXPECT_EQ(medium.tracer().medium().violations(), 0u);
  return all;
}

class SlabRadiances : public testing::TestWithParam<Case> {};
TEST_P(SlabRadiances, AreThoseOfTheTable) {
  expect_agreement("slab radiance " + GetParam().name, run(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Truth, SlabRadiances, testing::ValuesIn(kCases),
                         [](const auto& with) { return with.param.name; });

TEST(SlabRadianceBias, OfAlbedoIsCaught) {
  expect_caught("slab radiance g0_tau1", run(kCases[0], kBias));
}

}  // namespace
}  // namespace nepho::test
