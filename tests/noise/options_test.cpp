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
  const noise::LayerSpec low =
      noise_planet(one_layer("stratus", {{"layer1.base_m", 100}})).layers[0];
  EXPECT_EQ(low.base_m, 100);
  EXPECT_EQ(low.top_m, 500);
  const noise::LayerSpec high =
      noise_planet(one_layer("cirrus", {{"layer1.top_m", 12000}})).layers[0];
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

TEST(NoiseOptions, LandIsItsPartOfThePlanet) {
  EXPECT_EQ(noise_planet({{"land", 0}}).info.surface, nullptr);
  for (const double land : {0.1, 0.3, 0.8, 1.0}) {
    const auto map = noise_planet({{"land", land}}).info.surface;
    ASSERT_NE(map, nullptr);
    ASSERT_EQ(map->water.size(), std::size_t(map->nx) * std::size_t(map->ny));
    ASSERT_EQ(map->height_m.size(), map->water.size());
    EXPECT_NEAR(map->nx * map->step_rad.x, 6.283185307179586, 1e-12);
    double dry = 0, all = 0, blurred = 0;
    for (std::size_t at = 0; at < map->water.size(); ++at) {
      const double area =
          std::cos(map->low_rad.y + double(at / std::size_t(map->nx)) * map->step_rad.y);
      dry += area * (1 - double(map->water[at])), all += area;
      blurred += area * (map->water[at] > 0.01F && map->water[at] < 0.99F);
    }
    EXPECT_NEAR(dry / all, land, 0.01);
    EXPECT_LT(blurred / all, 0.05);
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
  says({{"land", 2}}, "land");
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
