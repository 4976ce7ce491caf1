#include "gl/picture.h"

#include <ctime>

#include "gl/gpu_clock.h"
#include "gl/object.h"

namespace nepho::gl {
namespace {

double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

void timed(std::vector<PassReport>& passes, const char* name, const std::function<void()>& work) {
  const double before_s = process_cpu_s();
  GpuClock clock;
  work();
  const double gpu_s = clock.stop_s();
  glFinish();
  check_errors(name);
  passes.push_back({name, process_cpu_s() - before_s, gpu_s});
}

HdrImage picture_of(const PixelValues& values, int width, int height) {
  HdrImage image;
  image.width = width;
  image.height = height;
  const std::size_t pixels = values.seen.size();
  image.rgb.resize(3 * pixels);
  image.optical_depth.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * p + c] = values.seen[p][c];
    image.optical_depth[p] = values.seen[p][3];
  }
  return image;
}

}  // namespace nepho::gl
