// Sun from 1 degree above the horizon to 18 below it, in the renderer's pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "accuracy_report.h"
#include "gl_fixture.h"
#include "planet_quadrature.h"

namespace nepho::test {
namespace {

using PlanetTwilight = GlFixture;

// The equations in double, without the renderer. What darkens fast is the edge of the planet's
// shadow, which climbs a scale height of air in 0.7 degrees of the sun at the zenith. A table too
// coarse would show as changes that do not become smaller with the steps.
TEST(PlanetTwilightEquations, EachDirectionDarkensSmoothly) {
  constexpr double kFine_deg = 0.05;
  RenderRequest request = planet_request({});
  look(request, 2, 90);
  const Quadrature truth(request);
  double fastest = 0, jump = 0;
  for (const double elevation_deg : {90.0, 3.0, 177.0}) {
    const double e = elevation_deg * kPi / 180;
    double before = 0, rate_before = 0;
    for (int step = 0; step * kFine_deg <= 19; ++step) {
      request.sun.to_sun = sun_at(1 - kFine_deg * step);
      const glm::dvec3 rgb = truth.radiance({0, std::cos(e), std::sin(e)});
      const double here = f64::luminance(rgb.r, rgb.g, rgb.b);
      const double rate = std::log10(here / before) * 0.1 / kFine_deg;
      if (step > 0) fastest = std::max(fastest, std::abs(rate));
      if (step > 1) jump = std::max(jump, std::abs(rate - rate_before));
      before = here;
      rate_before = rate;
    }
  }
  report_accuracy("air", "twilight, log10 of luminance per 0.1 degree, three directions, in double",
                  fastest, 0.075, "1");
  report_accuracy("air", "twilight, change of that from one 0.05 degrees to the next, in double",
                  jump, 0.004, "1");
  EXPECT_LE(fastest, 0.075);
  EXPECT_LE(jump, 0.004);
}

TEST_F(PlanetTwilight, TheSkyDarkensWithoutJumps) {
  constexpr double kStep_deg = 0.2;
  constexpr int kSteps = 95;
  RenderRequest request = planet_request({});
  // One column of pixels from horizon to horizon, through the zenith.
  const glm::dvec3 eye(0, 0, kRadius_m + 2);
  request.camera = {eye, eye + glm::dvec3(0, 0, 1e3), glm::dvec3(0, 1, 0), 175 * kPi / 180};
  request.settings.width = 1;
  request.settings.height = 1201;
  request.settings.tolerance = 1e-3;  // spans of air are told apart (tolerance_test.cpp)
  struct View {
    const char* name;
    double elevation_deg;  // over 90: on the side away from the sun
    double before = 0, change_before = 0;
    double fastest = 0, jump = 0;     // per 0.1 degree of the sun
    double true_before = 0, off = 0;  // against quadrature
    std::size_t pixel = 0;
  };
  std::array<View, 3> views{View{"zenith", 90}, View{"3 degrees over where the sun is", 3},
                            View{"3 degrees over the opposite horizon", 177}};
  for (View& view : views) {
    const double e = view.elevation_deg * kPi / 180;
    double nearest = -1;
    for (int y = 0; y < request.settings.height; ++y) {
      const double cosine =
          glm::dot(pixel_direction(request, 0, y), glm::dvec3(0, std::cos(e), std::sin(e)));
      if (cosine < nearest) continue;
      nearest = cosine;
      view.pixel = std::size_t(y);
    }
    EXPECT_GT(nearest, std::cos(0.02));
  }
  const Quadrature truth(request);
  double sky_before = 0, fastest = 0;
  for (int step = 0; step <= kSteps; ++step) {
    request.sun.to_sun = sun_at(1 - kStep_deg * step);
    const HdrImage image = render(request).image;
    for (View& view : views) {
      const float* rgb = &image.rgb[3 * view.pixel];
      const double here = f64::luminance(rgb[0], rgb[1], rgb[2]);
      const double change = std::log10(here / view.before) * 0.1 / kStep_deg;
      if (step > 0) view.fastest = std::max(view.fastest, std::abs(change));
      if (step > 1) view.jump = std::max(view.jump, std::abs(change - view.change_before));
      const glm::dvec3 expected = truth.radiance(pixel_direction(request, 0, int(view.pixel)));
      const double there = f64::luminance(expected.r, expected.g, expected.b);
      const double true_change = std::log10(there / view.true_before) * 0.1 / kStep_deg;
      if (step > 0) view.off = std::max(view.off, std::abs(change - true_change));
      view.true_before = there;
      view.before = here;
      view.change_before = change;
    }
    double sky = 0;
    for (int y = 0; y < request.settings.height; ++y) {
      const double mu = pixel_direction(request, 0, y).z;  // mu^2: angle that a pixel spans
      const float* rgb = &image.rgb[3 * std::size_t(y)];
      sky += mu * mu * mu * f64::luminance(rgb[0], rgb[1], rgb[2]);
    }
    if (step > 0)
      fastest = std::max(fastest, std::abs(std::log10(sky / sky_before)) * 0.1 / kStep_deg);
    sky_before = sky;
  }
  report_accuracy("air", "twilight, log10 of luminance per 0.1 degree: sky on level ground",
                  fastest, 0.05, "1");
  EXPECT_LE(fastest, 0.05);
  // Single directions darken faster while the edge of the planet's shadow passes them: by a scale
  // height of air in 0.7 degrees at the zenith. What must not be is a jump.
  for (const View& view : views) {
    const std::string name = view.name;
    report_accuracy("air", "twilight, log10 of luminance per 0.1 degree: " + name, view.fastest,
                    0.075, "1");
    report_accuracy("air", "twilight, change of that from one 0.2 degrees to the next: " + name,
                    view.jump, 0.015, "1");
    report_accuracy("air", "twilight, the same against quadrature: " + name, view.off, 0.003, "1");
    EXPECT_LE(view.off, 0.003) << name;
    EXPECT_LE(view.fastest, 0.075) << name;
    EXPECT_LE(view.jump, 0.015) << name;
  }
}

}  // namespace
}  // namespace nepho::test
