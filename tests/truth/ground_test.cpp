#include <numbers>

#include "dressed_source.h"
#include "truth_support.h"
#include "truth_table.h"

// Cloud over a Lambert ground: a slab above a planet so large that it is level.

namespace nepho::test {
namespace {

using std::numbers::pi;

constexpr double kRadius_m = 1e9, kBase_m = 200, kMuSun = 0.5;
// A disc that phase functions and ground meet as often as it is sampled.
constexpr double kWide_rad = 0.4;

// Land in the middle of a map of 400 km, in cells of 1 km.
std::shared_ptr<const SurfaceMap> land() {
  constexpr int n = 401;
  auto map = std::make_shared<SurfaceMap>();
  map->axes = {glm::dvec3{0, 0, 1}, glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0}};
  map->nx = map->ny = n;
  map->step_rad = glm::dvec2{1000 / kRadius_m};
  map->low_rad = -0.5 * (n - 1) * map->step_rad;
  map->height_m.assign(std::size_t(n * n), 0);
  map->water.assign(std::size_t(n * n), 0);
  map->water.front() = 1;  // a map of nothing but land at sea level says nothing
  return map;
}

struct Scene {
  std::string name;
  double albedo, depth;
  Phase phase;
  double sun_radius_rad = 0;
};
void PrintTo(const Scene& scene, std::ostream* out) {
  *out << scene.name;
}

void set_up(Medium& medium, const Scene& scene) {
  const auto chart = std::make_shared<BoxChart>(glm::dvec3{0, 0, kRadius_m + kBase_m},
                                                glm::dmat3(100.0), Periodic{true, true});
  static std::vector<std::shared_ptr<const FieldSource>> kept;
  kept.push_back(std::make_shared<FieldSource>(
      chart, isotropic(0), [&](const glm::dvec3&) { return scene.depth / 100; }));
  const auto dress = [](VolumeInfo& info) { info.surface = land(); };
  medium.add(std::make_shared<DressedSource>(*kept.back(), dress), scene.phase);
  Planet planet;
  planet.body = Ellipsoid::sphere(kRadius_m);
  planet.air.reset();
  planet.ground.land_albedo = glm::dvec3{scene.albedo};
  medium.request.planet = planet;
  medium.request.sun = {.to_sun = {-std::sqrt(1 - kMuSun * kMuSun), 0, kMuSun},
                        .irradiance_W_per_m2_nm = glm::dvec3{1.0}};
  medium.settings.sun_radius_rad = scene.sun_radius_rad;
}

// What the whole reflects of the sun's light: the radiance upwards, by the cosine law. The mean of
// a disc's directions is (1 + cos(radius)) / 2 of the one to its middle.
Estimate plane_albedo(const Scene& scene) {
  Medium medium;
  set_up(medium, scene);
  const PathTracer& tracer = medium.tracer();
  const double falling = kMuSun * 0.5 * (1 + std::cos(scene.sun_radius_rad));
  return measure_to<1>(1, [&](Random& random) {
    const Ray ray{{50, 50, kRadius_m + kBase_m + 101}, cosine_law({0, 0, -1}, random)};
    return std::array{tracer.sample(ray, random).radiance_W_per_m2_sr_nm[1] * pi / falling};
  })[0];
}

double flux(double mu, const char* column) {
  const TruthTable table(NEPHO_TRUTH_DIR "/slab_flux.csv");
  std::size_t row = 0;
  while (table.at(row, "g") != 0 || table.at(row, "ssa") != 1 || table.at(row, "tau") != 4 ||
         std::abs(table.at(row, "mu0") - mu) > 1e-9)
    ++row;
  return table.at(row, column);
}
// For light from all sides: 2 int R mu dmu, by Simpson's rule; 5e-4 off.
double spherical_albedo() {
  double sum = 0;
  for (int i = 1; i <= 10; ++i) sum += (i == 10 ? 1 : i % 2 ? 4 : 2) * flux(0.1 * i, "R") * 0.1 * i;
  return 2 * sum * 0.1 / 3;
}

class WhiteGrounds : public testing::TestWithParam<Scene> {};
// Nothing absorbs: all that the sun sends down comes back, whatever the cloud.
TEST_P(WhiteGrounds, GiveBackAllLight) {
  expect_agreement("white ground " + GetParam().name,
                   {{"plane albedo", plane_albedo(GetParam()), {1}}});
}
INSTANTIATE_TEST_SUITE_P(Truth, WhiteGrounds,
                         testing::Values(Scene{"g85_tau1_wide_sun", 1, 1, hg(0.85), kWide_rad},
                                         Scene{"backward_tau1", 1, 1, hg(-0.3)},
                                         Scene{"even_tau4", 1, 4, hg(0)}),
                         [](const auto& with) { return with.param.name; });

// Light that goes to and fro between ground and cloud: R + A T T' / (1 - A R').
TEST(GreyGround, AddsToTheCloudAsLayersDo) {
  constexpr double albedo = 0.3;
  const double back = spherical_albedo();
  const double exact =
      flux(kMuSun, "R") + albedo * flux(kMuSun, "T_total") * (1 - back) / (1 - albedo * back);
  expect_agreement("grey ground under even tau 4",
                   {{"plane albedo", plane_albedo({"", albedo, 4, hg(0)}), {exact, 1e-3 * exact}}});
}

TEST(GroundBias, OfAlbedoIsCaught) {
  const Scene scene{"", 1 - kBias, 1, hg(-0.3)};
  expect_caught("white ground backward_tau1", {{"plane albedo", plane_albedo(scene), {1}}});
}

}  // namespace
}  // namespace nepho::test
