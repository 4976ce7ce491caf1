#include "reference/probe.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <ctime>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "bricks/quantise.h"
#include "march_support.h"
#include "random.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"

namespace nepho {
namespace {

using test::FieldSource;

constexpr double kSide_m = 1000;

// What was coded, by undoing the coding sample by sample.
class UncodedLevels final : public CutLevels {
 public:
  UncodedLevels(const Forest& forest, const FieldSource& source)
      : CutLevels(forest), source_(source) {}
  bool has_noise() const override { return true; }
  double noise_per_m(std::size_t, const LevelLeaf& leaf, const Index3& g) const override {
    const Index3 first = Lattice::global_sample(leaf.key, {0, 0, 0});
    const std::uint16_t code =
        leaf.brick->codes[brick_offset(g[0] - first[0], g[1] - first[1], g[2] - first[2])];
    return source_.sample(leaf.key, g) -
           double(decode(code, leaf.brick->scale, leaf.brick->offset));
  }

 private:
  const FieldSource& source_;
};

struct Case {
  RenderRequest request;
  Forest forest;
  HdrImage cut;
};

const FieldSource& source() {
  static const FieldSource field(test::box(kSide_m), test::isotropic(3), [](glm::dvec3 p) {
    return 10 * test::cloud(5.0 / kSide_m * p) + 2 * test::puffs(p / kSide_m);
  });
  return field;
}

Case make_case(test::Random& random, bool sky) {
  Case c;
  c.request = test::request_of({test::volume_of(source())}, Light::kOctaves);
  c.request.sun.to_sun = glm::normalize(
      glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)});
  if (sky) {
    c.request.sky.zenith_W_per_m2_sr_nm = {0.02, 0.04, 0.08};
    c.request.sky.horizon_W_per_m2_sr_nm = glm::dvec3{0.05};
  }
  c.request.camera = {.eye_m = {500 + random.uniform(-800, 800), -1400, 600},
                      .target_m = {500, 500, 500}};
  c.request.settings.width = 24;
  c.request.settings.height = 16;
  c.request.settings.probe_pixels = 64;
  c.request.settings.seed = std::uint64_t(random.integer(1, 1000));
  Refinement refinement{c.request.camera, c.request.settings, {}};
  refinement.settings.tolerance = random.log_uniform(10, 60);
  refinement.settings.pixels_per_voxel = 0.1;
  c.forest = build_forest(c.request.volumes, refinement);
  c.cut = march_picture(CutLevels(c.forest), c.request);
  return c;
}

void expect_within_three(double estimate, double measured, const char* term) {
  std::printf("%s: estimated %.2e, measured %.2e\n", term, estimate, measured);
  EXPECT_LT(estimate, 3 * measured) << term;
  EXPECT_GT(estimate, measured / 3) << term;
}

TEST(Probe, EachTermIsWithinThreeOfTheWholePicture) {
  test::Random random;
  for (int i = 0; i < 4; ++i) {
    const Case c = make_case(random, i % 2 == 1);
    // A march that is off by 2 % here and 10 % there.
    HdrImage picture = c.cut;
    for (std::size_t p = 0; p < picture.optical_depth.size(); ++p)
      for (std::size_t ch = 0; ch < 3; ++ch)
        picture.rgb[3 * p + ch] *= float(1 + (p % 5 == 0 ? 0.1 : -0.02));
    const ErrorEstimate estimate = estimate_error(c.request, c.forest, picture);
    EXPECT_EQ(estimate.probe_pixels, 64);
    expect_within_three(estimate.integration, picture_error(picture, c.cut), "integration");
    const HdrImage finest = march_picture(FinestLevels(c.request.volumes, 64), c.request);
    expect_within_three(estimate.level_of_detail, picture_error(c.cut, finest), "level of detail");
    const HdrImage uncoded = march_picture(UncodedLevels(c.forest, source()), c.request);
    expect_within_three(estimate.quantisation, picture_error(c.cut, uncoded), "quantisation");
    EXPECT_GT(estimate.light_model, 0.02);
    EXPECT_LT(estimate.light_model, 10);
  }
}

// An even error is known from 64 probes; one that sits in few pixels asks for all of them.
TEST(Probe, MarchesOnUntilTheErrorIsKnown) {
  test::Random random;
  Case c = make_case(random, false);
  c.request.settings.probe_pixels = 128;
  const auto off_by = [&](auto&& offset) {
    HdrImage picture = c.cut;
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] += float(offset(i / 3));
    return estimate_error(c.request, c.forest, picture);
  };
  const ErrorEstimate even = off_by([](std::size_t) { return 1e-3; });
  EXPECT_EQ(even.probe_pixels, 64);
  const ErrorEstimate rare = off_by([](std::size_t p) { return p % 24 == 7 ? 1e-2 : 1e-5; });
  EXPECT_GT(rare.probe_pixels, 96);
}

TEST(Probe, SameNumbersForAnyNumberOfThreadsAndAnotherForAnotherSeed) {
  test::Random random;
  Case c = make_case(random, false);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, threads);
    return estimate_error(c.request, c.forest, c.cut);
  };
  const ErrorEstimate one = with_threads(1), eight = with_threads(8);
  EXPECT_EQ(one.level_of_detail, eight.level_of_detail);
  EXPECT_EQ(one.quantisation, eight.quantisation);
  EXPECT_EQ(one.light_model, eight.light_model);
  EXPECT_LT(one.integration, 1e-6) << "the picture is the march itself, in float";
  c.request.settings.seed += 1;
  EXPECT_NE(with_threads(1).level_of_detail, one.level_of_detail);
}

TEST(Probe, NothingSeenIsNotMeasuredAndAWholeCutHasNoLevelOfDetailError) {
  test::Random random;
  Case c = make_case(random, false);
  HdrImage clear = c.cut;
  for (float& depth : clear.optical_depth) depth = 0;
  const ErrorEstimate none = estimate_error(c.request, c.forest, clear);
  EXPECT_EQ(none.probe_pixels, 0);
  EXPECT_LT(none.integration, 0);
  EXPECT_LT(none.level_of_detail, 0);

  Refinement all{c.request.camera, c.request.settings, {}};
  all.settings.tolerance = 0;
  all.settings.pixels_per_voxel = 0;
  const Forest whole = build_forest(c.request.volumes, all);
  c.request.settings.probe_pixels = 8;
  EXPECT_EQ(estimate_error(c.request, whole, c.cut).level_of_detail, 0);
}

TEST(Probe, CostIsStated) {
  test::Random random;
  Case c = make_case(random, true);
  const std::clock_t before = std::clock();
  const ErrorEstimate estimate = estimate_error(c.request, c.forest, c.cut);
  const double cpu_ms = 1e3 * double(std::clock() - before) / CLOCKS_PER_SEC;
  std::printf("%.2f ms CPU for each of %d probes\n", cpu_ms / estimate.probe_pixels,
              estimate.probe_pixels);
  EXPECT_LT(cpu_ms / estimate.probe_pixels, 400);
}

}  // namespace
}  // namespace nepho
