// What the source is asked for, and what it refuses.

#include <gtest/gtest.h>

#include "core/error.h"
#include "open_noise.h"

namespace nepho::test {
namespace {

std::string refusal(const std::vector<Given>& given) {
  try {
    open_noise(given);
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(NoiseOptions, DefaultSkyHasOneLayerOfEachType) {
  const noise::Planet planet = noise_planet({});
  ASSERT_EQ(planet.layers.size(), 4u);
  EXPECT_TRUE(planet.info.on_planet);
  EXPECT_EQ(planet.info.facts.size(), 4u);
  EXPECT_FALSE(planet.info.assumptions.empty());
}

TEST(NoiseOptions, OneEndMovesTheLayer) {
  const noise::LayerSpec low = noise_planet(one_layer("stratus", {{"layer1.base_m", 100}})).layers[0];
  EXPECT_EQ(low.base_m, 100);
  EXPECT_EQ(low.top_m, 500);
  const noise::LayerSpec high = noise_planet(one_layer("cirrus", {{"layer1.top_m", 12000}})).layers[0];
  EXPECT_EQ(high.top_m, 12000);
  EXPECT_EQ(high.base_m, 10200);
}

TEST(NoiseOptions, VoxelsAreAsFineAsAskedFor) {
  for (const double finest_m : {30.0, 100.0, 2000.0}) {
    const noise::Planet planet = noise_planet({{"finest_resolution_m", finest_m}});
    const Index3& cells = planet.info.lattice.cells(planet.info.lattice.max_level());
    const double width_m = 1.5707963267948966 * planet.chart->body().equatorial_m / cells[0];
    EXPECT_LE(width_m, finest_m);
    EXPECT_GT(width_m, finest_m / 2);
    EXPECT_LE(planet.chart->thickness_m() / cells[2], std::max(finest_m, 1250.0));
  }
}

TEST(NoiseOptions, RefusesWhatItDoesNotKnow) {
  const auto says = [](const std::vector<Given>& given, const char* what) {
    const std::string said = refusal(given);
    EXPECT_NE(said.find(what), said.npos) << said;
  };
  says({{"wether", 0.5}}, "weather");
  says({{"layer1.colour", 1}}, "layer1.colour");
  says({{"layer9.type", 0, "cumulus"}}, "layer9.type");
  says(one_layer("nimbus"), "cumulus");
  says(one_layer("cumulus", {{"layer1.coverage", 1.2}}), "layer1.coverage");
  says(one_layer("cumulus", {{"layer1.coverage", std::nan("")}}), "layer1.coverage");
  says(one_layer("cumulus", {{"layer1.base_m", 0, "high"}}), "layer1.base_m");
  says(one_layer("cumulus", {{"layer1.base_m", 3000}, {"layer1.top_m", 2000}}), "base is above");
  says(one_layer("cumulus", {{"layer1.base_m", -50}}), "layer1.base_m");
  says(one_layer("cumulus", {{"layer1.scale_m", 1}}), "layer1.scale_m");
  says({{"finest_resolution_m", 0.5}}, "finest_resolution_m");
  says({{"finest_resolution_m", -1}}, "finest_resolution_m");
  says({{"seed", 1.5}}, "seed");
  says({{"weather", 0, "fine"}}, "weather");
}

TEST(NoiseOptions, ReadsNoFiles) {
  const char* file = "clouds.nc";
  SourceRequest request{};
  request.volume_name = "sky", request.files = &file, request.file_count = 1;
  EXPECT_THROW(noise::open_source(request), Error);
}

}  // namespace
}  // namespace nepho::test
