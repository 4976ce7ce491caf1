// Which settings a target of error or of time gets, on models of what settings cost and miss.
#include "cli/target_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random.h"

namespace nepho {
namespace {

// Errors that fall with a power of the tolerance towards a floor of the voxels, and with memory
// until the data end; times that grow with both.
struct Model {
  double steps, order, light, detail, data_mib, tree_ms, view_ms;

  static Model drawn(test::Random& random) {
    return {random.log_uniform(0.01, 0.5), random.uniform(0.4, 1.2),
            random.log_uniform(1e-4, 0.1), random.log_uniform(0.01, 1),
            random.log_uniform(2, 400),    random.log_uniform(1, 100),
            random.log_uniform(1, 100)};
  }
  TargetMeasure operator()(const TargetSetting& s) const {
    const double mib = std::min(s.budget_mib, data_mib / std::pow(s.pixels_per_voxel, 2));
    const double voxels = std::cbrt(1 / mib);
    return {.setting = s,
            .integration = std::hypot(steps * std::pow(s.tolerance, order), light * voxels),
            .level_of_detail = s.budget_mib < data_mib * 4 ? detail * voxels * voxels : 0,
            .quantisation = 1e-5,
            .frame_ms = tree_ms * mib + view_ms / std::sqrt(s.tolerance),
            .budget_bound = s.budget_mib < data_mib / std::pow(s.pixels_per_voxel, 2)};
  }
};

bool finer(const TargetSetting& next, const TargetSetting& last) {
  return next != last && next.tolerance <= last.tolerance && next.budget_mib >= last.budget_mib &&
         next.pixels_per_voxel <= last.pixels_per_voxel;
}

TEST(TargetSearch, takes_the_first_setting_below_the_target) {
  test::Random random;
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Model model = Model::drawn(random);
    const double target = random.log_uniform(2e-3, 0.3);
    const TargetChoice choice = search_error(target, {}, model);
    for (std::size_t n = 0; n + 1 < choice.tried.size(); ++n) {
      EXPECT_GT(choice.tried[n].error(), kErrorMargin * target);
      EXPECT_TRUE(finer(choice.tried[n + 1].setting, choice.tried[n].setting)) << n;
    }
    if (choice.met) {
      ++met;
      EXPECT_EQ(choice.chosen + 1, choice.tried.size());
      EXPECT_LE(choice.best().error(), kErrorMargin * target);
    } else {
      for (const TargetMeasure& one : choice.tried) EXPECT_LE(choice.best().error(), one.error());
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_LT(met, 290) << "the models reach everything";
}

TEST(TargetSearch, more_time_is_never_less_accurate) {
  test::Random random;
  int steps = 0;
  for (int i = 0; i < 300; ++i) {
    const Model model = Model::drawn(random);
    double before = INFINITY;
    for (double target_ms = 0.5; target_ms < 1e6; target_ms *= 1.3) {
      const TargetChoice choice = search_time(target_ms, {}, model);
      EXPECT_EQ(choice.met, choice.best().frame_ms <= target_ms);
      if (!choice.met) {
        EXPECT_EQ(choice.chosen, 0u);
        continue;
      }
      EXPECT_LE(choice.best().error(), before) << target_ms;
      steps += choice.best().error() < before;
      before = choice.best().error();
    }
  }
  EXPECT_GT(steps, 600) << "the models have nothing to choose";
}

// Light between voxels is no matter of the tolerance: a few settings tell, not the whole ladder.
TEST(TargetSearch, ends_where_no_setting_helps) {
  const auto model = [](const TargetSetting& s) {
    return TargetMeasure{.setting = s, .integration = 0.02 + 1e-4 * s.tolerance};
  };
  const TargetChoice choice = search_error(0.01, {}, model);
  EXPECT_FALSE(choice.met);
  EXPECT_LE(choice.tried.size(), 3u);
}

TEST(TargetSearch, more_memory_where_level_of_detail_leads) {
  const TargetMeasure coarse{
      .setting = {0.1, 4, 1}, .integration = 0.01, .level_of_detail = 0.02, .budget_bound = true};
  const TargetSetting next = *next_setting(std::vector{coarse});
  EXPECT_GT(next.budget_mib, 4);
  EXPECT_EQ(next.tolerance, 0.1);
  TargetMeasure unbound = coarse;
  unbound.budget_bound = false;
  EXPECT_LT(next_setting(std::vector{unbound})->pixels_per_voxel, 1);
}

}  // namespace
}  // namespace nepho
