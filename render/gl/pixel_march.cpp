#include "gl/pixel_march.h"

#include <algorithm>

namespace nepho::gl {
namespace {

constexpr GLuint kPixelBinding = 5;  // the lit records' in the light passes
constexpr std::size_t kPixelsEach =
    65536;  // per dispatch, so that a slow device is not held for long

}  // namespace

std::string why_all_pixels(const RenderRequest& request) {
  const RenderSettings& settings = request.settings;
  if (settings.pixels == WhichPixels::kAll) return "the scene says so";
  if (!request.planet) return "there is no planet: pixels without cloud cost nothing";
  if (settings.step_voxels) return "steps are fixed, and no tolerance is given";
  if (request.leave_nothing_out) return "nothing is left out";
  return {};
}

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

PixelValues march_pixels(const Program& program, std::span<const std::uint32_t> list, int width,
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

}  // namespace nepho::gl
