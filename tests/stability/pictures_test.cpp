// Stiff cases in pictures of the renderer, small ones: each computes its naive form beside them.
#include <cmath>
#include <cstdio>

#include "analytic_field.h"
#include "expect_stable.h"
#include "gl_fixture.h"
#include "physics/physics_cpp.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using Pictures = GlFixture;

// A shell seen from 1e9 m: the path through it, which the ray enters in double.
TEST_F(Pictures, AShellFromAfar) {
  constexpr double radius_m = 6.371e6, bottom_m = 2000, top_m = 4000, distance_m = 1e9;
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(radius_m), bottom_m, top_m);
  const FieldSource layer(chart, Lattice({kSplitXy}), [](glm::dvec3) { return 1e-5; });
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  RenderRequest request = request_of({&layer});
  request.sun.to_sun = up;
  request.camera = {distance_m * up,
                    {0, 0, 0},
                    glm::normalize(glm::cross(up, glm::dvec3(1, 0, 0))),
                    2 * radius_m / distance_m};
  request.settings.width = request.settings.height = 24;
  const HdrImage image = render(request).image;
  double worst = 0, naive = 0;
  int seen = 0;
  const auto enter_m = [&](const auto& b, const auto& c) { return -b - std::sqrt(b * b - c); };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 d = pixel_direction(request, x, y);
      const long double b = distance_m * glm::dot(up, d), r = distance_m;
      const auto exact_m = [&](long double sphere_m) {
        return enter_m(b, (r - sphere_m) * (r + sphere_m));
      };
      const double impact_m = distance_m * glm::length(glm::cross(up, d));
      if (impact_m > 0.999 * radius_m) continue;
      const auto usual_m = [&](double sphere_m) {
        const glm::vec3 eye(request.camera.eye_m), direction(d);
        const float fb = glm::dot(eye, direction);
        return double(enter_m(fb, glm::dot(eye, eye) - float(sphere_m) * float(sphere_m)));
      };
      const double length_m = double(exact_m(radius_m + bottom_m) - exact_m(radius_m + top_m));
      worst = std::max(worst, std::abs(double(tau_at(image, x, y)) / (1e-5 * length_m) - 1));
      const double usual = usual_m(radius_m + bottom_m) - usual_m(radius_m + top_m);
      naive = std::isfinite(usual) ? std::max(naive, std::abs(usual / length_m - 1)) : 1e30;
      ++seen;
    }
  EXPECT_GT(seen, 200);
  expect_stable("16", worst, 1e-4, naive, "of the path through a layer of 2 km");
}

// Pixels of a picture 1920 wide over 0.01 degrees: their places, told by a field that rises across.
TEST_F(Pictures, PixelsOfANarrowView) {
  constexpr double pixel_rad = 0.01 * kPi / 180 / 1920, side_m = 1000;
  constexpr int pixels = 48;
  const double distance_m = 0.9 * side_m / (pixels * pixel_rad);
  const FieldSource ramp(box(side_m, side_m), isotropic(0),
                         [](glm::dvec3 p) { return 1e-6 * (p.x / side_m + 0.5); });
  RenderRequest request = request_of({&ramp});
  request.settings.width = pixels;
  request.settings.height = 4;
  request.settings.step_voxels = 0;  // cell by cell: a ramp is exact
  // Down along z, off the axes.
  const glm::dvec3 away = glm::normalize(glm::dvec3(0, 1e-8, 1));
  const glm::dvec3 middle(0, 0, 0.5 * side_m);
  request.camera = {middle + distance_m * away, middle, {0, 1, 0}, 4 * pixel_rad};
  const HdrImage image = render(request).image;
  double worst = 0, naive = 0;
  const double metre_per_pixel = distance_m * pixel_rad;
  for (int x = 0; x < pixels; ++x) {
    const glm::dvec3 d = pixel_direction(request, x, 1);
    // Where this ray meets the box's middle, and where the optical depth says that it does.
    const double wanted_m = request.camera.eye_m.x + distance_m * d.x / -d.z;
    const double found_m = side_m * (double(tau_at(image, x, 1)) / (1e-6 * side_m) - 0.5);
    worst = std::max(worst, std::abs(found_m - wanted_m) / metre_per_pixel);
    // A view down an oblique axis keeps float's spacing of a unit vector.
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0.6, 0.5, 0.62)),
                     across = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    const double angle = (x - 0.5 * pixels) * pixel_rad;
    const glm::dvec3 ray = std::cos(angle) * forward + std::sin(angle) * across;
    naive =
        std::max(naive, std::abs(glm::dot(glm::dvec3(glm::vec3(ray)) - ray, across)) / pixel_rad);
  }
  expect_stable("17", worst, 0.02, naive, "pixels of 0.01 deg / 1920");
}

double lumpy(glm::dvec3 p) {
  return 4e-3 * (1 + 0.6 * std::sin(p.x / 90) * std::sin(p.y / 80) + 0.3 * std::sin(p.z / 70));
}

// The eye in a cloud, a millimetre before and behind walls of cells, bricks and the volume.
TEST_F(Pictures, TheEyeCrossesWallsUnseen) {
  const FieldSource cloud(box(1000, 1000), isotropic(1), lumpy);
  RenderRequest request = request_of({&cloud});
  request.settings.light = Light::kOctaves;
  request.sky.zenith_W_per_m2_sr_nm = request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.05);
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, -0.5, 0.7));
  request.settings.max_level = 1;
  double worst = 0, naive = 0;
  const auto seen = [&](glm::dvec3 eye, glm::dvec3 forward) {
    request.camera = {eye, eye + forward, {0, 0, 1}, 1.2};
    return render(request).image;
  };
  const glm::dvec3 ahead = glm::normalize(glm::dvec3(0.3, 1, 0.2));
  for (const glm::dvec3& wall : {glm::dvec3(10, 0, 480), glm::dvec3(10, 62.5, 480),
                                 glm::dvec3(0, 0, 500), glm::dvec3(30, -500, 300)}) {
    request.settings.width = request.settings.height = 13;
    const HdrImage before = seen(wall - glm::dvec3(0, 1e-3, 0), ahead),
                   behind = seen(wall + glm::dvec3(0, 1e-3, 0), ahead);
    for (int y = 0; y < before.height; ++y)
      for (int x = 0; x < before.width; ++x)
        worst = std::max(
            worst, std::abs(double(green_at(before, x, y)) / double(green_at(behind, x, y)) - 1));
    // The same line of sight from where it enters the volume, behind the eye.
    const double tau = double(tau_at(behind, 6, 6));
    request.settings.width = request.settings.height = 1;
    naive = std::max(naive, double(tau_at(seen(wall - 1500.0 * ahead, ahead), 0, 0)) / tau - 1);
  }
  expect_stable("23", worst, 1e-2, naive, "of radiance, over 2 mm");
}

// Twice a little optical depth is twice the light.
TEST_F(Pictures, ThinCloudsAreLinear) {
  const auto light = [](double tau) {
    const FieldSource slab(box(4000, 1000, {true, true}), isotropic(1),
                           [=](glm::dvec3) { return tau / 1000; });
    RenderRequest request = request_of({&slab});
    request.sun.to_sun = glm::normalize(glm::dvec3(0.5, 0.3, 0.6));
    request.camera = {{0, -3000, 4000}, {0, 0, 1000}, {0, 0, 1}, 0.4};
    request.settings.width = request.settings.height = 4;
    return double(green_at(render(request).image, 1, 1));
  };
  double worst = 0, naive = 0;
  for (const double tau : {1e-7, 3e-7, 1e-6, 1e-5}) {
    worst = std::max(worst, std::abs(light(2 * tau) / light(tau) - 2));
    const auto usual = [](double x) { return double(1 - std::exp(float(-x))); };
    naive = std::max(naive, std::abs(usual(2 * tau) / usual(tau) - 2));
  }
  expect_stable("33", worst, 1e-3, naive, "of a ratio of 2");
}

// Extinction of a brick's corner by its indices: noise from sample to sample.
double corner_per_m(int i, int j, int k) {
  return 1e-4 * (1 + lattice_noise(i, j, k));
}

// Down through one brick of noise, nearly along z: cell by cell a cubic.
TEST_F(Pictures, WeightsOfATexture) {
  constexpr double side_m = 800, cell_m = side_m / 8;
  const FieldSource noise(box(side_m, side_m), isotropic(0), [](glm::dvec3 p) {
    const glm::dvec3 at = glm::round((p + glm::dvec3(side_m / 2, side_m / 2, 0)) / cell_m);
    return corner_per_m(int(at.x), int(at.y), int(at.z));
  });
  RenderRequest request = request_of({&noise});
  request.settings.tolerance = 1e-3;
  request.settings.step_voxels = 0;
  request.settings.fetch = Fetch::kTexels8;
  request.settings.width = request.settings.height = 40;
  request.camera = {{0, 0, 1e9}, {0, 0, 0}, {0, 1, 0}, 0.98 * side_m / 1e9};
  const HdrImage image = render(request).image;
  // Straight down at a place in cells, its weights rounded to 1 / steps (0: as they are).
  const auto depth = [&](glm::dvec3 at, double steps) {
    const auto weight = [&](double f) { return steps > 0 ? std::round(f * steps) / steps : f; };
    const int i = std::min(int(at.x), 7), j = std::min(int(at.y), 7);
    const double u = weight(at.x - i), v = weight(at.y - j);
    const auto level = [&](int k) {
      return (1 - v) * ((1 - u) * corner_per_m(i, j, k) + u * corner_per_m(i + 1, j, k)) +
             v * ((1 - u) * corner_per_m(i, j + 1, k) + u * corner_per_m(i + 1, j + 1, k));
    };
    double sum = 0;
    for (int k = 0; k < 8; ++k) sum += cell_m * 0.5 * (level(k) + level(k + 1));
    return sum;
  };
  double worst = 0, naive = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 d = pixel_direction(request, x, y);
      const glm::dvec3 at = (1e9 / -d.z * d + glm::dvec3(side_m / 2)) / cell_m;
      const double exact = depth(at, 0);
      worst = std::max(worst, std::abs(double(tau_at(image, x, y)) / exact - 1));
      naive = std::max(naive, std::abs(depth(at, 256) / exact - 1));
    }
  expect_stable("L8", worst, 2e-4, naive, "of the optical depth");
}

}  // namespace
}  // namespace nepho::test
