// The renderer against the reference march: parity in its exact setting, convergence, and the error
// line that every picture carries, on scenes drawn from a seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "host/source_host.h"
#include "random.h"
#include "reference/error_metric.h"
#include "reference/march_picture.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using ErrorLine = GlFixture;

double clumps(glm::dvec3 p) {
  return 8 * cloud(0.005 * p) + 1.5 * puffs(0.001 * p);
}
double haze(glm::dvec3 p) {
  return 2e-3 * std::exp(-p.z / 300) * (1 + 0.3 * std::sin(p.x / 90));
}

const FieldSource& clumpy() {
  static const FieldSource source(box(1000, 1000), isotropic(3), clumps);
  return source;
}
const FieldSource& hazy() {
  static const FieldSource source(box(1400, 700), isotropic(2), haze);
  return source;
}
// 200 km features of cloud on a whole planet, 4 km deep.
const FieldSource& shell() {
  static const FieldSource source(std::make_shared<ShellChart>(Ellipsoid::wgs84(), 1000, 17000),
                                  Lattice({kSplitXy, kSplitXy, kSplitXyz}),
                                  [](glm::dvec3 p) { return 2e-2 * cloud(10 / 6.4e6 * p); });
  return source;
}

RenderRequest picture_of(std::initializer_list<const BrickSource*> sources, Random& random) {
  RenderRequest request = request_of(sources);
  request.settings.light = Light::kOctaves;
  request.settings.width = 40;
  request.settings.height = 24;
  request.settings.budget_mib = 256;
  request.sun.to_sun = glm::normalize(
      glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)));
  request.camera = {{random.uniform(-900, 900), -1500, 600}, {0, 0, 480}, {0, 0, 1}, 0.75};
  return request;
}

RenderRequest planet(Random& random) {
  RenderRequest request = picture_of({&shell()}, random);
  const glm::dvec3 up = random.direction();
  const glm::dvec3 east = glm::normalize(glm::cross(up, glm::dvec3(0.1, 0.2, 1)));
  request.sun.to_sun = glm::normalize(up + random.uniform(0.2, 2) * east);
  request.sky.up = up;
  request.camera = {6.6e6 * up, 6.2e6 * up + 5e5 * east, up, 1.0};
  return request;
}

void add_sky(RenderRequest& request) {
  request.sky.zenith_W_per_m2_sr_nm = {0.02, 0.04, 0.08};
  request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.07);
  request.sky.below_W_per_m2_sr_nm = glm::dvec3(0.03);
}

HdrImage exact_picture(const RenderRequest& request) {
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  return march_picture(CutLevels(forest), request);
}

// The exact setting differs from the march by what is left: float, half-float light tiles, and
// light interpolated between voxels.
TEST_F(ErrorLine, TheExactSettingAgreesWithTheMarch) {
  Random random;
  RenderRequest requests[] = {picture_of({&clumpy()}, random), picture_of({&hazy()}, random),
                              picture_of({&clumpy(), &hazy()}, random), planet(random)};
  const char* names[] = {"box", "haze", "two boxes", "shell"};
  for (int i = 0; i < 4; ++i) {
    requests[i].settings.step_voxels = 0;
    if (i == 2) add_sky(requests[i]);
    const HdrImage image = render(requests[i]).image, truth = exact_picture(requests[i]);
    double depth = 0;
    for (std::size_t p = 0; p < truth.optical_depth.size(); ++p)
      if (truth.optical_depth[p] > 0.01 && truth.optical_depth[p] < 8)
        depth = std::max(
            depth, std::abs(double(image.optical_depth[p]) / double(truth.optical_depth[p]) - 1));
    const double error = picture_error(image, truth);
    std::printf("measured: %s: exact setting against the march: luminance %.1e, depth %.1e\n",
                names[i], error, depth);
    report_accuracy("Renderer against the reference march, cell-exact setting", names[i], error,
                    0.02, "relative rms of luminance");
    EXPECT_LE(error, 0.02) << names[i];
    EXPECT_LE(depth, i == 3 ? 2e-3 : 1e-4) << names[i];
  }
}

// An exponential layer on the whole planet, from a man's height above the ground and from 1e9 m:
// the float walk through curved cells against the double one.
TEST_F(ErrorLine, AnExponentialLayerFromTheGroundAndFromAfar) {
  const FieldSource layer(std::make_shared<ShellChart>(Ellipsoid::wgs84(), 0, 16000),
                          Lattice({kSplitXyz, kSplitXyz}), [](glm::dvec3 p) {
                            return 3e-5 *
                                   std::exp(-geodetic_height_m(Ellipsoid::wgs84(), p) / 4000);
                          });
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.4, 0.7, 0.3));
  const glm::dvec3 east = glm::normalize(glm::cross(up, glm::dvec3(0, 0, 1)));
  const double ground_m = glm::length(
      geodetic_to_ecef_m(Ellipsoid::wgs84(), std::asin(up.z), std::atan2(up.y, up.x), 0));
  for (const double height_m : {1.7, 1e9}) {
    RenderRequest request = request_of({&layer});
    request.sun.to_sun = glm::normalize(up + east);
    request.settings.width = 32;
    request.settings.height = 24;
    request.settings.step_voxels = 0;
    const glm::dvec3 eye = (ground_m + 3000 + height_m) * up;
    request.camera = {eye, eye + (height_m > 1e6 ? -up : east + 0.3 * up), up,
                      height_m > 1e6 ? 0.014 : 1.2};
    const HdrImage image = render(request).image, truth = exact_picture(request);
    double depth = 0;
    int seen = 0;
    for (std::size_t p = 0; p < truth.optical_depth.size(); ++p) {
      if (truth.optical_depth[p] < 1e-4 || !std::isfinite(truth.optical_depth[p])) continue;
      ++seen;
      depth = std::max(
          depth, std::abs(double(image.optical_depth[p]) / double(truth.optical_depth[p]) - 1));
    }
    const double error = picture_error(image, truth);
    std::printf("measured: exponential layer from %g m: %d rays, depth %.1e, luminance %.1e\n",
                height_m, seen, depth, error);
    report_accuracy("Renderer against the reference march, cell-exact setting",
                    height_m > 1e6 ? "exponential layer on the shell from 1e9 m"
                                   : "exponential layer on the shell from 1.7 m",
                    error, 0.02, "relative rms of luminance");
    EXPECT_GT(seen, 200) << height_m;
    EXPECT_LE(depth, 2e-3) << height_m;
    EXPECT_LE(error, 0.02) << height_m;
  }
}

// A box that stands upright inside a shell: the sky's rays from samples on its walls run along
// those walls but for 1e-18 of their length. Such a wall lies behind from the first metre on; each
// step used to end there, a thousandth of a cell long, and llvmpipe cut the ray off.
TEST_F(ErrorLine, RaysAlongTheWallsOfABoxInsideAShellTakeWholeCells) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.69, 0.085, 0.72));
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
  const glm::dvec3 north = glm::cross(up, east);
  const glm::dvec3 base =
      geodetic_to_ecef_m(Ellipsoid::wgs84(), std::asin(up.z), std::atan2(up.y, up.x), 1500);
  const double size_m = 1000;
  const FieldSource ball(
      std::make_shared<BoxChart>(base - 0.5 * size_m * (east + north),
                                 glm::dmat3(size_m * east, size_m * north, size_m * up)),
      isotropic(3), [&](glm::dvec3 p) {
        const double r = glm::length(p - base - 0.5 * size_m * up) / (0.5 * size_m);
        return 0.005 * std::max(0.0, 1 - r * r);
      });
  // Thin: what its light, interpolated over cells of 300 km, is off by does not hide the ball's.
  const FieldSource layer(std::make_shared<ShellChart>(Ellipsoid::wgs84(), 0, 16000),
                          Lattice({kSplitXyz, kSplitXyz}), [](glm::dvec3 p) {
                            return 1e-6 *
                                   std::exp(-geodetic_height_m(Ellipsoid::wgs84(), p) / 4000);
                          });
  RenderRequest request = request_of({&ball, &layer});
  add_sky(request);
  request.sky.up = up;
  request.sun.to_sun = glm::normalize(up + 0.7 * east);
  request.camera = {base + 900.0 * up - 2500.0 * north, base + 500.0 * up, up, 0.5};
  request.settings.width = 24;
  request.settings.height = 14;
  request.settings.step_voxels = 0;
  const HdrImage image = render(request).image, truth = exact_picture(request);
  double depth = 0;
  int through_ball = 0;
  for (std::size_t p = 0; p < truth.optical_depth.size(); ++p) {
    if (truth.optical_depth[p] > 0.5) ++through_ball;
    depth = std::max(depth,
                     std::abs(double(image.optical_depth[p]) / double(truth.optical_depth[p]) - 1));
  }
  const double error = picture_error(image, truth);
  std::printf("measured: box inside a shell: %d rays through it, depth %.1e, luminance %.1e\n",
              through_ball, depth, error);
  EXPECT_GT(through_ball, 20);
  EXPECT_LE(depth, 1e-4);
  EXPECT_LE(error, 0.02);
}

TEST_F(ErrorLine, ShorterStepsConvergeOnTheExactSetting) {
  Random random;
  RenderRequest request = picture_of({&clumpy()}, random);
  request.settings.step_voxels = 0;
  const HdrImage exact = render(request).image;
  double before = 0, error = 0;
  for (const double step : {4.0, 2.0, 1.0, 0.5}) {
    before = error;
    request.settings.step_voxels = step;
    error = picture_error(render(request).image, exact);
    std::printf("measured: step %.1f voxels: %.2e of the exact picture's luminance\n", step, error);
    if (before > 0) {
      EXPECT_LT(error, 0.8 * before) << step;
    }
  }
  EXPECT_LE(error, 5e-3);
}

void expect_within_three(const char* term, double estimate, double measured) {
  std::printf("measured: %-16s estimated %.2e, measured %.2e, ratio %.2f\n", term, estimate,
              measured, estimate / measured);
  if (std::max(estimate, measured) < 1e-6) return;  // a float picture holds no less
  EXPECT_LT(estimate, 3 * measured) << term;
  EXPECT_GT(estimate, measured / 3) << term;
}

TEST_F(ErrorLine, HoldsWithinThreeOnScenesDrawnFromASeed) {
  Random random;
  for (int scene = 0; scene < 6; ++scene) {
    RenderRequest request = scene % 3 == 0   ? picture_of({&clumpy()}, random)
                            : scene % 3 == 1 ? picture_of({&clumpy(), &hazy()}, random)
                                             : planet(random);
    if (random.integer(0, 1)) request.settings.step_voxels = random.uniform(1, 4);
    request.settings.tolerance = random.log_uniform(3e-3, 0.1);
    request.settings.budget_mib = random.log_uniform(0.4, 4);
    request.settings.seed = std::uint64_t(random.integer(1, 1000));
    request.settings.probe_pixels = 96;
    if (scene % 2) add_sky(request);
    const RenderResult result = render(request);
    const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
    const HdrImage cut = march_picture(CutLevels(forest), request);
    const HdrImage finest = march_picture(FinestLevels(request.volumes, 64), request);
    std::printf("scene %d: step %g, tolerance %g, budget %g MiB, %d probes\n", scene,
                request.settings.step_voxels.value_or(-1), request.settings.tolerance,
                request.settings.budget_mib, result.error.probe_pixels);
    expect_within_three("integration", result.error.integration, picture_error(result.image, cut));
    expect_within_three("level of detail", result.error.level_of_detail,
                        picture_error(cut, finest));
    EXPECT_GE(result.error.quantisation, 0);
    EXPECT_LE(result.error.quantisation, 1e-3);
    EXPECT_NE(result.error.light_model_basis.find("paths a pixel"), std::string::npos);
  }
}

#ifdef NEPHO_TEST_REAL_DATA
TEST_F(ErrorLine, HoldsWithinThreeOnARealFile) {
  const SourceHost host({NEPHO_TEST_MODULES});
  VolumeSpec spec;
  spec.name = "wdas";
  spec.source = "openvdb";
  spec.files = {std::string(NEPHO_TEST_REAL_DATA) + "/vdb/wdas_cloud_sixteenth.vdb"};
  const std::unique_ptr<BrickSource> cloud = host.open(spec);
  RenderRequest request = request_of({cloud.get()});
  request.volumes[0].phase = cloud->info().phase;
  request.settings.light = Light::kOctaves;
  request.settings.width = 48;
  request.settings.height = 27;
  request.settings.budget_mib = 3;  // binds: level of detail has an error to speak of
  request.settings.probe_pixels = 96;
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, -0.5, 0.7));
  request.camera = {{-600, -900, 200}, {30, -30, 100}, {0, 0, 1}, 0.5};
  const RenderResult result = render(request);
  const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
  const HdrImage cut = march_picture(CutLevels(forest), request);
  expect_within_three("integration", result.error.integration, picture_error(result.image, cut));
  expect_within_three(
      "level of detail", result.error.level_of_detail,
      picture_error(cut, march_picture(FinestLevels(request.volumes, 64), request)));
}
#endif

}  // namespace
}  // namespace nepho::test
