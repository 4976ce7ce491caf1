// What --tolerance promises: of the integration along view rays, an error below it on 99 % of the
// pixels, and no more samples than 1.5 times those of the fixed step that does as well. Against the
// cell-exact march in double, through the same bricks, with the light of the same tiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "accuracy_report.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "planet_scenes.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"
#include "tolerance_scenes.h"

namespace nepho::test {
namespace {

// Steps of the truth are halved until a step's light is this well known.
constexpr double kTruth = 1e-5;
constexpr double kMostCost = 1.5;  // of the cheapest fixed step
constexpr double kTolerances[] = {1e-1, 1e-2, 1e-3, 1e-4};

// Of pixels with some cloud, relative to their own luminance.
struct Measured {
  double half = 0, most = 0;  // median and 99 % quantile of the errors
  double samples = 0;         // extinction and source, per ray that sees cloud
};

double quantile(std::vector<double> values, double part) {
  const auto at = std::size_t(part * double(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(at));
  return values[at];
}

std::vector<double> errors_of(const HdrImage& image, const HdrImage& truth, Counts counts) {
  std::vector<double> errors;
  for (std::size_t p = 0; p < truth.optical_depth.size(); ++p) {
    if (counts == Counts::kWithCloud && double(truth.optical_depth[p]) <= kShownOpticalDepth)
      continue;
    const double exact = pixel_luminance(truth, p);
    errors.push_back(std::abs(pixel_luminance(image, p) - exact) / std::max(exact, 1e-30));
  }
  return errors;
}

// A scene with the truths of its pictures: one for each light that they had.
class Judge {
 public:
  explicit Judge(MarchScene scene) : scene_(std::move(scene)) {}

  Measured measure(double tolerance, std::optional<double> step_voxels = {}) {
    RenderRequest request = scene_.request;
    request.settings.tolerance = tolerance;
    if (step_voxels) {
      request.settings.step_voxels = step_voxels;
      request.settings.fetch = Fetch::kTexels8;
    }
    request.light_step_voxels = 2;
    request.keep_lights = request.count_samples = true;
    const RenderResult result = render(request);
    const HdrImage& exact = truth(request, result.lights);
    const std::vector<double> errors = errors_of(result.image, exact, Counts::kWithCloud);
    if (errors.size() < 150) throw std::logic_error(scene_.name + " shows too little");
    const SampleCounts& samples = result.report.samples;
    return {quantile(errors, 0.5), quantile(errors, 0.99),
            (samples.extinction + samples.source) / double(errors.size())};
  }
  // The coarsest of fixed steps, from 8 voxels by factors of sqrt(2), that is no further off. Where
  // none is (sums in float; where a second volume begins within the first), the finest: what does
  // as well would cost more.
  Measured cheapest_fixed(double tolerance, double error, double& step_voxels) {
    // Rays of a fixed step end by the tolerance too; above 1e-3 all at the same transmittance.
    const double ends_by = std::min(tolerance, 1e-3);
    Measured finest;
    for (step_voxels = 8; step_voxels > 0.06; step_voxels /= std::sqrt(2.0)) {
      const auto [known, fresh] = fixed_.try_emplace({ends_by, step_voxels});
      if (fresh) known->second = measure(ends_by, step_voxels);
      finest = known->second;
      if (finest.most <= error) return finest;
    }
    return finest;
  }

 private:
  const HdrImage& truth(const RenderRequest& request,
                        const std::shared_ptr<const LightTiles>& lights) {
    for (const auto& [known, image] : truths_)
      if (known->values == lights->values) return image;
    const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
    const MarchSettings settings{
        .source_tolerance = kTruth, .least_transmittance = 1e-8, .lights = lights};
    return truths_.emplace_back(lights, march_picture(CutLevels(forest), request, settings)).second;
  }

  MarchScene scene_;
  std::vector<std::pair<std::shared_ptr<const LightTiles>, HdrImage>> truths_;
  std::map<std::pair<double, double>, Measured> fixed_;
};

class Tolerance : public GlFixture, public ::testing::WithParamInterface<std::string> {};

TEST_P(Tolerance, IsKeptAtTheCostOfFixedSteps) {
  const auto& scenes = march_scenes();
  const auto scene =
      std::ranges::find(scenes, GetParam(), &std::pair<std::string, MakeMarchScene>::first);
  ASSERT_NE(scene, scenes.end());
  Judge judge(scene->second());
  for (const double tolerance : kTolerances) {
    const Measured adaptive = judge.measure(tolerance);
    double step_voxels = 0;
    const Measured fixed = judge.cheapest_fixed(tolerance, adaptive.most, step_voxels);
    const double cost = adaptive.samples / fixed.samples;
    std::printf(
        "measured: %s, tolerance %g: error %.1e (half of the pixels %.1e), %.0f samples a ray; "
        "steps "
        "of %.2f voxels: %.1e, %.0f samples; cost %.2f\n",
        GetParam().c_str(), tolerance, adaptive.most, adaptive.half, adaptive.samples, step_voxels,
        fixed.most, fixed.samples, cost);
    std::fflush(stdout);
    const std::string name = GetParam() + ", " + report_number(tolerance);
    append_accuracy_row("Tolerance", name + ": error of 99 % of the pixels", adaptive.most,
                        tolerance, "relative luminance");
    append_accuracy_row("Tolerance", name + ": samples over those of fixed steps as exact", cost,
                        kMostCost, "1");
    EXPECT_LE(adaptive.most, tolerance) << GetParam();
    EXPECT_LE(cost, kMostCost) << GetParam() << ", tolerance " << tolerance;
    EXPECT_GT(adaptive.most, 1e-7) << "a picture against itself";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Tolerance, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& scene : march_scenes()) names.push_back(scene.first);
                           return names;
                         }()),
                         [](const auto& each) {
                           std::string name = each.param;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

// With air between and interpolated pixels, against marches of all pixels in short fixed steps:
// what the tolerance governs of them. Spans of air and tables are the same in both; spans apart
// below.
using ToleranceOverAPlanet = GlFixture;

void expect_kept_over_a_planet(const char* name, RenderRequest request) {
  request.settings.light = Light::kOctaves;
  request.settings.width = 128;
  request.settings.height = 72;
  request.light_step_voxels = 2;
  for (const double tolerance : kTolerances) {
    request.settings.tolerance = tolerance;
    RenderRequest shorter = request;
    shorter.settings.step_voxels = 0.125;
    shorter.settings.fetch = Fetch::kTexels8;
    shorter.settings.pixels = WhichPixels::kAll;
    const HdrImage truth = render(shorter).image;
    const auto error_with = [&](WhichPixels pixels) {
      request.settings.pixels = pixels;
      return quantile(errors_of(render(request).image, truth, Counts::kAll), 0.99);
    };
    const double all = error_with(WhichPixels::kAll), most = error_with(WhichPixels::kAdaptive);
    std::printf("measured: %s, tolerance %g: error %.1e, all pixels marched %.1e\n", name,
                tolerance, most, all);
    std::fflush(stdout);
    append_accuracy_row("Tolerance",
                        std::string(name) + ", " + report_number(tolerance) +
                            ": error of 99 % of the pixels, some interpolated",
                        most, tolerance, "relative luminance");
    EXPECT_LE(all, tolerance) << name;
    EXPECT_LE(most, tolerance) << name;
  }
}

TEST_F(ToleranceOverAPlanet, IsKeptUnderClouds) {
  const FieldSource puffs(
      std::make_shared<BoxChart>(glm::dvec3(-12e3, -12e3, kRadius_m + 1000),
                                 glm::dmat3(24e3, 0., 0., 0., 24e3, 0., 0., 0., 2000.)),
      Lattice({kSplitXy, kSplitXy, kSplitXyz, kSplitXyz}),
      [](glm::dvec3 p) { return 2e-2 * cloud(1.2e-3 * (p - kRadius_m * kUp)); });
  RenderRequest request = planet_request({&puffs});
  request.settings.pixels_per_voxel = 1e-3;
  look(request, 300, 12);
  expect_kept_over_a_planet("under puffs", request);
}

// Towers behind tens of km of air, whose spans follow the tolerance: in front of a cloud it is lit,
// within it it is not.
TEST_F(ToleranceOverAPlanet, IsKeptBySpansOfAir) {
  const FieldSource towers(
      std::make_shared<BoxChart>(glm::dvec3(-80e3, 20e3, kRadius_m + 1000),
                                 glm::dmat3(160e3, 0., 0., 0., 160e3, 0., 0., 0., 9000.)),
      Lattice({kSplitXy, kSplitXy, kSplitXy, kSplitXyz, kSplitXyz}),
      [](glm::dvec3 p) { return 2e-2 * cloud(1.5e-4 * (p - kRadius_m * kUp)); });
  RenderRequest request = planet_request({&towers});
  request.settings.pixels_per_voxel = 1e-3;
  request.settings.light = Light::kOctaves;
  request.settings.width = 128;
  request.settings.height = 72;
  request.light_step_voxels = 2;
  request.settings.pixels = WhichPixels::kAll;
  look(request, 2000, 1, 30);
  request.settings.tolerance = 2e-5;
  const HdrImage truth = render(request).image;
  for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
    request.settings.tolerance = tolerance;
    const double error = quantile(errors_of(render(request).image, truth, Counts::kAll), 0.99);
    std::printf("measured: towers in air, tolerance %g: error %.1e\n", tolerance, error);
    append_accuracy_row("Tolerance",
                        "towers, " + report_number(tolerance) + ": error of 99 % of the pixels",
                        error, tolerance, "relative luminance");
    EXPECT_LE(error, tolerance);
  }
}

}  // namespace
}  // namespace nepho::test
