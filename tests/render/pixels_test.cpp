// Pixels that are interpolated rather than marched: what it changes, and that nothing small is
// lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "dressed_source.h"
#include "gl/front_air.h"
#include "gl/pixel_plan.h"
#include "gl_fixture.h"
#include "planet_scenes.h"
#include "reference/error_metric.h"

namespace nepho::test {
namespace {

using Pixels = GlFixture;

RenderResult pixels_of(RenderRequest request, WhichPixels pixels) {
  request.settings.pixels = pixels;
  return render(request);
}

// "marches of 84.1 % of the pixels: interpolated, predicted to change the picture by less than 0.1
// % rms"
struct Said {
  double interpolated = 0, predicted = -1;
};
Said said(const RenderReport& report) {
  Said said;
  double ground = 0, part = 0, change = 0;
  const char* rest =
      " of %lf %% of the pixels: interpolated, predicted to change the picture by less than %lf";
  for (const std::string& line : report.left_out) {
    if (std::sscanf(line.c_str(), (std::string("marches") + rest).c_str(), &part, &change) == 2)
      said = {part / 100, change / 100};
    if (std::sscanf(line.c_str(), (std::string("the ground's light") + rest).c_str(), &part,
                    &change) == 2)
      ground = change / 100;
  }
  // Both at once.
  if (said.predicted >= 0) said.predicted = std::hypot(said.predicted, ground);
  return said;
}

RenderRequest large(RenderRequest request) {
  request.settings.width = 320;
  request.settings.height = 180;
  request.settings.light = Light::kOctaves;
  return request;
}

// Puffs of some hundred metres in a layer between 1 and 3 km, 24 km wide.
const FieldSource& puffy() {
  static const FieldSource source(
      std::make_shared<BoxChart>(glm::dvec3(-12e3, -12e3, kRadius_m + 1000),
                                 glm::dmat3(24e3, 0., 0., 0., 24e3, 0., 0., 0., 2000.)),
      Lattice({kSplitXy, kSplitXy, kSplitXyz, kSplitXyz}),
      [](glm::dvec3 p) { return 2e-2 * cloud(1.2e-3 * (p - kRadius_m * kUp)); });
  return source;
}
// Systems of a thousand km on a whole planet.
const FieldSource& systems() {
  static const FieldSource source(
      std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 1000, 9000),
      Lattice({kSplitXy, kSplitXy, kSplitXyz}),
      [](glm::dvec3 p) { return 1e-3 * cloud(8 / 6.4e6 * p); });
  return source;
}

void expect_predicted(const char* name, const RenderRequest& request) {
  const RenderResult some = pixels_of(request, WhichPixels::kAdaptive);
  const HdrImage all = pixels_of(request, WhichPixels::kAll).image;
  const Said told = said(some.report);
  const double changed = picture_error(some.image, all, Counts::kAll);
  std::printf("measured: %s: %.1f %% interpolated, predicted %.1e, changed %.1e\n", name,
              100 * told.interpolated, told.predicted, changed);
  report_accuracy("switches", std::string("interpolated pixels: ") + name, changed, told.predicted,
                  "relative rms of luminance");
  EXPECT_GT(told.interpolated, 0.3) << name;
  EXPECT_LE(changed, told.predicted) << name;
  EXPECT_LE(changed, 0.3 * request.settings.tolerance) << name;
}

TEST_F(Pixels, ChangeLessThanPredictedUnderClouds) {
  RenderRequest request = large(planet_request({&puffy()}));
  look(request, 300, 12);
  expect_predicted("under puffs", request);
}

// The eye is above all clouds: the air in front of them is interpolated for the marched pixels too.
TEST_F(Pixels, ChangeLessThanPredictedOverClouds) {
  RenderRequest request = large(planet_request({&puffy()}));
  look(request, 30e3, -35, 40);
  expect_predicted("puffs from 30 km", request);
}

TEST_F(Pixels, ChangeLessThanPredictedOverTerrain) {
  const Slab slab(3000, 5000, 9000, 4e-4);
  const auto map = ridge_map(20000, 2500, 6000, 1000);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  RenderRequest request = large(planet_request({&source}));
  look(request, 9000, -8);
  expect_predicted("ridge under a veil", request);
}

TEST_F(Pixels, ChangeLessThanPredictedFromAfar) {
  RenderRequest request = large(planet_request({&systems()}));
  request.settings.pixels_per_voxel = 1e-3;
  look(request, 4e6, -70, 50);
  expect_predicted("planet from 4000 km", request);
}

// A field of 64 x 64 x 8 cells of 500 m, 1 km above the ground at the pole: 1/m by index of sample.
template <class Extinction>
FieldSource specks_of(Extinction extinction_per_m) {
  const double side_m = 32e3, cell_m = side_m / 64, low_m = kRadius_m + 1000;
  const glm::dvec3 corner(-side_m / 2, -side_m / 2, low_m);
  return FieldSource(std::make_shared<BoxChart>(
                         corner, glm::dmat3(side_m, 0., 0., 0., side_m, 0., 0., 0., side_m / 8)),
                     Lattice({kSplitXy, kSplitXy, kSplitXy, kSplitXyz, kSplitXyz, kSplitXyz}),
                     [=](glm::dvec3 p) -> double {
                       return extinction_per_m(glm::ivec3(glm::round((p - corner) / cell_m)));
                     });
}

// Clouds of one sample, some pixels apart: from each of 300 marched pictures' brightest spots to
// the faintest, none is missing.
TEST_F(Pixels, CloudsOfOneSampleAreAllThere) {
  const FieldSource specks = specks_of([](glm::ivec3 at) {
    return at.x % 7 == 3 && at.y % 9 == 2 && at.z % 3 == 1 && (at.x * at.y) % 5 != 1 ? 1e-3 : 0;
  });
  RenderRequest request = large(planet_request({&specks}));
  look(request, 4e4, -85, 80);
  const RenderResult some = pixels_of(request, WhichPixels::kAdaptive);
  const HdrImage all = pixels_of(request, WhichPixels::kAll).image;
  EXPECT_GT(said(some.report).interpolated, 0.1);
  int spots = 0, lost = 0;
  for (int y = 1; y + 1 < all.height; ++y)
    for (int x = 1; x + 1 < all.width; ++x) {
      const float here = tau_at(all, x, y);
      if (here < 0.02f) continue;
      bool peak = true;
      for (int n = 0; n < 9; ++n) peak = peak && tau_at(all, x + n % 3 - 1, y + n / 3 - 1) <= here;
      if (!peak) continue;
      ++spots;
      lost += tau_at(some.image, x, y) < 0.8f * here;
    }
  std::printf("measured: %d spots of cloud, %d lost; %.1f %% of the pixels interpolated\n", spots,
              lost, 100 * said(some.report).interpolated);
  EXPECT_GT(spots, 60);
  EXPECT_EQ(lost, 0);
}

// Clouds of one sample, behind the eye: their shadows on the sea, each some pixels wide, are all
// there.
TEST_F(Pixels, ShadowsOnGroundAreAllThere) {
  const FieldSource specks = specks_of(
      [](glm::ivec3 at) { return at.x % 7 == 3 && at.y % 9 == 2 && at.z == 2 ? 5e-3 : 0; });
  RenderRequest request = large(planet_request({&specks}));
  look(request, 900, -30, 90);
  const RenderResult some = pixels_of(request, WhichPixels::kAdaptive);
  const HdrImage all = pixels_of(request, WhichPixels::kAll).image;
  int dark = 0, lost = 0;
  for (int y = 4; y + 4 < all.height; ++y)
    for (int x = 4; x + 4 < all.width; ++x) {
      // Darker by a tenth than four pixels away on both sides, along a row.
      const float here = green_at(all, x, y);
      const float beside = std::min(green_at(all, x - 4, y), green_at(all, x + 4, y));
      if (here > 0.9f * beside) continue;
      ++dark;
      lost += green_at(some.image, x, y) > 0.5f * (here + beside);
    }
  std::printf("measured: %d pixels of small shadows, %d lost\n", dark, lost);
  EXPECT_GT(dark, 20);
  EXPECT_EQ(lost, 0);
}

// The sun's disc through a veil, and the sea's horizon: no pixel of them changes.
TEST_F(Pixels, SunAndHorizonStaySharp) {
  const Slab veil(3000, 5000, 60e3, 1e-4);
  RenderRequest request = large(planet_request({&veil.source}));
  request.sun.to_sun = sun_at(5);
  look(request, 1000, 1, 16);
  const RenderResult some = pixels_of(request, WhichPixels::kAdaptive);
  const HdrImage all = pixels_of(request, WhichPixels::kAll).image;
  EXPECT_GT(said(some.report).interpolated, 0.3);
  double worst = 0;
  float brightest = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      const float here = green_at(all, x, y);
      brightest = std::max(brightest, here);
      worst = std::max(worst, std::abs(double(green_at(some.image, x, y) / here - 1)));
    }
  std::printf("measured: sun and horizon: worst pixel changed by %.1e\n", worst);
  report_accuracy("switches", "interpolated pixels: sun and horizon, worst pixel", worst, 0.02,
                  "relative");
  EXPECT_GT(brightest, 100.0f) << "the disc is in the picture";
  EXPECT_LE(worst, 0.02);
}

TEST_F(Pixels, AllAreMarchedWhereThatIsAskedFor) {
  RenderRequest request = large(planet_request({&puffy()}));
  look(request, 300, 12);
  request.settings.width = request.settings.height = 64;
  EXPECT_GT(said(render(request).report).interpolated, 0);
  request.settings.step_voxels = 2;
  EXPECT_LT(said(render(request).report).predicted, 0);
  request.settings.step_voxels = 0;
  EXPECT_LT(said(render(request).report).predicted, 0);
  request.settings.step_voxels.reset();
  request.leave_nothing_out = true;
  EXPECT_LT(said(render(request).report).predicted, 0);
  request.leave_nothing_out = false;
  request.settings.width = 16;
  EXPECT_LT(said(render(request).report).predicted, 0) << "too small";
}

// Rays of a formula: the cubics are right where it is smooth, and refused at an edge and around a
// miss.
TEST(FrontAir, IsInterpolatedWhereItIsSmooth) {
  const int width = 100, height = 61;
  gl::FrontAir front(width, height, 1e-2);
  const auto value = [](double x, double y) {
    return 1 + 0.3 * std::sin(x / 60) * std::cos(y / 50) + (x > 60.5 ? 0.2 : 0);
  };
  gl::PixelValues found;
  for (const auto [x, y] : front.places()) {
    const auto v = float(value(x, y));
    found.seen.push_back({v, v, v, x == 16 && y == 16 ? gl::FrontAir::kMissed : 0});
    found.met.push_back({0.5f * v, 0.5f * v, 0.5f * v, 0});
  }
  front.set(found);
  int known = 0;
  double worst = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      gl::FrontAir::Air air;
      if (!front.at(std::uint32_t(y * width + x), air)) continue;
      ++known;
      worst = std::max({worst, std::abs(double(air.radiance[1]) - value(x, y)),
                        std::abs(2 * double(air.transmittance[2]) - value(x, y))});
      EXPECT_TRUE(x < 48 || x >= 72) << x << ' ' << y << ": no edge";
      EXPECT_FALSE(std::abs(x - 15.5) < 8 && std::abs(y - 15.5) < 8) << "no miss";
    }
  std::printf("measured: front air: %d of %d pixels, worst %.1e\n", known, width * height, worst);
  EXPECT_GT(known, width * height / 3);
  EXPECT_LE(worst, 1e-4);
}

// The plan alone, on a formula: smooth but for an edge. Each pixel has its value, once.
TEST(PixelPlan, FollowsAnEdgeThroughASmoothPicture) {
  const int width = 203, height = 117;
  const auto truth = [&](std::uint32_t p) {
    const double x = p % width, y = p / width;
    const bool inside = std::hypot(x - 90, y - 50) < 30.3;
    return float(1 + 0.3 * std::sin(x / 40) * std::cos(y / 50) + (inside ? 0.5 : 0));
  };
  gl::PixelValues values;
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  values.met.assign(pixels, {1, 1, 1, 5000});
  values.seen.resize(pixels);
  const std::size_t tiles = std::size_t((width + 7) / 8) * std::size_t((height + 7) / 8);
  gl::PixelPlan plan({width,
                      height,
                      1e-2,
                      {std::vector<std::uint8_t>(tiles, 8), std::vector<std::uint8_t>(tiles, 8)}},
                     values);
  EXPECT_FALSE(plan.saves_little());
  std::vector<int> marched(pixels, 0);
  gl::PixelValues found;
  for (auto list = plan.next(found, values); !list.empty(); list = plan.next(found, values)) {
    found = {};
    for (const std::uint32_t p : list) {
      ++marched[p];
      const float v = truth(p);
      found.seen.push_back({v, v, v, 0});
      found.met.push_back({0.5f * v, 0.5f * v, 0.5f * v, 5000});
    }
  }
  double worst = 0, squares = 0, sum = 0;
  for (std::uint32_t p = 0; p < pixels; ++p) {
    EXPECT_LE(marched[p], 1);
    const double off = double(values.seen[p][0] - truth(p));
    worst = std::max(worst, std::abs(off));
    squares += off * off;
    sum += double(truth(p));
    EXPECT_NEAR(values.met[p][1], 0.5 * double(truth(p)), 0.02);
    EXPECT_EQ(values.met[p][3], 5000);
  }
  const double rms = std::sqrt(squares / double(pixels)) / (sum / double(pixels));
  std::printf("measured: plan alone: %.1f %% marched, rms %.1e, predicted %.1e, worst %.1e\n",
              100 * plan.marched_share(), rms, plan.predicted_rms(), worst);
  EXPECT_NEAR(plan.marched_share(), double(std::ranges::count(marched, 1)) / double(pixels), 1e-9);
  EXPECT_LT(plan.marched_share(), 0.25);
  EXPECT_GT(plan.checks(), 20u);
  EXPECT_LE(worst, 0.02);
}

}  // namespace
}  // namespace nepho::test
