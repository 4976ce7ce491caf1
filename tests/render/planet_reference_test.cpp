// The renderer against the reference march where there is a planet or ice, and the error line
// there.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "dressed_source.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "planet_quadrature.h"
#include "random.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"
#include "reference/probe.h"

namespace nepho::test {
namespace {

using PlanetReference = GlFixture;

constexpr const char* kSection = "Renderer against the reference march, planets and ice";

HdrImage exact_picture(const RenderRequest& request) {
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  return march_picture(CutLevels(forest), request);
}

// Decks of optical depth 0.5 and 20.
constexpr double kHighDeck_per_m = 1e-3, kLowDeck_per_m = 0.02;

double worst_pixel(const HdrImage& picture, const HdrImage& truth) {
  double worst = 0, brightest = 0;
  const std::size_t pixels = truth.optical_depth.size();
  for (std::size_t p = 0; p < pixels; ++p)
    brightest = std::max(brightest, pixel_luminance(truth, p));
  for (std::size_t p = 0; p < pixels; ++p) {
    const double own = pixel_luminance(truth, p);
    worst = std::max(worst,
                     std::abs(pixel_luminance(picture, p) - own) / std::max(own, 1e-4 * brightest));
  }
  return worst;
}

TEST_F(PlanetReference, ClearSky) {
  struct View {
    double height_m, pitch_deg;
  };
  double worst = 0;
  for (const View& view : {View{2, 10}, View{12e3, -5}, View{1e6, -38}})
    for (const double elevation_deg : {60.0, 10.0, -4.0}) {
      RenderRequest request = planet_request({});
      request.sun.to_sun = sun_at(elevation_deg, 70);
      look(request, view.height_m, view.pitch_deg);
      const HdrImage image = render(request).image, truth = exact_picture(request);
      const double error = picture_error(image, truth, Counts::kAll);
      std::printf("measured: clear sky from %g m, sun at %g degrees: rms %.1e, worst pixel %.1e\n",
                  view.height_m, elevation_deg, error, worst_pixel(image, truth));
      worst = std::max(worst, error);
    }
  report_accuracy(kSection, "clear sky, 2 m to 1000 km, sun 60 to -4 degrees", worst, 0.01,
                  "relative rms of luminance");
  EXPECT_LE(worst, 0.01);
}

// The march's own steps, without the GPU: against the same equations in 20000 of them.
TEST(PlanetMarch, AirInTheShadowOfADeckAgreesWithQuadrature) {
  const ShadedDeck deck(16, 6);
  const RenderRequest& request = deck.request;
  const Quadrature &truth = *deck.truth, &unshaded = *deck.unshaded;
  const FinestLevels levels(request.volumes, 16);
  const RayMarch march(levels, request);
  double worst = 0, shade = 1;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 16; ++x) {
      const glm::dvec3 d = pixel_direction(request, x, y);
      const double expected = truth.radiance(d).g;
      const MarchResult got = march.trace({request.camera.eye_m, d});
      ASSERT_EQ(got.optical_depth, 0);
      worst = std::max(worst, std::abs(got.radiance_W_per_m2_sr_nm.g / expected - 1));
      shade = std::min(shade, expected / unshaded.radiance(d).g);
    }
  std::printf("measured: the shadow takes %.0f %% of this air's light\n", 100 * (1 - shade));
  report_accuracy(kSection, "march of shadowed air against quadrature: worst pixel", worst, 3e-3,
                  "1");
  EXPECT_LE(worst, 3e-3);
  EXPECT_LT(shade, 0.9);
}

// A thick box of cloud over the sea, in the picture: pixels of air and sea alone, in its shadow and
// beside it. (The cloud's own light is interpolated between voxels; that is the next test's.)
TEST_F(PlanetReference, ACloudsShadowsOnSeaAndAir) {
  const Slab slab(2000, 3500, 3000, 0.01);
  for (const double height_m : {2.0, 12e3}) {
    RenderRequest request = planet_request({&slab.source});
    request.settings.width = 40;
    request.settings.height = 30;
    request.sun.to_sun = sun_at(35, 60);
    look(request, height_m, height_m > 100 ? -85 : 25, 70);
    const HdrImage image = render(request).image, truth = exact_picture(request);
    std::vector<PixelPair> clear;
    double darkest = 1e9, brightest = 0;
    for (std::size_t p = 0; p < truth.optical_depth.size(); ++p) {
      if (truth.optical_depth[p] > 0) continue;
      clear.push_back({pixel_luminance(image, p), pixel_luminance(truth, p)});
      darkest = std::min(darkest, clear.back().reference);
      brightest = std::max(brightest, clear.back().reference);
    }
    const double error = relative_rms(clear);
    std::printf("measured: %zu pixels beside the cloud, luminance %.3f to %.3f\n", clear.size(),
                darkest, brightest);
    report_accuracy(kSection,
                    height_m > 100 ? "sea in a cloud's shadow, from 12 km"
                                   : "air beside a cloud, from the ground",
                    error, 0.005, "relative rms of luminance");
    EXPECT_LE(error, 0.005) << height_m;
    EXPECT_GT(clear.size(), 500u);
  }
}

TEST_F(PlanetReference, ACloudInTheAirOverTheSea) {
  const glm::dvec3 middle = (kRadius_m + 2500) * kUp;
  const FieldSource ball(
      std::make_shared<BoxChart>(middle - glm::dvec3(1000), glm::dmat3(2000.0)), isotropic(3),
      [&](glm::dvec3 p) { return 0.004 * std::max(0.0, 1 - glm::length(p - middle) / 900); });
  RenderRequest request = planet_request({&ball});
  request.settings.light = Light::kOctaves;
  request.settings.step_voxels = 0;
  request.sun.to_sun = sun_at(15, 60);
  for (const bool far : {false, true}) {
    look(request, 2500, 0, far ? 2.0 : 40);
    request.camera.eye_m -= (far ? 60e3 : 3e3) * kNorth;
    request.camera.target_m = middle;
    const HdrImage image = render(request).image, truth = exact_picture(request);
    const double error = picture_error(image, truth, Counts::kAll);
    report_accuracy(kSection, far ? "ball of cloud behind 60 km of air" : "ball of cloud from 3 km",
                    error, 0.01, "relative rms of luminance");
    EXPECT_LE(error, 0.01) << far;
    EXPECT_GT(std::ranges::max(truth.optical_depth), 1);
  }
}

TEST_F(PlanetReference, CloudsShadowTheAir) {
  const ShadedDeck deck(32, 8);
  const RenderRequest& request = deck.request;
  const HdrImage image = render(request).image, truth = exact_picture(request);
  const double error = picture_error(image, truth, Counts::kAll);
  report_accuracy(kSection, "air in the shadow of a deck", error, 0.02,
                  "relative rms of luminance");
  EXPECT_LE(error, 0.02);
}

// Air with cloud above and below it, seen from the middle of the gap. The sun map holds what is in
// one band of heights as one cloud.
struct TwoDecks {
  Slab high, low;
  double march_error = 0, map_error = 0;  // worst pixel; rms
};
void measure(TwoDecks& decks, std::initializer_list<const BrickSource*> others = {}) {
  const Slab &high = decks.high, &low = decks.low;
  RenderRequest request = planet_request({&high.source, &low.source});
  for (const BrickSource* other : others) request.volumes.push_back({.source = other, .phase = {}});
  request.settings.width = 16;
  request.settings.height = 4;
  request.sun.to_sun = sun_at(40, 120);
  look(request, 0.5 * (high.low_m + low.high_m), 0, 3);
  request.camera.eye_m -= 10e3 * kNorth;
  request.camera.target_m -= 10e3 * kNorth;
  const HdrImage image = render(request).image, march = exact_picture(request);
  Quadrature truth(request);
  truth.steps = 20000;
  truth.lit = [&](const glm::dvec3& p) {
    const glm::dvec3 sun = request.sun.to_sun;
    return std::exp(-kHighDeck_per_m * high.shade_m(p, sun) - kLowDeck_per_m * low.shade_m(p, sun));
  };
  int clear = 0;
  std::vector<PixelPair> pairs;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 16; ++x) {
      if (tau_at(march, x, y) > 0) continue;
      ++clear;
      const double expected = truth.radiance(pixel_direction(request, x, y)).g;
      decks.march_error =
          std::max(decks.march_error, std::abs(green_at(march, x, y) / expected - 1));
      pairs.push_back({green_at(image, x, y), expected});
    }
  EXPECT_GT(clear, 40);
  decks.map_error = relative_rms(pairs);
}

TEST_F(PlanetReference, AirBetweenTwoDecks) {
  TwoDecks decks{{9000, 9500, 30e3, kHighDeck_per_m}, {1500, 2500, 30e3, kLowDeck_per_m}};
  measure(decks);
  report_accuracy(kSection, "march of air between two decks against quadrature: worst pixel",
                  decks.march_error, 3e-3, "1");
  EXPECT_LE(decks.march_error, 3e-3);
  report_accuracy(kSection, "sun map: air between two decks", decks.map_error, 0.01,
                  "relative rms of green");
  EXPECT_LE(decks.map_error, 0.01);
}

// The worst that a band can hold: two decks 2 km apart, as there is cirrus far above.
TEST_F(PlanetReference, AirBetweenTwoDecksOfOneBand) {
  TwoDecks decks{{4300, 4600, 30e3, kHighDeck_per_m}, {1500, 2500, 30e3, kLowDeck_per_m}};
  const Slab cirrus(13e3, 14e3, 30e3, 1e-9);
  measure(decks, {&cirrus.source});
  report_accuracy(kSection, "sun map: air between two decks of one band", decks.map_error, 0.04,
                  "relative rms of green");
  EXPECT_LE(decks.map_error, 0.04);
}

// Under the terrain, under the ellipsoid, in the cloud, on its face, far away; the sun overhead.
TEST(PlanetMarch, AnEyeInPlacesThatAreNoneSeesFiniteLight) {
  const Slab slab(1000, 2000, 5000, 0.02);
  const auto map = ridge_map(0, 800, 5e3, 250);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  for (const double height_m : {400.0, -30.0, 1500.0, 1000.0, 1e9}) {
    RenderRequest request = planet_request({&source});
    request.settings.width = 8;
    request.settings.height = 6;
    look(request, height_m, height_m > 1e6 ? -90 : 20, height_m > 1e6 ? 0.8 : 80);
    for (const double elevation_deg : {90.0, 0.0, -18.0}) {
      request.sun.to_sun = sun_at(elevation_deg);
      const HdrImage image = march_picture(FinestLevels(request.volumes, 16), request);
      EXPECT_TRUE(
          std::ranges::all_of(image.rgb, [](float v) { return std::isfinite(v) && v >= 0; }))
          << height_m << ' ' << elevation_deg;
    }
  }
}

TEST_F(PlanetReference, TerrainInTheSunAndInItsOwnShadow) {
  const Slab slab(15e3, 16e3, 100, 1e-9);
  const auto map = ridge_map(20e3, 1800, 5e3, 250);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  RenderRequest request = planet_request({&source});
  request.settings.width = 16;
  request.settings.height = 60;
  for (const double azimuth_deg : {180.0, 0.0}) {
    request.sun.to_sun = sun_at(12, azimuth_deg);
    look(request, 4000, -8, 30);
    const HdrImage image = render(request).image, truth = exact_picture(request);
    const double error = picture_error(image, truth, Counts::kAll);
    std::printf("measured: worst pixel %.1e\n", worst_pixel(image, truth));
    report_accuracy(kSection, "a ridge of 1800 m under air", error, 0.02,
                    "relative rms of luminance");
    EXPECT_LE(error, 0.02) << azimuth_deg;
  }
}

TEST_F(PlanetReference, IceScattersAsIce) {
  const FieldSource plain(box(1000, 1000), isotropic(3), [](glm::dvec3 p) {
    return 0.004 * std::max(0.0, 1 - glm::length(p - glm::dvec3(0, 0, 500)) / 450);
  });
  const auto dressed = [&](double part) {
    return DressedSource(
        plain,
        [](VolumeInfo& info) {
          info.channels.push_back({.channel = Channel::kIceExtinction, .name = "ice"});
        },
        part);
  };
  const auto request_for = [&](const BrickSource& source) {
    RenderRequest request = request_of({&source});
    request.volumes[0].phase = {};
    request.settings.light = Light::kOctaves;
    request.settings.step_voxels = 0;
    request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, 0.5, 0.3));
    request.camera = {{0, -1800, 600}, {0, 0, 500}, {0, 0, 1}, 0.7};
    return request;
  };
  const DressedSource half = dressed(0.5), none = dressed(0);
  const RenderRequest request = request_for(half);
  const HdrImage truth = exact_picture(request);
  const double error = picture_error(render(request).image, truth);
  report_accuracy(kSection, "half water, half ice", error, 0.02, "relative rms of luminance");
  EXPECT_LE(error, 0.02);
  const double apart = picture_error(exact_picture(request_for(none)), truth);
  std::printf("measured: the same without ice: %.2f away\n", apart);
  EXPECT_GT(apart, 0.05);
}

// A constant node tells nothing of its ice: the finest levels must read its brick, as a cut does.
TEST_F(PlanetReference, AConstantVolumeKeepsItsIce) {
  const FieldSource plain(box(1000, 1000), isotropic(2), [](glm::dvec3) { return 5e-4; });
  const DressedSource half(
      plain,
      [](VolumeInfo& info) {
        info.channels.push_back({.channel = Channel::kIceExtinction, .name = "ice"});
      },
      0.5);
  RenderRequest request = request_of({&half});
  request.volumes[0].phase = {};
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, 0.5, 0.3));
  request.camera = {{0, -1800, 600}, {0, 0, 500}, {0, 0, 1}, 0.7};
  const HdrImage cut = exact_picture(request);
  const HdrImage finest = march_picture(FinestLevels(request.volumes, 16), request);
  request.volumes[0].source = &plain;
  const double apart =
      picture_error(march_picture(FinestLevels(request.volumes, 16), request), cut);
  std::printf("measured: finest levels against the cut %.1e, water alone %.2f\n",
              picture_error(finest, cut), apart);
  EXPECT_LE(picture_error(finest, cut), 1e-5);
  EXPECT_GT(apart, 0.05);
}

void expect_within_three(const char* term, double estimate, double measured) {
  std::printf("measured: %-16s estimated %.2e, measured %.2e, ratio %.2f\n", term, estimate,
              measured, estimate / measured);
  if (std::max(estimate, measured) < 1e-6) return;  // a float picture holds no less
  EXPECT_LT(estimate, 3 * measured) << term;
  EXPECT_GT(estimate, measured / 3) << term;
}

void expect_error_line(const char* name, RenderRequest request) {
  request.settings.light = Light::kOctaves;
  request.settings.width = 40;
  request.settings.height = 24;
  request.settings.probe_pixels = 96;
  const RenderResult result = render(request);
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  const HdrImage cut = march_picture(CutLevels(forest), request);
  const HdrImage finest = march_picture(FinestLevels(request.volumes, 64), request);
  std::printf("%s: %d probes\n", name, result.error.probe_pixels);
  EXPECT_GE(result.error.probe_pixels, 64) << "fewer only where they are seen to be enough";
  EXPECT_LE(result.error.probe_pixels, 96);
  expect_within_three("integration", result.error.integration,
                      picture_error(result.image, cut, Counts::kAll));
  expect_within_three("level of detail", result.error.level_of_detail,
                      picture_error(cut, finest, Counts::kAll));
  EXPECT_GE(result.error.quantisation, 0);
  EXPECT_LE(result.error.quantisation, 1e-3);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const ErrorEstimate again = estimate_error(request, forest, result.image);
  EXPECT_EQ(again.integration, result.error.integration);
  EXPECT_EQ(again.level_of_detail, result.error.level_of_detail);
  EXPECT_EQ(again.quantisation, result.error.quantisation);
}

TEST_F(PlanetReference, TheErrorLineHoldsOverGround) {
  const double size_m = 8000;
  const FieldSource clouds(
      std::make_shared<BoxChart>(glm::dvec3(-0.5 * size_m, -0.5 * size_m, kRadius_m + 1000),
                                 glm::dmat3(size_m, 0., 0., 0., size_m, 0., 0., 0., 3000)),
      isotropic(3), [&](glm::dvec3 p) {
        return 1.5 * cloud(5.0 / size_m * (p - glm::dvec3(0, 0, kRadius_m - 2500)));
      });
  RenderRequest request = planet_request({&clouds});
  request.settings.budget_mib = 2;
  request.sun.to_sun = sun_at(30, 200);
  look(request, 6000, -20, 50);
  request.camera.eye_m -= 10e3 * kNorth;
  request.camera.target_m -= 10e3 * kNorth;
  expect_error_line("boxes over the sea", request);
}

TEST_F(PlanetReference, TheErrorLineHoldsOnAShell) {
  const FieldSource clouds(std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 1000, 17000),
                           Lattice({kSplitXy, kSplitXy, kSplitXyz}),
                           [](glm::dvec3 p) { return 2e-3 * cloud(10 / 6.4e6 * p); });
  RenderRequest request = planet_request({&clouds});
  request.settings.budget_mib = 0.6;
  request.sun.to_sun = sun_at(40, 100);
  look(request, 1.2e6, -70, 45);
  expect_error_line("a shell from 1200 km", request);
}

}  // namespace
}  // namespace nepho::test
