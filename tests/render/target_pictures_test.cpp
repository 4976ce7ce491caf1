// The settings that a target of error gets, against pictures by a converged march: what was asked
// for is obtained.
#include <gtest/gtest.h>

#include <cstdio>

#include "accuracy_report.h"
#include "cli/target_probe.h"
#include "cli/target_search.h"
#include "error_scenes.h"
#include "gl_fixture.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"

namespace nepho::test {
namespace {

class TargetPictures : public GlFixture, public ::testing::WithParamInterface<std::size_t> {};
class ThinTargetPictures : public TargetPictures {};

// Of one picture, over all that the data hold: integration, level of detail and quantisation.
// Returns for how many of the targets the probes said that they are met, with the margin.
int obtain(const ErrorSceneKind& kind, std::initializer_list<double> targets) {
  const ErrorScene scene = kind.make();
  const Counts counts = scene.request.planet ? Counts::kAll : Counts::kWithCloud;
  const HdrImage truth = march_picture(FinestLevels(scene.request.volumes, 256), scene.request);
  TargetProbe probe(scene.request, false);
  const TargetSetting first = probe.first();
  int stated = 0;
  for (const double target : targets) {
    const TargetChoice choice = search_error(
        target, first, [&](const TargetSetting& setting) { return probe.measure(setting); });
    RenderRequest request = scene.request;
    request.settings = with_setting(request.settings, choice.best().setting);
    request.settings.probe_pixels = 0;
    const double error = picture_error(render(request).image, truth, counts);
    const double expected = choice.best().error();
    std::printf(
        "measured: %s, target %g %%: tolerance %.2g, %g MiB, %zu settings, expected %.2e, "
        "obtained %.2e\n",
        kind.name.c_str(), 100 * target, choice.best().setting.tolerance,
        choice.best().setting.budget_mib, choice.tried.size(), expected, error);
    if (choice.met) {
      ++stated;
      report_accuracy("Targets of error: obtained over asked for",
                      kind.name + ", " + report_number(target), error / target, 1, "1");
      EXPECT_LE(error, target) << kind.name;
    } else if (expected > target) {
      EXPECT_GT(error, target / 3) << kind.name << ": said to be out of reach, and is not";
    }
  }
  return stated;
}

TEST_P(ThinTargetPictures, ObtainEachTarget) {
  EXPECT_EQ(obtain(thin_scenes()[GetParam()], {0.1, 0.03, 0.01}), 3);
}

TEST_P(TargetPictures, ObtainWhatIsSaidToBeMet) {
  EXPECT_GE(obtain(error_scenes()[GetParam()], {0.2, 0.1, 0.03, 0.01}), 1);
}

std::string number_of(const ::testing::TestParamInfo<std::size_t>& kind) {
  return "scene" + std::to_string(kind.param);
}
INSTANTIATE_TEST_SUITE_P(Thin, ThinTargetPictures, ::testing::Range(std::size_t(0), std::size_t(4)),
                         number_of);
INSTANTIATE_TEST_SUITE_P(Kinds, TargetPictures, ::testing::Range(std::size_t(0), std::size_t(6)),
                         number_of);

}  // namespace
}  // namespace nepho::test
