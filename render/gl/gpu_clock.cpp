#include "gl/gpu_clock.h"

#include <array>
#include <chrono>
#include <string_view>

namespace nepho::gl {
namespace {

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool runs_on_the_cpu(std::string_view renderer) {
  constexpr std::array<std::string_view, 4> kNames = {"llvmpipe", "softpipe", "SwiftShader",
                                                      "software"};
  for (const std::string_view name : kNames)
    if (renderer.find(name) != std::string_view::npos) return true;
  return false;
}

}  // namespace

const char* GpuClock::why_not() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (name && runs_on_the_cpu(name)) return "the OpenGL device is a rasteriser on the CPU";
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  return bits > 0 ? nullptr : "the OpenGL device has no TIMESTAMP queries";
}

GpuClock::GpuClock() {
  if (why_not()) return;
  glGenQueries(GLsizei(queries_.size()), queries_.data());
  wall_start_s_ = wall_s();
  glQueryCounter(queries_[0], GL_TIMESTAMP);
}

GpuClock::~GpuClock() {
  if (queries_[0]) glDeleteQueries(GLsizei(queries_.size()), queries_.data());
}

double GpuClock::stop_s() {
  if (!queries_[0]) return -1;
  glQueryCounter(queries_[1], GL_TIMESTAMP);
  GLuint64 first_ns = 0, last_ns = 0;
  glGetQueryObjectui64v(queries_[0], GL_QUERY_RESULT, &first_ns);
  glGetQueryObjectui64v(queries_[1], GL_QUERY_RESULT, &last_ns);
  // A few microseconds lie between the two clocks' readings.
  constexpr double kReading_s = 1e-3;
  const double spent_s = 1e-9 * (double(last_ns) - double(first_ns));
  return spent_s > 0 && spent_s <= wall_s() - wall_start_s_ + kReading_s ? spent_s : -1;
}

}  // namespace nepho::gl
