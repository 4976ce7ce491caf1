#include "gl/pixel_march.h"

#include <algorithm>

namespace nepho::gl {
namespace {

constexpr GLuint kPixelBinding = 5;  // the lit records' in the light passes
constexpr std::size_t kPixelsEach =
    65536;  // per dispatch, so that a slow device is not held for long

// As the shaders' PixelBuffer.
using Entry = std::array<PixelTexel, 3>;
constexpr float kWhole = 0, kBehindFront = 1, kFrontOnly = 2;

// Rays entry_of(0) to entry_of(size - 1).
template <typename EntryOf>
PixelValues dispatch(const Program& program, std::size_t size, bool depths,
                     const EntryOf& entry_of) {
  PixelValues found;
  found.seen.reserve(size);
  found.met.reserve(size);
  glUseProgram(program.id());
  std::vector<Entry> entries;
  for (std::size_t begin = 0; begin < size; begin += kPixelsEach) {
    const std::size_t count = std::min(kPixelsEach, size - begin);
    entries.resize(count);
    for (std::size_t i = 0; i < count; ++i) entries[i] = entry_of(begin + i);
    const Buffer buffer{std::span<const Entry>(entries)};
    buffer.bind(kPixelBinding);
    glDispatchCompute(GLuint((count + 63) / 64), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer.id(), 0, GLsizeiptr(buffer.bytes()), entries.data());
    for (const Entry& entry : entries) {
      found.seen.push_back(entry[0]);
      found.met.push_back(entry[1]);
      if (depths) found.depths.push_back(entry[2]);
    }
  }
  return found;
}

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
                         const PixelValues& values, const FrontAir* front, bool depths) {
  return dispatch(program, list.size(), depths, [&](std::size_t n) {
    const std::uint32_t p = list[n], w = std::uint32_t(width);
    const float ground_m = values.met.empty() ? kNoGround_m : values.met[p][3];
    Entry entry{PixelTexel{}, PixelTexel{float(p % w), float(p / w), ground_m, kWhole}};
    FrontAir::Air air;
    if (front && front->at(p, air)) {
      const auto &light = air.radiance, &passed = air.transmittance;
      entry[0] = {light[0], light[1], light[2], 0};
      entry[1][3] = kBehindFront;
      entry[2] = {passed[0], passed[1], passed[2], 0};
    }
    return entry;
  });
}

void march_front(const Program& program, FrontAir& front) {
  const auto places = front.places();
  front.set(dispatch(program, places.size(), false, [&](std::size_t n) {
    return Entry{PixelTexel{},
                 PixelTexel{float(places[n][0]), float(places[n][1]), kNoGround_m, kFrontOnly}};
  }));
}

}  // namespace nepho::gl
