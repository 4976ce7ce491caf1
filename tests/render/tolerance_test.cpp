// What --tolerance promises: the error of the integration along a view ray, against the cell-exact
// march in double through the same bricks, with the light of the same tiles.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "accuracy_report.h"
#include "gl/frame_data.h"
#include "gl_fixture.h"
#include "reference/march_picture.h"
#include "reference/error_metric.h"
#include "tolerance_scenes.h"

namespace nepho::test {
namespace {

using Tolerance = GlFixture;

// Steps of the truth are halved until their source is this well known.
constexpr double kTruth = 1e-5;

struct Measured {
  double half = 0, most = 0, rms = 0;  // of the pixels' relative errors: median, 99 % quantile
  double per_ray = 0, view_cpu_s = 0;
  double extinction = 0, source = 0;
};

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = std::size_t(part * double(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(at));
  return values[at];
}

// Pictures with the same light have the same truth.
struct Truth {
  std::vector<float> lights;
  HdrImage image;
};

Measured measure(const MarchScene& scene, std::vector<Truth>& truths, const std::function<void(RenderSettings&)>& set) {
  RenderRequest request = scene.request;
  set(request.settings);
  request.keep_lights = request.count_samples = true;
  const RenderResult result = render(request);
  auto known = std::ranges::find(truths, result.lights->values, &Truth::lights);
  if (known == truths.end()) {
    const Forest forest = build_forest(request.volumes, gl::refinement_of(request));
    truths.push_back({result.lights->values,
                      march_picture(CutLevels(forest), request,
                                    {.source_tolerance = kTruth,
                                     .least_transmittance = 1e-8,
                                     .lights = result.lights})});
    known = truths.end() - 1;
  }
  const HdrImage& truth = known->image;
  Measured m;
  std::vector<double> errors;
  int counted = 0;
  for (std::size_t p = 0; p < truth.optical_depth.size(); ++p) {
    if (truth.optical_depth[p] < 0.01f) continue;
    ++counted;
    const double t = pixel_luminance(truth, p);
    errors.push_back(std::abs(pixel_luminance(result.image, p) - t) / std::max(t, 1e-30));
    if (std::getenv("NEPHO_WORST") && errors.back() > 1 * request.settings.tolerance)
      std::printf("    (%zu, %zu): %.1e, luminance %.3e depth %.4f truth %.4f\n", p % 40, p / 40, errors.back(), t, double(result.image.optical_depth[p]), double(truth.optical_depth[p]));
    m.rms += errors.back() * errors.back();
  }
  m.rms = std::sqrt(m.rms / counted);
  m.half = quantile(errors, 0.5);
  m.most = quantile(errors, 0.99);
  m.extinction = result.report.samples.extinction / counted;
  m.source = result.report.samples.source / counted;
  m.per_ray = m.extinction + m.source;
  for (const PassReport& pass : result.report.passes)
    if (pass.name == "view") m.view_cpu_s = pass.cpu_s;
  return m;
}

void print(const char* what, double value, const Measured& m) {
  std::printf("  %-9s %-8g q50 %.1e q99 %.1e rms %.1e | k %6.1f S %6.1f all %6.1f view %.3f CPU s\n", what, value, m.half, m.most,
              m.rms, m.extinction, m.source, m.per_ray, m.view_cpu_s);
  std::fflush(stdout);
}

TEST_F(Tolerance, DISABLED_Table) {
  const char* only = std::getenv("NEPHO_SCENE");
  const bool ladder = !std::getenv("NEPHO_NO_LADDER");
  for (const auto& [name, make] : march_scenes()) {
    if (only && name.find(only) == std::string::npos) continue;
    const MarchScene scene = make();
    std::vector<Truth> truths;
    std::printf("%s\n", name.c_str());
    if (!std::getenv("NEPHO_NO_TOLERANCE")) for (const double t : {1e-1, 3e-2, 1e-2, 1e-3, 1e-4})
      print("tolerance", t, measure(scene, truths, [&](RenderSettings& s) { s.tolerance = t; }));
    if (ladder)
      for (const double step : {8.0, 4.0, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.0625, 0.03125})
        print("step", step, measure(scene, truths, [&](RenderSettings& s) {
          s.step_voxels = step;
          s.tolerance = 1e-4;
          s.fetch = Fetch::kTexels8;
        }));
  }
}

}  // namespace
}  // namespace nepho::test
