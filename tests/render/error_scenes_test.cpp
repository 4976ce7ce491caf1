// The error line against whole pictures, term by term, on scenes that differ in kind: within a
// factor of 3, on each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "accuracy_report.h"
#include "bricks/coarsen.h"
#include "bricks/quantise.h"
#include "error_scenes.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"
#include "reference/path/path_picture.h"
#include "reference/path/path_tracer.h"

namespace nepho::test {
namespace {

class ErrorScenes : public GlFixture, public ::testing::WithParamInterface<std::size_t> {};

// Each sample coded again, in steps of nearly the same size that fall elsewhere: what coding does,
// not a model of it. The codes of a step cannot be told from their own decoding.
class RecodedLevels final : public CutLevels {
 public:
  using CutLevels::CutLevels;
  bool has_noise() const override { return true; }
  double noise_per_m(std::size_t, const LevelLeaf& leaf, const Index3& g) const override {
    const Index3 first = Lattice::global_sample(leaf.key, {0, 0, 0});
    const LeafBrick& brick = *leaf.brick;
    const std::uint16_t code =
        brick.codes[brick_offset(g[0] - first[0], g[1] - first[1], g[2] - first[2])];
    const double value = double(decode(code, brick.scale, brick.offset));
    const double step = 1.0123456789 * double(brick.scale);
    return value == 0 ? 0 : std::round(value / step) * step - value;
  }
};

Counts counts_of(const RenderRequest& request) {
  return request.planet ? Counts::kAll : Counts::kWithCloud;
}

// Rms of what paths see and the light model does not, over the whole picture. The noise of their
// squares is subtracted, and has to be small beside what is left.
double light_model_error(const HdrImage& cut, const Forest& forest, const RenderRequest& request,
                         int paths) {
  const PathTracer tracer(forest, request, {.exact_orders = 8});
  RenderRequest seeded = request;
  seeded.settings.seed = 4711;
  const PathPicture truth =
      path_trace(tracer, seeded, {.samples = std::uint32_t(paths), .noise = 0}, nullptr);
  double squares = 0, variance = 0, luminance = 0, pixels = 0;
  for (std::size_t p = 0; p < cut.optical_depth.size(); ++p) {
    if (!request.planet && cut.optical_depth[p] <= float(kShownOpticalDepth)) continue;
    const double own = pixel_luminance(truth.image, p), apart = pixel_luminance(cut, p) - own;
    const double noise = double(truth.standard_error[p]) * double(truth.standard_error[p]);
    squares += apart * apart - noise;
    variance += noise * (4 * apart * apart - 2 * noise);
    luminance += own;
    ++pixels;
  }
  std::printf("measured: the truth's square is known to %.2f of it\n",
              std::sqrt(std::max(variance, 0.0)) / squares);
  EXPECT_GT(squares, 0);
  EXPECT_LT(std::sqrt(std::max(variance, 0.0)), 0.7 * squares) << "the truth is noise";
  return std::sqrt(std::max(squares, 0.0) * pixels) / luminance;
}

void expect_within_three(const std::string& scene, const char* term, double estimate,
                         double measured) {
  std::printf("measured: %-16s estimated %.2e, measured %.2e, ratio %.2f\n", term, estimate,
              measured, estimate / measured);
  if (std::max(estimate, measured) < 1e-6) return;  // a float picture holds no less
  const double ratio = estimate / measured;
  report_accuracy("Error line against whole pictures, either way", scene + ", " + term,
                  std::max(ratio, 1 / ratio), 3, "1");
  EXPECT_LT(ratio, 3) << scene << ", " << term;
  EXPECT_GT(ratio, 1 / 3.0) << scene << ", " << term;
}

TEST_P(ErrorScenes, BricksAndStepsAreWithinThreeOfTheWholePicture) {
  const ErrorSceneKind& kind = error_scenes()[GetParam()];
  ErrorScene scene = kind.make();
  RenderRequest& request = scene.request;
  request.settings.probe_paths = 0;
  const RenderResult result = render(request);
  const ErrorEstimate& line = result.error;
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  const HdrImage cut = march_picture(CutLevels(forest), request);
  const FinestLevels finest(request.volumes, 256, &forest, request.planet ? 1 : 3);
  const Counts counts = counts_of(request);
  std::printf("%s: %d probes\n", kind.name.c_str(), line.probe_pixels);
  expect_within_three(kind.name, "integration", line.integration,
                      picture_error(result.image, cut, counts));
  expect_within_three(kind.name, "level of detail", line.level_of_detail,
                      picture_error(cut, march_picture(finest, request), counts));
  expect_within_three(kind.name, "quantisation", line.quantisation,
                      picture_error(march_picture(RecodedLevels(forest), request), cut, counts));
}

// Few pixels, with many paths each.
TEST_P(ErrorScenes, LightModelIsWithinThreeOfPaths) {
  const ErrorSceneKind& kind = error_scenes()[GetParam()];
  ErrorScene scene = kind.make();
  RenderRequest& request = scene.request;
  request.settings.width = 16;
  request.settings.height = 9;
  const ErrorEstimate line = render(request).error;
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  const HdrImage cut = march_picture(CutLevels(forest), request);
  std::printf("%s: %s\n", kind.name.c_str(), line.light_model_basis.c_str());
  expect_within_three(kind.name, "light model", line.light_model,
                      light_model_error(cut, forest, request, kind.paths));
}

INSTANTIATE_TEST_SUITE_P(Kinds, ErrorScenes, ::testing::Range(std::size_t(0), std::size_t(8)),
                         [](const auto& kind) {
                           std::string name = error_scenes()[kind.param].name;
                           std::erase_if(name, [](unsigned char c) { return !std::isalnum(c); });
                           return name;
                         });

}  // namespace
}  // namespace nepho::test
