// The GPU renderer against closed forms, in boxes and on shells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "gl_fixture.h"
#include "optics/hg_draine.h"
#include "physics/physics_cpp.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using Renderer = GlFixture;

double relative(double got, double truth) {
  return std::abs(got / truth - 1);
}

// First order of scattering in a slab, up at its top, what doubling starts from (Hansen and Travis
// 1974): I = w P / (4 pi) mu0 / (mu + mu0) (1 - exp(-tau (1/mu + 1/mu0))).
class SlabFromAbove : public Renderer {
 protected:
  void expect_closed_form(double tau, const Phase& phase, double (*value)(double)) {
    const double height_m = 1000, extinction = tau / height_m;
    const FieldSource slab(box(4000, height_m, {true, true}), isotropic(1),
                           [&](glm::dvec3) { return extinction; });
    RenderRequest request = request_of({&slab});
    request.volumes[0].phase = phase;
    request.sun.to_sun = glm::normalize(glm::dvec3(0.5, 0.3, 0.6));
    request.camera = {{0, -3000, 4000}, {0, 0, 1000}, {0, 0, 1}, 0.4};
    request.settings.tolerance = 1e-3;
    const HdrImage image = render(request).image;
    double worst = 0, worst_tau = 0;
    for (int y = 0; y < image.height; y += 3)
      for (int x = 0; x < image.width; x += 3) {
        const glm::dvec3 d = pixel_direction(request, x, y);
        const double mu = -d.z, mu0 = request.sun.to_sun.z;
        const glm::dvec3 apart = request.sun.to_sun - d;
        const double p = value(0.5 * glm::dot(apart, apart));
        const double truth = p * mu0 / (mu + mu0) * -std::expm1(-tau * (1 / mu + 1 / mu0));
        worst = std::max(worst, relative(green_at(image, x, y), truth));
        if (tau < 5) worst_tau = std::max(worst_tau, relative(tau_at(image, x, y), tau / mu));
      }
    std::printf("measured: slab tau %g: radiance off by %.1e, optical depth by %.1e\n", tau, worst,
                worst_tau);
    EXPECT_LE(worst, 5e-3) << tau;
    EXPECT_LE(worst_tau, 1e-5) << tau;
  }
};
TEST_F(SlabFromAbove, ScattersOnce) {
  for (const double tau : {1e-6, 0.1, 2.0, 30.0, 1e4})
    expect_closed_form(tau, {PhaseKind::kHenyeyGreenstein, 10e-6, 0.85},
                       [](double down) { return f64::hg_phase(down, 0.85); });
}
TEST_F(SlabFromAbove, ScattersOnceByHgDraine) {
  expect_closed_form(0.1, {PhaseKind::kHgDraine, 10e-6, 0},
                     [](double down) { return hg_draine_fit(10e-6).value(down); });
}

// From within 2 m of the ground to 1e9 m: the path through a shell in closed form, in double.
TEST_F(Renderer, OpticalDepthOfAShellFromTheGroundToTheMoonAndBeyond) {
  const double radius_m = 6.371e6, bottom_m = 2000, top_m = 4000, extinction = 1e-5;
  const auto chart = std::make_shared<ShellChart>(Ellipsoid::sphere(radius_m), bottom_m, top_m);
  const FieldSource layer(chart, Lattice({kSplitXy}), [&](glm::dvec3) { return extinction; });
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  const glm::dvec3 across = glm::normalize(glm::cross(up, glm::dvec3(1, 0, 0)));
  for (const double height_m : {1.7, 500.0, 3000.0, 12e3, 1e6, 1e9}) {
    RenderRequest request = request_of({&layer});
    request.sun.to_sun = up;
    const glm::dvec3 eye = (radius_m + height_m) * up;
    // Up and along the horizon from below; the limb from afar.
    const double limb = height_m > 5000 ? std::asin(radius_m / (radius_m + height_m)) : 0;
    request.camera = {
        eye,
        eye +
            (height_m > 5000 ? -std::cos(limb) * up + std::sin(limb) * across : 0.3 * up + across),
        up, height_m > 5000 ? 8000 / std::sqrt(height_m * (2 * radius_m + height_m)) : 0.8};
    const HdrImage image = render(request).image;
    double worst = 0;
    int seen = 0;
    const auto path_m = [&](const glm::dvec3& d, double sphere_m) -> double {  // inside a sphere
      const double r0 = radius_m + height_m, b = r0 * glm::dot(up, d);
      const double disc = b * b - (r0 - sphere_m) * (r0 + sphere_m);
      if (disc <= 0) return 0;
      const double near = -b - std::sqrt(disc), far = -b + std::sqrt(disc);
      return std::max(far, 0.0) - std::max(near, 0.0);
    };
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::dvec3 d = pixel_direction(request, x, y);
        double length_m = path_m(d, radius_m + top_m) - path_m(d, radius_m + bottom_m);
        if (path_m(d, radius_m) > 1) {  // the ground hides the far half
          if (height_m < bottom_m) continue;
          length_m = height_m < top_m ? 0 : 0.5 * length_m;
          if (height_m < top_m) continue;
        }
        // A ray that touches the layer's rim decides by its last digit.
        if (length_m < 3e4 && height_m > top_m) continue;
        const double r_closest =
            (radius_m + height_m) * std::sqrt(1 - std::pow(glm::dot(up, d), 2));
        if (height_m > top_m && std::abs(r_closest - radius_m - bottom_m) < 20) continue;
        ++seen;
        worst = std::max(worst, relative(tau_at(image, x, y), extinction * length_m));
      }
    std::printf("measured: shell from %g m: %d rays, optical depth off by %.1e\n", height_m, seen,
                worst);
    EXPECT_GT(seen, 40) << height_m;
    EXPECT_LE(worst, 2e-3) << height_m;
  }
}

double lumpy(glm::dvec3 p) {
  return 0.01 * std::max(0.0, 1 - glm::length(p - glm::dvec3(0, 0, 500)) / 420) *
         (1 + 0.6 * std::sin(p.x / 70) * std::sin(p.y / 60));
}
double blob(glm::dvec3 p) {
  return 0.006 *
         std::exp(-glm::dot(p - glm::dvec3(150, 0, 600), p - glm::dvec3(150, 0, 600)) / 4e4);
}

double worst_pixel(const HdrImage& a, const HdrImage& b) {
  float most = 0;
  double worst = 0;
  for (const float v : b.rgb) most = std::max(most, v);
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    worst = std::max(worst, double(std::abs(a.rgb[i] - b.rgb[i])) / double(most));
  return worst;
}

TEST_F(Renderer, OverlappingVolumesAddInAnyOrder) {
  const FieldSource a(box(1000, 1000), isotropic(2), lumpy), b(box(1000, 1000), isotropic(2), blob);
  const FieldSource both(box(1000, 1000), isotropic(2),
                         [](glm::dvec3 p) { return lumpy(p) + blob(p); });
  const auto picture = [&](std::initializer_list<const BrickSource*> sources) {
    RenderRequest request = request_of(sources);
    request.settings.light = Light::kOctaves;
    request.sky.zenith_W_per_m2_sr_nm = request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.05);
    request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, -0.5, 0.7));
    request.camera = {{0, -1500, 700}, {0, 0, 500}, {0, 0, 1}, 0.7};
    request.settings.step_voxels = 0;
    request.settings.max_level = 2;
    return render(request).image;
  };
  const HdrImage ab = picture({&a, &b}), ba = picture({&b, &a}), sum = picture({&both});
  const double order = worst_pixel(ab, ba), addition = worst_pixel(ab, sum);
  std::printf("measured: A over B against B over A %.1e, against A + B %.1e of the brightest\n",
              order, addition);
  EXPECT_LE(order, 1e-5);
  EXPECT_LE(addition, 1e-3);
  // The comparison can fail: without B it is far off.
  EXPECT_GT(worst_pixel(picture({&a}), sum), 0.02);
}

TEST_F(Renderer, TheSamePictureTwice) {
  const FieldSource source(box(1000, 1000), isotropic(2), lumpy);
  RenderRequest request = request_of({&source});
  request.camera = {{0, -1500, 700}, {0, 0, 500}, {0, 0, 1}, 0.7};
  EXPECT_EQ(render(request).image.rgb, render(request).image.rgb);
}

// lattice.md 7: what is off screen still shadows what is on it.
TEST_F(Renderer, AZoomedPictureIsTheCropOfTheWhole) {
  const FieldSource source(box(1000, 1000), isotropic(3), lumpy);
  RenderRequest request = request_of({&source});
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.8, 0.1, 0.4));
  request.camera = {{0, -1500, 500}, {0, 0, 500}, {0, 0, 1}, 0.7};
  request.settings.width = request.settings.height = 96;
  const HdrImage whole = render(request).image;
  RenderRequest zoomed = request;
  zoomed.camera.vertical_fov_rad = 2 * std::atan(std::tan(0.35) / 3);
  zoomed.settings.width = zoomed.settings.height = 32;
  const HdrImage crop = render(zoomed).image;
  double sum = 0, squares = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double truth = green_at(whole, 32 + x, 32 + y), off = green_at(crop, x, y) - truth;
      sum += truth;
      squares += off * off;
    }
  const double rms = std::sqrt(squares / 1024) / (sum / 1024);
  std::printf("measured: zoomed against crop %.2e rms of the mean\n", rms);
  EXPECT_LE(rms, 0.01);
}

TEST_F(Renderer, StaysUnderItsBudgetAndRefusesWhatCannotFit) {
  const FieldSource source(box(1000, 1000), isotropic(4), lumpy);
  RenderRequest request = request_of({&source});
  request.camera = {{0, -700, 500}, {0, 0, 500}, {0, 0, 1}, 0.9};
  request.settings.width = request.settings.height = 256;
  for (const double budget_mib : {0.25, 1.0, 4.0, 64.0}) {
    request.settings.budget_mib = budget_mib;
    const RenderReport report = render(request).report;
    const std::uint64_t used =
        report.atlas_bytes + report.sun_bytes + report.node_bytes + report.staging_bytes;
    std::printf("measured: budget %.2f MiB, used %.3f\n", budget_mib, double(used) / 1048576);
    EXPECT_LE(double(used), budget_mib * 1048576);
  }
  request.settings.budget_mib = 1e-3;
  EXPECT_THROW(render(request), Error);
}

// llvmpipe ends all loops of an invocation after 65535 iterations. Whatever the device does, a
// picture is right or refused.
TEST_F(Renderer, ARayThatIsCutOffIsNotShown) {
  const FieldSource source(box(800, 800), isotropic(1), [](glm::dvec3 p) { return 1e-6 * p.z; });
  RenderRequest request = request_of({&source});
  request.camera = {{0, -1000, 400}, {0, 0, 400}, {0, 0, 1}, 0.2};
  request.settings.width = request.settings.height = 2;
  request.settings.step_voxels = 1;
  const HdrImage coarse = render(request).image;
  request.settings.step_voxels = 1e-4;  // 160000 steps a ray
  try {
    EXPECT_LE(relative(tau_at(render(request).image, 1, 1), tau_at(coarse, 1, 1)), 1e-2);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cut off"), std::string::npos) << error.what();
  }
}

// Level rays to the sky never leave a periodic layer: they must end all the same, and the layer's
// top must be brighter than its base.
TEST_F(Renderer, APeriodicLayerUnderASkyIsDrawn) {
  const FieldSource layer(box(4000, 1000, {true, true}), isotropic(2),
                          [](glm::dvec3 p) { return 2e-3 * std::exp(-p.z / 300); });
  RenderRequest request = request_of({&layer});
  request.settings.light = Light::kOctaves;
  request.sky.zenith_W_per_m2_sr_nm = request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.1);
  request.sun.irradiance_W_per_m2_nm = glm::dvec3(0.0);
  request.camera = {{0, 0, 3000}, {0, 0, 0}, {0, 1, 0}, 0.3};
  request.settings.probe_pixels = 16;
  const RenderResult result = render(request);
  EXPECT_TRUE(std::ranges::all_of(result.image.rgb, [](float v) { return v > 0 && v < 0.1f; }));
  EXPECT_LE(result.error.integration, 0.02);
}

TEST_F(Renderer, NoPixelIsNotANumber) {
  // Zero, thin and thick side by side; rays along axes, edges and from inside.
  const FieldSource source(box(800, 800), isotropic(2), [](glm::dvec3 p) {
    return p.z < 200 ? 0.0 : p.z < 400 ? 1e-12 : p.x < 0 ? 50.0 : 1e-3;
  });
  for (const glm::dvec3& eye : {glm::dvec3(0, -400, 400), glm::dvec3(0, 0, 400),
                                glm::dvec3(-400, -400, 0), glm::dvec3(1e9, 0, 0)})
    for (const double step : {0.0, 2.0, 7.0}) {
      RenderRequest request = request_of({&source});
      request.camera = {eye,
                        eye + glm::dvec3(eye.x > 1e8 ? -1 : 0, eye.x > 1e8 ? 0 : 1, 0),
                        {0, 0, 1},
                        eye.x > 1e8 ? 1e-6 : 1.2};
      request.settings.step_voxels = step;
      request.settings.light = Light::kOctaves;
      const HdrImage image = render(request).image;
      EXPECT_TRUE(
          std::ranges::all_of(image.rgb, [](float v) { return std::isfinite(v) && v >= 0; }))
          << eye.x << " " << eye.y << " step " << step;
    }
}

}  // namespace
}  // namespace nepho::test
