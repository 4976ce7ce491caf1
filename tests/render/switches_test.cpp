// What the renderer leaves out by itself changes the picture by less than it predicts, on three
// scenes each, and what changes a picture by more is not left out.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string_view>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "dressed_source.h"
#include "gl_fixture.h"
#include "planet_scenes.h"

namespace nepho::test {
namespace {

constexpr double kRounding = 2e-4;  // of floats, of the mean

// A scene and what it is made of.
struct Scene {
  std::vector<std::shared_ptr<const BrickSource>> sources;
  std::vector<std::shared_ptr<const Slab>> slabs;
  RenderRequest request;
};
using MakeScene = std::function<Scene()>;

Scene scene_with(std::shared_ptr<const BrickSource> source, bool planet) {
  Scene scene;
  scene.sources.push_back(source);
  scene.request = planet ? planet_request({source.get()}) : request_of({source.get()});
  scene.request.settings.light = Light::kOctaves;
  return scene;
}

Scene slab_scene(double low_m, double high_m, double half_m, double extinction_per_m) {
  const auto slab = std::make_shared<const Slab>(low_m, high_m, half_m, extinction_per_m);
  Scene scene = scene_with({slab, &slab->source}, true);
  scene.slabs.push_back(slab);
  return scene;
}

Scene with_view(Scene scene, double height_m, double pitch_deg, double fov_deg,
                double sun_deg = 40) {
  look(scene.request, height_m, pitch_deg, fov_deg);
  scene.request.sun.to_sun = sun_at(sun_deg, 60);
  return scene;
}

// Hills of `peak_m`, of which the part `land` is land.
Scene map_scene(double peak_m, double land) {
  const Scene plain = slab_scene(1000, 2000, 3000, 2e-3);
  const auto map = ridge_map(8000, peak_m, 4000, 1000);
  std::ranges::fill(map->water, float(1 - land));
  Scene scene = scene_with(std::make_shared<DressedSource>(
                               *plain.sources[0], [&](VolumeInfo& info) { info.surface = map; }),
                           true);
  scene.slabs = plain.slabs;
  scene.sources.push_back(plain.sources[0]);
  return scene;
}

// Some hundred km of cloud around the pole, all of it on the finest level.
Scene shell_scene() {
  static const auto clouds = std::make_shared<FieldSource>(
      std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 1000, 17000),
      Lattice({kSplitXy, kSplitXy, kSplitXy, kSplitXy}), [](glm::dvec3 p) {
        const double away = glm::length(glm::dvec2(p)) / 6e5;
        return p.z > 0 && away < 1 ? 2e-3 * (1 - away) * cloud(40 / 6.4e6 * p) : 0;
      });
  Scene scene = scene_with(clouds, true);
  scene.request.settings.pixels_per_voxel = 1e-3;
  return scene;
}

// A ball of cloud in free space; the sun from one side.
Scene ball_scene(double extinction_per_m, const glm::dvec3& eye_m) {
  Scene scene =
      scene_with(std::make_shared<FieldSource>(
                     box(1000, 1000), isotropic(3),
                     [=](glm::dvec3 p) {
                       return extinction_per_m *
                              std::max(0.0, 1 - glm::length(p - glm::dvec3(0, 0, 500)) / 450);
                     }),
                 false);
  scene.request.sun = {glm::normalize(glm::dvec3(-0.6, 0.5, 0.3)), {1.6, 1.85, 2.0}};
  scene.request.camera = {eye_m, {0, 0, 500}, {0, 0, 1}, 0.7};
  return scene;
}

using SwitchOn = void (*)(RenderRequest&);
void all_on(RenderRequest& request) {
  request.leave_nothing_out = true;
}

struct Switch {
  const char* name;
  const char* line;  // how its line in `left out` begins
  const char* unit;  // of the prediction there; empty: exact
  std::vector<MakeScene> scenes;
  MakeScene matters;  // where it must not be left out; may be empty
  SwitchOn switch_on = all_on;

  bool rms() const { return unit == std::string_view("% rms"); }
};

// The number in front of `unit`; 0 where the line predicts no change; negative where there is none.
double prediction(const RenderReport& report, const Switch& s) {
  const std::string unit = s.unit;
  for (const std::string& line : report.left_out) {
    if (!line.starts_with(s.line)) continue;
    if (unit.empty()) return 0;
    const std::size_t end = line.find(' ' + unit), begin = line.rfind(' ', end - 1);
    return std::stod(line.substr(begin + 1, end - begin - 1)) / (unit.starts_with("%") ? 100 : 1);
  }
  return -1;
}

// Difference of green over its mean between a picture and that with the switch on: of the worst
// pixel, or rms where that is what is predicted.
double change(RenderRequest request, const RenderResult& lean, const Switch& s) {
  s.switch_on(request);
  const RenderResult full = render(request);
  EXPECT_LT(prediction(full.report, s), 0) << s.name << " cannot be switched on";
  double worst = 0, sum = 0, squares = 0;
  for (int y = 0; y < lean.image.height; ++y)
    for (int x = 0; x < lean.image.width; ++x) {
      const double here = green_at(full.image, x, y), apart = green_at(lean.image, x, y) - here;
      worst = std::max(worst, std::abs(apart));
      squares += apart * apart;
      sum += here;
    }
  EXPECT_GT(sum, 0) << s.name;
  const double pixels = double(lean.image.width) * lean.image.height;
  return s.rms() ? std::sqrt(squares * pixels) / sum : worst * pixels / sum;
}

class Switches : public GlFixture, public ::testing::WithParamInterface<Switch> {};

TEST_P(Switches, ChangesThePictureByLessThanPredicted) {
  const Switch& s = GetParam();
  ASSERT_EQ(s.scenes.size(), 3u);
  for (const MakeScene& make : s.scenes) {
    const Scene scene = make();
    const RenderResult lean = render(scene.request);
    const double predicted = prediction(lean.report, s);
    ASSERT_GE(predicted, 0) << s.name << " is not left out";
    const double measured = change(scene.request, lean, s);
    std::printf("measured: without %s: predicted %.1e, changed %.1e\n", s.name, predicted,
                measured);
    report_accuracy("switches",
                    std::string("left out: ") + s.name + (s.rms() ? ", rms" : ", worst pixel"),
                    measured, predicted + kRounding, "1");
    EXPECT_LE(measured, predicted + kRounding) << s.name;
  }
}

TEST_P(Switches, IsOnWhereItMatters) {
  const Switch& s = GetParam();
  if (!s.matters) GTEST_SKIP() << "no scene needs it but by what it holds";
  const Scene scene = s.matters();
  const RenderResult result = render(scene.request);
  const double predicted = prediction(result.report, s);
  EXPECT_LT(predicted, 0) << s.name << " is left out, and changes the picture by "
                          << change(scene.request, result, s);
}

const glm::dvec3 kSide(0, -1800, 600), kBelow(0, -1500, -800), kBehind(1200, -1200, 700);

std::vector<Switch> all_switches() {
  const MakeScene thin = [] { return ball_scene(1e-3, kSide); };
  const MakeScene thick = [] { return ball_scene(0.05, kBelow); };
  const MakeScene side = [] { return ball_scene(0.01, kBehind); };
  const std::vector<MakeScene> balls{thin, thick, side};
  const std::vector<MakeScene> shells{[] { return with_view(shell_scene(), 1e5, -25, 30); },
                                      [] { return with_view(shell_scene(), 4e5, -80, 40); },
                                      [] { return with_view(shell_scene(), 2e4, -5, 50, 8); }};
  const auto slab = [](double extinction_per_m, double height_m, double pitch_deg,
                       double sun_deg) -> MakeScene {
    return [=] {
      return with_view(slab_scene(3000, 5000, 4000, extinction_per_m), height_m, pitch_deg, 30,
                       sun_deg);
    };
  };
  const std::vector<MakeScene> planets{slab(2e-3, 2, 20, 40), slab(0.02, 12e3, -60, 15),
                                       slab(5e-4, 4000, -3, 3)};
  const auto hills = [](double peak_m, double land, double height_m, double sun_deg) -> MakeScene {
    return [=] { return with_view(map_scene(peak_m, land), height_m, -6, 60, sun_deg); };
  };
  const MakeScene dark = [] {
    Scene scene = ball_scene(0.01, kSide);
    scene.request.volumes[0].co_albedo = glm::dvec3(1e-3);
    return scene;
  };
  const MakeScene under_sky = [] {
    Scene scene = ball_scene(0.01, kSide);
    scene.request.sky.zenith_W_per_m2_sr_nm = glm::dvec3(0.1);
    return scene;
  };
  // A planet whose volume is clear, and one in black that has no air.
  const auto clear = [&](double height_m, double pitch_deg, double sun_deg) {
    return slab(0, height_m, pitch_deg, sun_deg);
  };
  const auto bare = [](const MakeScene& dressed) -> MakeScene {
    return [dressed] {
      Scene scene = dressed();
      scene.request.planet->air.reset();
      scene.request.settings.step_voxels = 0;  // spans of air cut other steps short
      scene.request.planet->ground = {glm::dvec3(0.0), glm::dvec3(0.0), 6};
      return scene;
    };
  };
  const MakeScene low = [] { return with_view(shell_scene(), 2e4, -5, 50, 25); };
  const auto look_ups = [](RenderRequest& request) { request.settings.fetch = Fetch::kTexels8; };
  const auto all_light = [](RenderRequest& request) { request.march_all_light = true; };
  const MakeScene strict = [] {
    Scene scene = ball_scene(0.01, kSide);
    scene.request.settings.tolerance = 1e-3;
    return scene;
  };
  return {
      {"terrain",
       "terrain",
       "%",
       {hills(0.4, 0, 800, 40), hills(0.9, 0, 5000, 10), hills(0.2, 5e-4, 300, 60)},
       hills(300, 1, 800, 40)},
      {"sun map",
       "clouds' shadows",
       "%",
       {slab(2e-8, 2, 9, 40), slab(3e-8, 12e3, -20, 5), slab(3e-8, 4000, -3, 20)},
       slab(1e-6, 4000, -3, 20)},
      {"third order in leaves", "curves of third order", "voxels", shells, {}},
      {"flat walls", "flat walls", "", shells, planets[0]},
      {"curved walls", "curved walls", "", planets, shells[0]},
      {"sky visibility", "sky visibility", "", balls, under_sky},
      {"absorption", "absorption", "", {balls[1], planets[1], shells[0]}, dark},
      {"ice", "the second channel", "", {balls[1], planets[1], shells[0]}, {}},
      {"air", "air:", "", {bare(shells[0]), bare(shells[1]), bare(low)}, planets[0]},
      {"clouds",
       "clouds over air and ground",
       "",
       {clear(2, 20, 40), clear(12e3, -60, 15), clear(4000, -3, 3)},
       planets[0]},
      {"lookups", "exact look-ups", "%", {thick, side, shells[1]}, strict, look_ups},
      {"light of clear samples",
       "light of",
       "% rms",
       {thick, side, shells[2]},
       planets[0],
       all_light},
  };
}

INSTANTIATE_TEST_SUITE_P(All, Switches, ::testing::ValuesIn(all_switches()), [](const auto& each) {
  std::string name = each.param.name;
  std::ranges::replace(name, ' ', '_');
  return name;
});

}  // namespace
}  // namespace nepho::test
