#include "bench/sweep.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace nepho::bench {
namespace {

std::string refusal(const auto& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
std::string refusal_of(const std::string& text) {
  return refusal([&] { parse_axis(text); });
}
std::string refusal_of(std::vector<Axis> axes) {
  return refusal([&] { combinations(axes); });
}

TEST(Sweep, values_are_kept_as_written) {
  const Axis axis = parse_axis("step=0.25,1,2e0,0");
  EXPECT_EQ(axis.name, "step");
  EXPECT_EQ(axis.values, (std::vector<std::string>{"0.25", "1", "2e0", "0"}));
  EXPECT_EQ(parse_axis("fetch=filter,texels8").values.size(), 2u);
}

TEST(Sweep, unknown_settings_are_refused_with_those_that_there_are) {
  for (const char* text : {"steps=1", "engine=march", "=1", "", "1,2"}) {
    const std::string words = refusal_of(text);
    EXPECT_NE(words.find("no such setting"), std::string::npos) << text << ": " << words;
    for (const char* known : {"step (voxels)", "tolerance", "budget-mib (MiB)", "max-level",
                              "octaves", "light", "fetch", "pixels"})
      EXPECT_NE(words.find(known), std::string::npos) << text << ": " << words;
  }
}

TEST(Sweep, empty_ranges_and_bad_values_are_refused) {
  EXPECT_NE(refusal_of("step=").find("an empty range"), std::string::npos);
  EXPECT_NE(refusal_of("step").find("an empty range"), std::string::npos);
  EXPECT_NE(refusal_of("step=1,,2").find("a value is missing"), std::string::npos);
  EXPECT_NE(refusal_of("step=1,").find("a value is missing"), std::string::npos);
  EXPECT_NE(refusal_of("step=1,2,1.0").find("a value twice"), std::string::npos);
  EXPECT_NE(refusal_of("step=-1").find("0 to 1024"), std::string::npos);
  EXPECT_NE(refusal_of("step=nan").find("a number"), std::string::npos);
  EXPECT_NE(refusal_of("tolerance=2").find("1e-06 to 1"), std::string::npos);
  EXPECT_NE(refusal_of("octaves=1.5").find("a whole number"), std::string::npos);
  EXPECT_NE(refusal_of("light=bright").find("single or octaves"), std::string::npos);
}

TEST(Sweep, combinations_are_the_product_with_the_last_axis_fastest) {
  const std::vector<Axis> axes{parse_axis("step=1,2"), parse_axis("budget-mib=8,16,32")};
  const std::vector<Setting> all = combinations(axes);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].label(), "step 1, budget-mib 8");
  EXPECT_EQ(all[1].label(), "step 1, budget-mib 16");
  EXPECT_EQ(all[5].label(), "step 2, budget-mib 32");
  EXPECT_EQ(all[4].number("budget-mib"), 16.0);
  EXPECT_FALSE(all[4].number("tolerance"));
  ASSERT_EQ(combinations({}).size(), 1u);
  EXPECT_EQ(combinations({})[0].label(), "as the scene says");
}

TEST(Sweep, what_excludes_each_other_is_refused) {
  const Axis step = parse_axis("step=1"), tolerance = parse_axis("tolerance=0.1");
  EXPECT_NE(refusal_of({step, tolerance}).find("exclude each other"), std::string::npos);
  EXPECT_NE(refusal_of({step, step}).find("swept twice"), std::string::npos);
  EXPECT_NE(refusal_of({parse_axis("light=single"), parse_axis("octaves=2")}).find("octaves"),
            std::string::npos);
  Axis many = step;
  many.values.assign(kMostSettings + 1, "1");
  EXPECT_NE(refusal_of({many}).find("too many settings"), std::string::npos);
}

TEST(Sweep, each_setting_reaches_the_render) {
  RenderSettings settings;
  settings.step_voxels = 3;
  for (const char* text : {"budget-mib=12", "pixels-per-voxel=0.5", "max-level=4", "octaves=3",
                           "fetch=texels8", "pixels=all"})
    lay_over(combinations(std::vector{parse_axis(text)})[0], settings);
  EXPECT_EQ(settings.budget_mib, 12);
  EXPECT_EQ(settings.pixels_per_voxel, 0.5);
  EXPECT_EQ(settings.max_level, 4);
  EXPECT_EQ(settings.octaves, 3);
  EXPECT_EQ(settings.fetch, Fetch::kTexels8);
  EXPECT_EQ(settings.pixels, WhichPixels::kAll);
  EXPECT_EQ(settings.step_voxels, 3);
  lay_over(combinations(std::vector{parse_axis("tolerance=0.03")})[0], settings);
  EXPECT_FALSE(settings.step_voxels);
  EXPECT_EQ(settings.tolerance, 0.03);
  lay_over(combinations(std::vector{parse_axis("step=0.5")})[0], settings);
  EXPECT_EQ(settings.step_voxels, 0.5);
  lay_over(combinations(std::vector{parse_axis("light=single")})[0], settings);
  EXPECT_EQ(settings.light, Light::kSingle);
}

}  // namespace
}  // namespace nepho::bench
