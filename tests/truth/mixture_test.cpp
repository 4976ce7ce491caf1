#include "dressed_source.h"
#include "truth_support.h"
#include "truth_table.h"

// Media of several kinds in one place, against slabs of one kind, and slabs on a large sphere.

namespace nepho::test {
namespace {

constexpr double kDepth = 8, kMuSun = 0.5;
const glm::dvec3 kDown{0.86602540378443865, 0, -kMuSun};

Estimate truth(double g, double ssa, const char* column) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_flux.csv");
  std::size_t row = 0;
  while (table.at(row, "g") != g || table.at(row, "ssa") != ssa || table.at(row, "tau") != kDepth ||
         table.at(row, "mu0") != kMuSun)
    ++row;
  return {table.at(row, column)};
}

// Reflected and transmitted part.
std::array<Estimate, 2> fluxes(const PathTracer& tracer, double precision = kPrecision) {
  const auto history = [&](Random& random) {
    const Escape escape = walk(tracer, {{50, 50, kSlab_m + 1}, kDown}, random);
    const bool up = escape.ray.direction.z > 0;
    return std::array{double(!escape.absorbed && up), double(!escape.absorbed && !up)};
  };
  return measure_to<2>(std::uint64_t(1e4 * precision / kPrecision), history, precision);
}
std::vector<Compared> against(const std::array<Estimate, 2>& ours, const Estimate& reflected,
                              const Estimate& transmitted) {
  return {{"R", ours[0], reflected}, {"T", ours[1], transmitted}};
}

// Black and white in one place are grey.
std::vector<Compared> two_albedos(double co_albedo) {
  Medium medium;
  add_slab(medium, Profile::kTent, kDepth / 2, hg(0.85), 0);
  add_slab(medium, Profile::kTent, kDepth / 2, hg(0.85), co_albedo);
  return against(fluxes(medium.tracer()), truth(0.85, 0.9, "R"), truth(0.85, 0.9, "T_total"));
}
TEST(Mixture, OfTwoAlbedosIsTheirMean) {
  expect_agreement("two volumes, albedo 1 and 0.8", two_albedos(0.2));
}
TEST(MixtureBias, OfAlbedoIsCaught) {
  expect_caught("two volumes, albedo 1 and 0.8", two_albedos(0.2 + 2 * kBias));
}

// A tent of which this part is ice.
const PathTracer& ice_slab(Medium& medium, double ice_part, double depth = kDepth) {
  Medium plain;  // for its source
  add_slab(plain, Profile::kTent, depth, hg(0), 0);
  const BrickSource& source = *plain.request.volumes.front().source;
  static std::vector<Medium> kept;
  const auto dress = [](VolumeInfo& info) {
    info.channels.push_back({.channel = Channel::kIceExtinction, .name = "ice"});
  };
  RenderVolume& volume =
      medium.add(std::make_shared<DressedSource>(source, dress, ice_part), hg(0.75));
  volume.ice_phase = hg(0.85);
  kept.push_back(std::move(plain));
  return medium.tracer();
}

TEST(Mixture, OfIceAloneScattersAsIce) {
  Medium medium;
  expect_agreement("all ice", against(fluxes(ice_slab(medium, 1)), truth(0.85, 1, "R"),
                                      truth(0.85, 1, "T_total")));
}
TEST(Mixture, WithoutIceScattersAsWater) {
  Medium medium;
  expect_agreement("no ice", against(fluxes(ice_slab(medium, 0)), truth(0.75, 1, "R"),
                                     truth(0.75, 1, "T_total")));
}
// Ice in water is what two volumes over each other are.
TEST(Mixture, OfIceAndWaterIsTwoVolumes) {
  Medium mixed, apart;
  const auto ours = fluxes(ice_slab(mixed, 0.25), 0.8 * kPrecision);
  add_slab(apart, Profile::kTent, 0.75 * kDepth, hg(0.75), 0);
  add_slab(apart, Profile::kTent, 0.25 * kDepth, hg(0.85), 0);
  const auto other = fluxes(apart.tracer(), 0.6 * kPrecision);
  expect_agreement("a quarter ice", against(ours, other[0], other[1]));
}

// A ray along the tent's axis and one aslant meet the mean of its samples, of both volumes.
TEST(Mixture, OfVolumesHasTheProductOfTransmittances) {
  Medium medium;
  add_slab(medium, Profile::kTent, 0.4, hg(0), 0);
  add_slab(medium, Profile::kEven, 0.3, hg(0), 0);
  const PathMedium& both = medium.tracer().medium();
  const auto ours = measure_to<2>(
      1,
      [&](Random& random) {
        return std::array{both.transmittance({{5, 5, 101}, {0, 0, -1}}, kNoDistance_m, random),
                          both.transmittance({{5, 5, 101}, kDown}, kNoDistance_m, random)};
      },
      kPrecision / 2);
  expect_agreement("transmittance through two volumes",
                   {{"upright", ours[0], {std::exp(-0.7)}}, {"aslant", ours[1], {std::exp(-1.4)}}});
}

// What is left of such a ray is mostly decided by roulette, within leaves and from one volume to
// the next.
TEST(Mixture, KeepsTheMeanOfFaintWays) {
  Medium medium;
  add_slab(medium, Profile::kTent, 3.0, hg(0), 0);
  add_slab(medium, Profile::kEven, 0.5, hg(0), 0);
  const PathMedium& both = medium.tracer().medium();
  const auto ours = measure_to<1>(
      1,
      [&](Random& random) {
        return std::array{both.transmittance({{5, 5, 101}, {0, 0, -1}}, kNoDistance_m, random)};
      },
      kPrecision);
  expect_agreement("faint transmittance", {{"upright", ours[0], {std::exp(-3.5)}}});
}

// A slab about a sphere of 1e8 m, over one of its cube's corners: three faces meet there.
std::vector<Compared> shell_slab(double planted = 1) {
  constexpr double radius_m = 1e8;
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(radius_m), 0.0, kSlab_m);
  Medium medium;
  medium.add(
      chart, Lattice({kSplitZ}),
      [&](const glm::dvec3& p) {
        const double height = (glm::length(p) - radius_m) / kSlab_m;
        const double share = std::max(0.0, 1 - std::abs(2 * height - 1));
        return planted * 2 * kDepth / kSlab_m * share;
      },
      hg(0.85));
  Ground ground;
  ground.add(*chart);
  const PathTracer& tracer = medium.tracer();
  const glm::dvec3 up = glm::normalize(glm::dvec3{1.0});
  const glm::dvec3 level = glm::normalize(glm::dvec3{1, -1, 0});
  const Ray down{(radius_m + kSlab_m + 1) * up, kDown.x * level - kMuSun * up};
  const auto ours = measure_to<2>(1, [&](Random& random) {
    const Escape escape =
        walk(tracer, down, random, [&](const Ray& ray) { return ground.distance_m(ray); });
    const bool out = !(ground.distance_m(escape.ray) < kNoDistance_m);
    return std::array{double(out), double(!out)};
  });
  return against(ours, truth(0.85, 1, "R"), truth(0.85, 1, "T_total"));
}
TEST(ShellSlab, IsASlabWhereTheSphereIsLarge) {
  expect_agreement("slab on a sphere of 1e8 m", shell_slab());
}

}  // namespace
}  // namespace nepho::test
