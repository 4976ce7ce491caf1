// What a planet's renderer leaves out by itself changes the picture by less than it predicts, and
// clouds leave no light on the sea that is not there.
#include <gtest/gtest.h>

#include <cstdio>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "dressed_source.h"
#include "gl_fixture.h"
#include "planet_scenes.h"

namespace nepho::test {
namespace {

using PlanetSwitches = GlFixture;

// The number in front of `unit` of the line that begins with `name`; negative where there is none.
double prediction(const RenderReport& report, const std::string& name, const std::string& unit) {
  for (const std::string& line : report.left_out) {
    if (!line.starts_with(name)) continue;
    const std::size_t end = line.find(' ' + unit), begin = line.rfind(' ', end - 1);
    return std::stod(line.substr(begin + 1, end - begin - 1)) / (unit == "%" ? 100 : 1);
  }
  return -1;
}

// Largest difference of green over its mean, all passes and channels against those that are made.
double change(RenderRequest request, const RenderResult& lean) {
  request.leave_nothing_out = true;
  const RenderResult full = render(request);
  double worst = 0, sum = 0;
  for (int y = 0; y < lean.image.height; ++y)
    for (int x = 0; x < lean.image.width; ++x) {
      worst = std::max(worst,
                       std::abs(double(green_at(lean.image, x, y) - green_at(full.image, x, y))));
      sum += green_at(full.image, x, y) / double(lean.image.width * lean.image.height);
    }
  EXPECT_GT(full.report.shader_switches.size() + full.report.passes.size(), 0u);
  EXPECT_LT(full.report.left_out.size(), lean.report.left_out.size());
  return worst / sum;
}

void expect_predicted(const char* name, const RenderRequest& request, const char* line,
                      const char* unit) {
  const RenderResult lean = render(request);
  const double predicted = prediction(lean.report, line, unit), measured = change(request, lean);
  std::printf("measured: without %s: predicted %.1e, changed %.1e\n", name, predicted, measured);
  ASSERT_GE(predicted, 0) << name;
  // Rounding of floats aside.
  report_accuracy("switches", std::string("left out: ") + name + ", worst pixel", measured,
                  predicted + 2e-4, "1");
  EXPECT_LE(measured, predicted + 2e-4) << name;
}

TEST_F(PlanetSwitches, AMapOfSeaChangesNothing) {
  const Slab slab(1000, 2000, 3000, 2e-3);
  const auto map = ridge_map(8000, 0.4, 4000, 1000);
  std::ranges::fill(map->water, 1.0f);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  RenderRequest request = planet_request({&source});
  look(request, 800, -6);
  expect_predicted("terrain", request, "terrain", "%");
}

TEST_F(PlanetSwitches, FaintCloudsShadowNoAir) {
  const Slab slab(3000, 5000, 4000, 2e-8);
  RenderRequest request = planet_request({&slab.source});
  look(request, 2, 9, 30);
  expect_predicted("sun map", request, "clouds' shadows", "%");
}

TEST_F(PlanetSwitches, PlacesInNarrowLeavesAreParabolas) {
  // Some hundred km of cloud around the pole, all of it on the finest level.
  const FieldSource clouds(std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 1000, 17000),
                           Lattice({kSplitXy, kSplitXy, kSplitXy, kSplitXy}), [](glm::dvec3 p) {
                             const double away = glm::length(glm::dvec2(p)) / 6e5;
                             return p.z > 0 && away < 1 ? 2e-3 * (1 - away) * cloud(40 / 6.4e6 * p)
                                                        : 0;
                           });
  RenderRequest request = planet_request({&clouds});
  request.settings.light = Light::kOctaves;
  request.settings.pixels_per_voxel = 1e-3;
  look(request, 1e5, -25, 30);
  const HdrImage image = render(request).image;
  EXPECT_GT(*std::ranges::max_element(image.optical_depth), 0.5f);
  expect_predicted("third order in leaves", request, "curves of third order", "voxels");
}

// Seen past a small cloud, the sea below it is no brighter than in the open.
TEST_F(PlanetSwitches, NoPalePatchUnderASmallCloud) {
  const Slab slab(1500, 2500, 800, 5e-3);
  RenderRequest request = planet_request({&slab.source});
  const glm::dvec3 eye = (kRadius_m + 500) * kUp - 6000.0 * kNorth;
  request.camera = {eye, kRadius_m * kUp, kUp, 2 * kPi / 180};
  request.sun.to_sun = sun_at(75, 90);
  const double under = green_at(render(request).image, 16, 9);
  request.volumes.clear();
  const double open = green_at(render(request).image, 16, 9);
  std::printf("measured: the sea under a cloud has %.3f of the light of the open sea\n",
              under / open);
  EXPECT_LE(under, 1.03 * open);
  EXPECT_GE(under, 0.3 * open);
}

}  // namespace
}  // namespace nepho::test
