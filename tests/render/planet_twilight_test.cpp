// Sun from 1 degree above the horizon to 18 below it, in the renderer's pictures.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "accuracy_report.h"
#include "gl_fixture.h"
#include "physics/physics_cpp.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using PlanetTwilight = GlFixture;

TEST_F(PlanetTwilight, TheSkyDarkensWithoutJumps) {
  constexpr double kRadius_m = 6.36e6, kStep_deg = 0.2;
  constexpr int kSteps = 95;
  RenderRequest request = request_of({});
  request.planet = Planet{};
  request.planet->body = Ellipsoid::sphere(kRadius_m);
  // One column of pixels from horizon to horizon, through the zenith.
  const glm::dvec3 eye(0, 0, kRadius_m + 2);
  request.camera = {eye, eye + glm::dvec3(0, 0, 1e3), glm::dvec3(0, 1, 0), 175 * kPi / 180};
  request.settings.width = 1;
  request.settings.height = 3001;
  struct View {
    const char* name;
    double elevation_deg;  // over 90: on the side away from the sun
    double before = 0, worst = 0, worst_at_deg = 0;
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
    EXPECT_GT(nearest, std::cos(0.013));
  }
  if (getenv("TOP")) request.planet->air->top_m = atof(getenv("TOP"));
  for (int step = 0; step <= kSteps; ++step) {
    const double sun_deg = 1 - kStep_deg * step, sun = sun_deg * kPi / 180;
    request.sun = {glm::dvec3(0, std::cos(sun), std::sin(sun)), {1.6, 1.85, 2.0}};
    const HdrImage image = render(request).image;
    for (View& view : views) {
      const float* rgb = &image.rgb[3 * view.pixel];
      if (getenv("TW"))
        std::printf("%s %.1f %.4e %.4e %.4e\n", view.name, sun_deg, rgb[0], rgb[1], rgb[2]);
      const double here = f64::luminance(rgb[0], rgb[1], rgb[2]);
      const double change =
          step > 0 ? std::abs(std::log10(here / view.before)) * 0.1 / kStep_deg : 0;
      if (change > view.worst) {
        view.worst = change;
        view.worst_at_deg = sun_deg;
      }
      view.before = here;
    }
  }
  for (const View& view : views) {
    std::printf("measured: %s: fastest at %.1f degrees\n", view.name, view.worst_at_deg);
    report_accuracy("air", std::string("twilight, log10 of luminance per 0.1 degree: ") + view.name,
                    view.worst, 0.05, "1");
    EXPECT_LE(view.worst, 0.05) << view.name;
  }
}

}  // namespace
}  // namespace nepho::test
