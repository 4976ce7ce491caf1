// EGL without a display: device platform (hardware before software), then Mesa's surfaceless one.
// eglGetDisplay(EGL_DEFAULT_DISPLAY) is not tried: it needs a window system.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <vector>

#include "common/gl_context.h"
#include "core/error.h"

namespace nepho {
namespace {

std::string egl_error() {
  std::ostringstream text;
  text << "EGL error 0x" << std::hex << eglGetError();
  return text.str();
}

class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context, std::string way)
      : display_(display), context_(context) {
    // By hand: epoxy's headers and EGL's own do not go together in one file.
    const auto get_string =
        reinterpret_cast<const unsigned char* (*)(unsigned)>(eglGetProcAddress("glGetString"));
    constexpr unsigned kRenderer = 0x1F01, kVersion = 0x1F02;
    const auto text = [&](unsigned name) {
      const auto* value = get_string ? get_string(name) : nullptr;
      return std::string(value ? reinterpret_cast<const char*>(value) : "?");
    };
    text_ = way + ", " + text(kRenderer) + ", OpenGL " + text(kVersion);
  }
  ~EglContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }
  std::string description() const override { return text_; }

 private:
  EGLDisplay display_;
  EGLContext context_;
  std::string text_;
};

// Null, and why in `failure`.
std::unique_ptr<GlContext> try_display(EGLDisplay display, const std::string& way,
                                       std::string& failure) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
    failure = "no display (" + egl_error() + ")";
    return nullptr;
  }
  constexpr EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                    4,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_NONE};
  EGLContext context = EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) {
    failure = "no desktop OpenGL (" + egl_error() + ")";
  } else if (context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes);
             context == EGL_NO_CONTEXT) {
    failure = "no OpenGL 4.5 core context (" + egl_error() + ")";
  } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    failure = "context without a surface refused (" + egl_error() + ")";
    eglDestroyContext(display, context);
  } else {
    return std::make_unique<EglContext>(display, context, way);
  }
  eglTerminate(display);
  return nullptr;
}

struct Way {
  EGLenum platform;
  void* native;
  std::string name;
};

bool has_extension(const char* list, const char* name) {
  return list && std::strstr(list, name) != nullptr;
}

// Devices, hardware first, then the surfaceless platform.
std::vector<Way> ways() {
  std::vector<Way> result;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto device_string = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      eglGetProcAddress("eglQueryDeviceStringEXT"));
  if (has_extension(client, "EGL_EXT_platform_device") && query_devices && device_string) {
    std::vector<EGLDeviceEXT> devices(16);
    EGLint count = 0;
    if (!query_devices(EGLint(devices.size()), devices.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const char* extensions = device_string(devices[std::size_t(i)], EGL_EXTENSIONS);
      const bool software = has_extension(extensions, "EGL_MESA_device_software");
      result.push_back({EGL_PLATFORM_DEVICE_EXT, devices[std::size_t(i)],
                        "EGL device " + std::to_string(i) + (software ? " (software)" : "")});
    }
    std::ranges::stable_partition(
        result, [](const Way& way) { return way.name.find("software") == std::string::npos; });
  }
  if (has_extension(client, "EGL_MESA_platform_surfaceless"))
    result.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "EGL surfaceless"});
  return result;
}

}  // namespace

std::unique_ptr<GlContext> make_egl_context() {
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  std::string tried;
  for (const Way& way : ways()) {
    if (!get_display) break;
    std::string failure;
    if (auto context =
            try_display(get_display(way.platform, way.native, nullptr), way.name, failure))
      return context;
    tried += (tried.empty() ? "" : "; ") + way.name + ": " + failure;
  }
  throw Error({.what = "no usable OpenGL",
               .where = {},
               .expected = "an OpenGL 4.5 core context through EGL",
               .found = tried.empty() ? "no EGL device and no surfaceless platform" : tried,
               .hint = "install a driver, or Mesa's software one (libegl-mesa0, libgl1-mesa-dri)"});
}

}  // namespace nepho
