// A small cloud through the whole bench: real pictures, real references.
#include <gtest/gtest.h>

#include <cmath>

#include "../render/scenes.h"
#include "accuracy_report.h"
#include "analytic_field.h"
#include "bench/run.h"
#include "bench/terms.h"
#include "core/error.h"
#include "dressed_source.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "own_source.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"

namespace nepho::bench {
namespace {

using test::FieldSource;

double clump(glm::dvec3 p) {
  return 1.5 * test::cloud(0.004 * p);
}

const FieldSource& source() {
  static const FieldSource field(test::box(1000, 1000), test::isotropic(3), clump);
  return field;
}

OpenedScene opened() {
  OpenedScene scene;
  scene.request = test::request_of({&source()});
  scene.request.volumes[0].phase.asymmetry = 0.3;
  scene.request.settings.light = Light::kOctaves;
  scene.request.settings.width = 24;
  scene.request.settings.height = 16;
  scene.request.settings.pixels_per_voxel = 0.01;
  scene.request.settings.tolerance = 1e-3;
  scene.request.sun.to_sun = glm::normalize(glm::dvec3(0.6, -0.5, 0.7));
  scene.request.camera = {{300, -1500, 600}, {0, 0, 480}, {0, 0, 1}, 0.75};
  return scene;
}

SceneResult run(const std::vector<std::string>& sweeps, const ReferenceGoals& references) {
  RunGoals goals;
  std::vector<Axis> axes;
  for (const std::string& sweep : sweeps) axes.push_back(parse_axis(sweep));
  goals.settings = combinations(axes);
  goals.references = references;
  Progress progress;
  return run_scene(opened(), "clump", goals, progress);
}

class BenchScene : public test::GlFixture {
 protected:
  const Term& term(const SceneResult& result, std::size_t setting, const char* name) const {
    return *find_term(result.settings[setting].terms, name);
  }
};

// Voxels of optical depth 1 and more, where a source may be the same at both ends of a cell and
// another between them.
TEST_F(BenchScene, the_reference_march_is_converged_in_thick_voxels) {
  const FieldSource thick(test::box(1000, 1000), test::isotropic(3),
                          [](glm::dvec3 p) { return 4 * clump(p); });
  RenderRequest request = opened().request;
  request.volumes[0].source = &thick;
  request.settings.max_level = 2;
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  const CutLevels levels(forest);
  const auto picture = [&](const MarchSettings& settings) {
    return march_picture(RayMarch(levels, request, settings), request);
  };
  const HdrImage truth =
      picture({.source_tolerance = 1e-6, .least_transmittance = 1e-8, .least_halvings = 5});
  const double error = picture_error(picture(kReferenceMarch), truth),
               usual = picture_error(picture({}), truth);
  test::report_accuracy("reference march", "bench, thick voxels: cells in four", error, 1.5e-3,
                        "relative rms of luminance");
  EXPECT_LE(error, 1.5e-3);
  EXPECT_GT(usual, 2 * error);
}

// Simpson's rule over a trilinear field whose kinks steps do not know of, with a source that is
// linear in optical depth: between the first order and the second.
TEST_F(BenchScene, steps_converge) {
  const SceneResult result =
      run({"step=0.5,1,2"}, {.finest_step_voxels = 1.0 / 16, .most_paths = 0});
  for (std::size_t s = 0; s < 3; ++s) {
    const Term& steps = term(result, s, kSteps);
    std::printf("measured: %s: steps %.2e\n", result.settings[s].setting.label().c_str(),
                steps.rms);
    EXPECT_TRUE(steps.told()) << "order: " << steps.withheld;
    EXPECT_GE(result.settings[s].times.frame_s.median, result.settings[s].times.frame_s.low);
    EXPECT_EQ(result.settings[s].times.frame_s.runs, kLeastRepeats);
    EXPECT_EQ(result.settings[s].times.gpu_frame_s.has_value(), result.no_gpu_clock.empty());
  }
  ASSERT_EQ(result.convergence.size(), 1u);
  ASSERT_TRUE(result.convergence[0].fit) << "order: " << result.convergence[0].why_not;
  const OrderFit& fit = *result.convergence[0].fit;
  std::printf("measured: order %.2f +- %.2f\n", fit.order, fit.standard_error);
  EXPECT_GE(fit.order, 0.8);
  EXPECT_LE(fit.order, 2.5);
  EXPECT_EQ(fit.points, 3);
}

// Each is the distance of two pictures on one way: no side of a triangle is longer than the others
// together. (Their means differ by less than the errors themselves.)
TEST_F(BenchScene, terms_are_sides_of_triangles_and_biases_add_up) {
  const SceneResult result = run({"step=1,4", "max-level=1,2"}, {.most_paths = 1024});
  int told = 0;
  for (std::size_t s = 0; s < result.settings.size(); ++s) {
    const auto side = [&](const char* name) {
      const Term& t = term(result, s, name);
      EXPECT_TRUE(t.told()) << result.settings[s].setting.label() << ", " << name << ": "
                            << t.withheld;
      told += t.told();
      return t.rms;
    };
    const double slack = 1.1;
    const double steps = side(kSteps), cache = side(kLightCache), integration = side(kIntegration);
    EXPECT_LE(integration, slack * (steps + cache));
    EXPECT_LE(steps, slack * (integration + cache));
    const double detail = side(kLevelOfDetail), march = side(kMarch);
    EXPECT_LE(march, slack * (integration + detail));
    EXPECT_LE(detail, slack * (integration + march));
    double sum = 0;
    for (const char* name : {kSteps, kLightCache, kLevelOfDetail, kLightModel})
      sum += term(result, s, name).bias_of_truth;
    EXPECT_NEAR(sum, term(result, s, kTotal).bias_of_truth, 1e-5);
    EXPECT_GT(side(kLightModel), 0.02);
    EXPECT_LT(term(result, s, kQuantisation).rms, 1e-3);
  }
  EXPECT_EQ(told, 6 * 4);
  // Coarser bricks, and longer steps, are further off.
  EXPECT_GT(term(result, 0, kLevelOfDetail).rms, 1.5 * term(result, 1, kLevelOfDetail).rms);
  EXPECT_GT(term(result, 2, kSteps).rms, 1.5 * term(result, 0, kSteps).rms);
  EXPECT_STREQ(judged_by(result.settings), kMarch);
  EXPECT_EQ(result.finest, "all levels");
}

TEST_F(BenchScene, steps_are_withheld_where_their_reference_is_as_coarse) {
  const SceneResult result = run({"step=0.5,4"}, {.finest_step_voxels = 0.5, .most_paths = 0});
  EXPECT_FALSE(term(result, 0, kSteps).told());
  EXPECT_NE(term(result, 0, kSteps).withheld.find("--finest-step"), std::string::npos);
  EXPECT_FALSE(result.convergence[0].fit);
}

// A picture's data error, without a renderer: marches alone.
class BenchData : public ::testing::Test {
 protected:
  Term data_of(const BrickSource& source, double host_mib = 64) {
    OpenedScene scene = opened();
    scene.request.volumes[0].source = &source;
    References references(scene, {.most_paths = 0, .host_mib = host_mib}, progress_,
                          scene.request.settings);
    const RenderSettings& settings = scene.request.settings;
    const Reference& finest = references.finest(settings);
    const OwnPicture& own = references.own(settings);
    description_ = references.description();
    change_ = finest.change;
    return *find_term(
        decompose({&finest.picture, &finest, &finest, &finest.picture, &finest, nullptr, &own}, {}),
        kData);
  }
  Progress progress_;
  std::string description_;
  double change_ = 0;
};

TEST_F(BenchData, bricks_that_are_the_field_have_none) {
  // Linear along each axis: what trilinear cells hold.
  const auto ramp = [](glm::dvec3 p) { return 2e-3 * (2 + p.x / 500) * (1 + p.z / 1000); };
  const FieldSource bricks(test::box(1000, 1000), test::isotropic(2), ramp);
  const test::OwnSource exact(bricks, ramp);
  const Term data = data_of(exact);
  ASSERT_TRUE(data.told()) << "data: " << data.withheld;
  const double error = data.rms;
  test::report_accuracy("reference march", "bench, data error of a field that bricks hold", error,
                        1e-4, "relative rms of luminance");
  EXPECT_LE(error, 1e-4);
}

TEST_F(BenchData, is_what_bricks_miss) {
  const test::OwnSource fractal(source(), clump), faint(source(), clump, 0.5f);
  const Term usual = data_of(fractal), halved = data_of(faint);
  std::printf("measured: data error %.4f, bias %.4f; with half the extinction %.4f, %.4f\n",
              usual.rms, usual.bias, halved.rms, halved.bias);
  ASSERT_TRUE(usual.told()) << "data: " << usual.withheld;
  ASSERT_TRUE(halved.told()) << "data: " << halved.withheld;
  EXPECT_GT(usual.rms, 1e-3);
  EXPECT_LT(usual.rms, 0.1);
  // Half of the extinction is planted: it shows.
  const double half_missing = halved.rms;
  EXPECT_GT(half_missing, 5 * usual.rms);
  EXPECT_LT(halved.bias, -0.1);
}

TEST_F(BenchData, is_not_told_without_a_field_or_all_levels) {
  const Term none = data_of(source());
  EXPECT_FALSE(none.told());
  EXPECT_NE(none.withheld.find("no field of its own"), std::string::npos) << none.withheld;
  EXPECT_EQ(description_, "all levels");
}

// Without an end of levels a depth is stated: what lies below it is in words, not in the numbers.
TEST_F(BenchData, a_planet_without_end_is_held_against_a_stated_depth) {
  const test::DressedSource endless(source(),
                                    [](VolumeInfo& info) { info.refine_by_variance = true; });
  const Term data = data_of(endless, 0.5);
  EXPECT_FALSE(data.told());
  EXPECT_NE(data.withheld.find("finer bricks than memory holds"), std::string::npos)
      << data.withheld;
  EXPECT_NE(description_.find("what is finer still is in no number"), std::string::npos)
      << description_;
  EXPECT_NE(description_.find("bricks half as fine look "), std::string::npos) << description_;
  EXPECT_LT(change_, 0.01);  // the march's own
}

TEST_F(BenchScene, a_truth_of_noise_is_refused_with_what_is_needed) {
  // Where the light model changes, the truth judges: eight paths are none.
  try {
    run({"octaves=4,8"}, {.most_paths = 8});
    FAIL() << "told what is noise";
  } catch (const Error& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("no reference is good enough"), std::string::npos) << words;
    EXPECT_NE(words.find("paths a pixel are needed (--spp)"), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace nepho::bench
