#include <cstdio>
#include <cmath>
#include <fstream>
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "common/gl_context.h"
#include "field_source.h"
#include "renderer.h"
using namespace nepho;
int main(int argc, char** argv) {
  auto ctx = make_egl_context();
  std::printf("%s\n", ctx->description().c_str());
  auto chart = std::make_shared<BoxChart>(glm::dvec3(-500, -500, 0), glm::dmat3(1000., 0, 0, 0, 1000., 0, 0, 0, 1000.));
  test::FieldSource src(chart, test::isotropic(2), [](glm::dvec3 p) {
    double r = glm::length(p - glm::dvec3(0, 0, 500));
    return 0.03 * std::max(0.0, 1 - std::pow(r / 350, 4)) * (1 + 0.5 * std::sin(p.x / 40) * std::sin(p.z / 50) * std::sin(p.y / 45));
  });
  RenderRequest q;
  q.volumes.push_back({&src, 0, Phase{}, glm::dvec3(0)});
  q.camera = {glm::dvec3(0, -2200, 400), glm::dvec3(0, 0, 500), glm::dvec3(0, 0, 1), 0.5};
  q.sun.to_sun = glm::normalize(glm::dvec3(-0.6, -0.5, 0.7));
  q.sky.zenith_W_per_m2_sr_nm = glm::dvec3(0.03, 0.06, 0.13);
  q.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.08, 0.10, 0.13);
  q.sky.below_W_per_m2_sr_nm = glm::dvec3(0.05, 0.05, 0.05);
  q.settings.width = 320; q.settings.height = 180; q.settings.probe_pixels = 0;
  if (argc > 2) q.settings.step_voxels = std::atof(argv[2]);
  auto r = render(q);
  for (auto& p : r.report.passes) std::printf("%s %.3f\n", p.name.c_str(), p.cpu_s);
  for (auto& v : r.report.volumes) std::printf("nodes %lu bricks %lu const %lu empty %lu\n", v.nodes, v.bricks, v.constant_nodes, v.empty_nodes);
  double mean = 0; float mx = 0; int bad=0;
  for (float x : r.image.rgb) { mean += x; mx = std::max(mx, x); bad += !std::isfinite(x);} 
  std::printf("mean %g max %g bad %d\n", mean / double(r.image.rgb.size()), mx, bad);
  std::ofstream f(argv[1]); f << "P6 320 180 255\n";
  for (float x : r.image.rgb) f.put(char(255 * std::pow(std::min(1.f, x * 4), 1 / 2.2f)));
}
