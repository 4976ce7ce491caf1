#include "gl/view_pass.h"

#include <algorithm>
#include <span>
#include <vector>

#include "gl/pixel_strides.h"

namespace nepho::gl {
namespace {

constexpr GLuint kPixelBinding = 5;  // the lit records' in the light passes
constexpr std::size_t kPixelsEach =
    65536;  // per dispatch, so that a slow device is not held for long

// Marches pixels and returns what was found, in their order.
PixelValues march(const Program& program, std::span<const std::uint32_t> list, int width,
                  const PixelValues& values) {
  PixelValues found;
  found.seen.reserve(list.size());
  found.met.reserve(list.size());
  glUseProgram(program.id());
  std::vector<PixelTexel> entries;
  for (std::size_t begin = 0; begin < list.size(); begin += kPixelsEach) {
    const std::size_t count = std::min(kPixelsEach, list.size() - begin);
    entries.assign(2 * count, {});
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t p = list[begin + i], w = std::uint32_t(width);
      entries[2 * i + 1] = {float(p % w), float(p / w),
                            values.met.empty() ? kNoGround_m : values.met[p][3], 0};
    }
    const Buffer buffer{std::span<const PixelTexel>(entries)};
    buffer.bind(kPixelBinding);
    glDispatchCompute(GLuint((count + 63) / 64), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer.id(), 0, GLsizeiptr(buffer.bytes()), entries.data());
    for (std::size_t i = 0; i < count; ++i) {
      found.seen.push_back(entries[2 * i]);
      found.met.push_back(entries[2 * i + 1]);
    }
  }
  return found;
}

// All of them, by blocks of neighbours.
std::vector<std::uint32_t> all_pixels(int width, int height) {
  constexpr int kBlock = 8;
  std::vector<std::uint32_t> list;
  list.reserve(std::size_t(width) * std::size_t(height));
  for (int by = 0; by < height; by += kBlock)
    for (int bx = 0; bx < width; bx += kBlock)
      for (int y = by; y < std::min(by + kBlock, height); ++y)
        for (int x = bx; x < std::min(bx + kBlock, width); ++x)
          list.push_back(std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x));
  return list;
}

std::string why_all(const RenderRequest& request) {
  const RenderSettings& settings = request.settings;
  if (settings.pixels == WhichPixels::kAll) return "the scene says so";
  if (!request.planet) return "there is no planet: pixels without cloud cost nothing";
  if (settings.step_voxels) return "steps are fixed, and no tolerance is given";
  if (request.leave_nothing_out) return "nothing is left out";
  return {};
}

}  // namespace

ViewReport march_view(const RenderRequest& request, const Forest& forest, const Program& program,
                      PixelValues& values) {
  const int width = request.settings.width, height = request.settings.height;
  ViewReport report;
  report.why_all = why_all(request);
  if (report.why_all.empty()) {
    PixelPlan plan({width, height, request.settings.tolerance, pixel_strides(request, forest)},
                   values);
    if (!plan.saves_little()) {
      values.seen.resize(values.met.size());
      PixelValues found;
      for (auto list = plan.next(found, values); !list.empty(); list = plan.next(found, values))
        found = march(program, list, width, values);
      report.interpolates = true;
      report.marched_share = plan.marched_share();
      report.predicted_rms = plan.predicted_rms();
      report.checks = plan.checks();
      return report;
    }
    report.why_all = "the smallest voxels are no wider than a pixel, or the picture is small";
  }
  const std::vector<std::uint32_t> list = all_pixels(width, height);
  const PixelValues found = march(program, list, width, values);
  values.seen.resize(list.size());
  values.met.resize(list.size());
  for (std::size_t n = 0; n < list.size(); ++n) {
    values.seen[list[n]] = found.seen[n];
    values.met[list[n]] = found.met[n];
  }
  return report;
}

}  // namespace nepho::gl
