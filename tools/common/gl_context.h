#pragma once

#include <memory>
#include <string>

namespace nepho {

// An OpenGL 4.5 core context without a display, current on the thread that made it.
class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual std::string description() const = 0;  // which way, and the device
};

// EGL device platform, hardware before software, then surfaceless. Throws Error that lists what
// was tried and what each said.
std::unique_ptr<GlContext> make_egl_context();

}  // namespace nepho
