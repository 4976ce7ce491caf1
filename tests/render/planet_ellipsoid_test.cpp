// Air over an ellipsoid: its density goes with the altitude, which shaders take from scaled space.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accuracy_report.h"
#include "air/air_lookup.h"
#include "gl_fixture.h"
#include "physics/physics_cpp.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using PlanetEllipsoid = GlFixture;

// Molecules alone, once scattered and by the table, in world space and with geodetic altitudes.
class Truth {
 public:
  explicit Truth(const RenderRequest& request)
      : request_(request),
        body_(request.planet->body),
        air_(*request.planet->air),
        tables_(make_air_tables(air_, body_.equatorial_m, request.planet->ground.water_albedo)),
        lookup_(air_, body_.equatorial_m, tables_) {}

  // From the eye, to the top of the air; upwards, or past the planet.
  glm::dvec3 radiance(const glm::dvec3& direction) const {
    const glm::dvec3 to_sun = request_.sun.to_sun;
    const double phase = f64::rayleigh_phase(1 - glm::dot(to_sun, direction));
    double amount_m = 0;
    glm::dvec3 sum(0.0);
    march(request_.camera.eye_m, direction, 1200, [&](const glm::dvec3& p, double step_m) {
      const double height_m = geodetic_height_m(body_, p);
      const double part = f64::air_exponential(height_m, air_.rayleigh_scale_m);
      const glm::dvec3 up = up_at(p);
      double beam_m = 0;
      march(p, to_sun, 300, [&](const glm::dvec3& q, double length_m) {
        beam_m +=
            length_m * f64::air_exponential(geodetic_height_m(body_, q), air_.rayleigh_scale_m);
      });
      const AirLight light = lookup_.light(height_m, glm::dot(up, to_sun));
      for (int c = 0; c < 3; ++c) {
        const double k = air_.rayleigh_per_m[c];
        sum[c] += step_m * std::exp(-k * (amount_m + 0.5 * step_m * part)) *
                  f64::air_emission(k * part, 0, std::exp(-k * beam_m), phase, 0, light.multiple[c],
                                    light.multiple_p2[c], glm::dot(up, direction));
      }
      amount_m += step_m * part;
    });
    return sum;
  }

 private:
  glm::dvec3 up_at(const glm::dvec3& p) const {
    const double a = body_.equatorial_m, b = body_.polar_m;
    return glm::normalize(p / glm::dvec3(a * a, a * a, b * b));
  }
  // Midpoints, to where the ray leaves a sphere around the air.
  template <class Step>
  void march(const glm::dvec3& from, const glm::dvec3& direction, int steps, Step&& step) const {
    const double along = glm::dot(from, direction), r = body_.equatorial_m + air_.top_m;
    const double root = std::sqrt(along * along - glm::dot(from, from) + r * r);
    const double begin = std::max(-along - root, 0.0), end = -along + root;
    const auto at = [&](double u) {  // dense where the air is
      return begin > 0 ? begin + (end - begin) * u : end * u * u;
    };
    for (int i = 0; i < steps; ++i) {
      const double t0 = at(double(i) / steps), t1 = at(double(i + 1) / steps);
      step(from + (t0 + t1) / 2 * direction, t1 - t0);
    }
  }

  const RenderRequest& request_;
  const Ellipsoid body_;
  const Air air_;
  AirTables tables_;
  AirLookup lookup_;
};

TEST_F(PlanetEllipsoid, AirLiesAtItsAltitude) {
  RenderRequest request = request_of({});
  request.planet = Planet{};
  request.planet->air->aerosol_extinction_per_m = request.planet->air->ozone_per_m =
      glm::dvec3(0.0);
  request.settings.width = request.settings.height = 1;
  request.settings.tolerance = 1e-3;  // spans of air are told apart (tolerance_test.cpp)
  double worst = 0;
  for (const double latitude_deg : {0.0, 45.0, 90.0})
    for (const double height_m : {2.0, 10e3, 400e3}) {
      const double latitude = latitude_deg * kPi / 180;
      const glm::dvec3 up(std::cos(latitude), 0, std::sin(latitude)), east(0, 1, 0);
      const glm::dvec3 eye = geodetic_to_ecef_m(request.planet->body, latitude, 0, height_m);
      request.sun = {std::sin(0.7) * up + std::cos(0.7) * glm::normalize(glm::cross(up, east)),
                     {1, 1, 1}};
      // Past the planet, 30 km over the horizon, where the eye is outside the air.
      const double pass = -std::acos((request.planet->body.polar_m + 40e3) /
                                     (request.planet->body.polar_m + 400e3));
      for (const double elevation :
           height_m > 100e3 ? std::vector{pass} : std::vector{0.05, 0.5, 1.5}) {
        request.camera = {eye, eye + 1e3 * (std::cos(elevation) * east + std::sin(elevation) * up),
                          glm::cross(up, east), 1e-5};
        const HdrImage image = render(request).image;
        const glm::dvec3 truth = Truth(request).radiance(pixel_direction(request, 0, 0));
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(image.rgb[std::size_t(c)] / truth[c] - 1));
      }
    }
  report_accuracy("air", "altitude over the ellipsoid by one factor per ray: radiance", worst, 2e-3,
                  "relative");
  EXPECT_LE(worst, 2e-3);
}

}  // namespace
}  // namespace nepho::test
