#include <cstdio>
#include <cmath>
#include <fstream>
#include <string>
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "common/gl_context.h"
#include "field_source.h"
#include "renderer.h"
using namespace nepho;
int main(int argc, char** argv) {
  auto ctx = make_egl_context();
  std::string view = argv[3];
  auto chart = std::make_shared<ShellChart>(Ellipsoid::wgs84(), 1000, 21000);
  test::FieldSource src(chart, Lattice({kSplitXy, kSplitXy, kSplitXyz}), [](glm::dvec3 p) {
    double r = glm::length(p);
    return 2e-4 * std::max(0.0, std::sin(p.x / 4e5) * std::sin(p.z / 5e5) * std::sin(p.y / 4.5e5)+0.1) * (r > 6.36e6);
  });
  RenderRequest q;
  q.volumes.push_back({&src, 0, Phase{}, glm::dvec3(0)});
  double R = 6378137;
  glm::dvec3 n = glm::normalize(glm::dvec3(1, 0.4, 0.5)), e = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), n));
  if (view == "ground") q.camera = {n * (R + 1.7 - 4970), n * (R - 4970) + e * 100000. + n * 30000., n, 1.2};
  if (view == "air") q.camera = {n * (R + 100000.), n * (R) + e * 500000., n, 1.0};
  if (view == "space") q.camera = {n * 2.5 * R, glm::dvec3(0), glm::dvec3(0, 0, 1), 1.0};
  if (view == "far") q.camera = {n * 1e9, glm::dvec3(0), glm::dvec3(0, 0, 1), 0.0145};
  q.sun.to_sun = glm::normalize(n + 0.5 * e);
  q.sky.up = n;
  q.sky.zenith_W_per_m2_sr_nm = glm::dvec3(0.03, 0.06, 0.13);
  q.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.08, 0.10, 0.13);
  q.sky.below_W_per_m2_sr_nm = glm::dvec3(0.05, 0.05, 0.05);
  q.settings.width = 320; q.settings.height = 180; q.settings.probe_pixels = 0;
  if (std::atof(argv[2]) >= 0) q.settings.step_voxels = std::atof(argv[2]);
  auto r = render(q);
  for (auto& p : r.report.passes) std::printf("%s %.3f; ", p.name.c_str(), p.cpu_s);
  for (auto& v : r.report.volumes) std::printf("nodes %lu bricks %lu const %lu empty %lu\n", v.nodes, v.bricks, v.constant_nodes, v.empty_nodes);
  double mean = 0, tau=0; float mx = 0; int bad=0;
  for (float x : r.image.rgb) { mean += x; mx = std::max(mx, x); bad += !std::isfinite(x);} 
  for (float x : r.image.optical_depth) tau += x;
  std::printf("mean %g max %g bad %d tau %g\n", mean / double(r.image.rgb.size()), mx, bad, tau/57600);
  std::ofstream f(argv[1]); f << "P6 320 180 255\n";
  for (float x : r.image.rgb) f.put(char(255 * std::pow(std::min(1.f, x * 4), 1 / 2.2f)));
}
