#include <epoxy/gl.h>
// After epoxy: GLFW then leaves OpenGL's names to it.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <dlfcn.h>
#include <imgui.h>
#include <link.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "view/window/panel.h"
#include "view/window_module.h"

namespace nepho {
namespace {

std::string last_error;
void note_error(int, const char* text) {
  last_error = text;
}

class GlfwWindow final : public Window {
 public:
  GlfwWindow(GLFWwindow* window, GLFWwindow* second) : window_(window), second_(second) {
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    // A key that was let go before a slow frame's end still counts in it.
    glfwSetInputMode(window_, GLFW_STICKY_KEYS, GLFW_TRUE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
      auto* self = static_cast<GlfwWindow*>(glfwGetWindowUserPointer(w));
      self->input_.dropped.assign(paths, paths + count);
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
      auto* self = static_cast<GlfwWindow*>(glfwGetWindowUserPointer(w));
      if (action != GLFW_PRESS) return;
      if (ImGui::GetIO().WantTextInput) return;  // it is typed into the panel
      if (key == GLFW_KEY_F12) self->input_.screenshot = true;
      if (key == GLFW_KEY_M) self->input_.next_mode = true;
      if (key == GLFW_KEY_R) self->input_.reset = true;
      if (key == GLFW_KEY_H) self->input_.hide = true;
      if (key == GLFW_KEY_ESCAPE) self->input_.close = true;
    });
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;         // nothing is left behind in the user's folder
    ImGui_ImplGlfw_InitForOpenGL(window_, true);  // after the callbacks: it calls them
    ImGui_ImplOpenGL3_Init("#version 450");
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  ~GlfwWindow() override {
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(second_);
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  WindowInput poll(double wait_s) override {
    if (wait_s > 0)
      glfwWaitEventsTimeout(wait_s);
    else
      glfwPollEvents();
    input_.close = input_.close || glfwWindowShouldClose(window_);
    glfwGetFramebufferSize(window_, &input_.width, &input_.height);
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantCaptureKeyboard) {
      const auto held = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0 : 0.0; };
      input_.right = held(GLFW_KEY_D) - held(GLFW_KEY_A);
      input_.up = held(GLFW_KEY_E) - held(GLFW_KEY_Q);
      input_.forward = held(GLFW_KEY_W) - held(GLFW_KEY_S);
      input_.faster = held(GLFW_KEY_LEFT_SHIFT) > 0     ? 8
                      : held(GLFW_KEY_LEFT_CONTROL) > 0 ? 0.125
                                                        : 1;
    }
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    if (!io.WantCaptureMouse) {
      if (glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        input_.turn_x = x - last_x_;
        input_.turn_y = y - last_y_;
      }
      input_.scroll = double(io.MouseWheel);
    }
    last_x_ = x;
    last_y_ = y;
    WindowInput input;
    std::swap(input, input_);
    return input;
  }

  void show(const std::uint8_t* rgb, int width, int height, Panel& panel) override {
    int across = 0, down = 0;
    glfwGetFramebufferSize(window_, &across, &down);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, across, down);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (rgb && width > 0) {
      glBindTexture(GL_TEXTURE_2D, texture_);
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb);
      ImGui::GetBackgroundDrawList()->AddImage(ImTextureID(std::intptr_t(texture_)), {0, 0},
                                               ImGui::GetIO().DisplaySize);
    }
    draw_panel(panel);
    ImGui::Render();
    // Dear ImGui puts back the program that it finds, and that of a scene before this one, which is
    // in use though deleted, would then be gone.
    glUseProgram(0);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
  }

  std::string description() const override {
    return "GLFW " + std::string(glfwGetVersionString()) + ", " +
           reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  }
  void set_size(int width, int height) override { glfwSetWindowSize(window_, width, height); }
  void use_second_context() override { glfwMakeContextCurrent(second_); }
  void leave_second_context() override { glfwMakeContextCurrent(nullptr); }

 private:
  GLFWwindow *window_, *second_;  // the latter is never seen
  GLuint texture_ = 0;
  WindowInput input_;
  double last_x_ = 0, last_y_ = 0;
};

// What OpenGL there is, where 4.5 is not.
std::string found_opengl() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(16, 16, "", nullptr, nullptr);
  if (!window) return "no OpenGL at all: " + last_error;
  glfwMakeContextCurrent(window);
  const std::string text = std::string("OpenGL ") +
                           reinterpret_cast<const char*>(glGetString(GL_VERSION)) + ", " +
                           reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  glfwDestroyWindow(window);
  return text;
}

// Mesa 22.3 loses 112 bytes when its driver is unloaded, which no list of a leak checker can name
// then: it stays for as long as the program does.
void keep_driver() {
  std::vector<std::string> drivers;
  dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* list) {
        if (std::strstr(library->dlpi_name, "_dri.so"))
          static_cast<std::vector<std::string>*>(list)->emplace_back(library->dlpi_name);
        return 0;
      },
      &drivers);
  for (const std::string& driver : drivers)
    if (void* handle = dlopen(driver.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE))
      dlclose(handle);
}

Window* open_window(int width, int height, const char* title, char* what, std::size_t what_size,
                    char* found, std::size_t found_size) {
  glfwSetErrorCallback(note_error);
  const auto refuse = [&](const char* reason, const std::string& instead) -> Window* {
    std::snprintf(what, what_size, "%s", reason);
    std::snprintf(found, found_size, "%s", instead.c_str());
    glfwTerminate();
    return nullptr;
  };
  if (!glfwInit()) return refuse("there is no display to open a window on", last_error);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* window = glfwCreateWindow(width, height, title, nullptr, nullptr);
  if (!window) return refuse("the display has no OpenGL 4.5 core", found_opengl());
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* second = glfwCreateWindow(16, 16, "", nullptr, nullptr);
  if (!second) return refuse("the display has no second OpenGL context", last_error);
  keep_driver();
  return new GlfwWindow(window, second);
}

constexpr WindowModule kModule{kWindowModuleVersion, open_window};

}  // namespace
}  // namespace nepho

extern "C" __attribute__((visibility("default"))) const nepho::WindowModule* nepho_window_module() {
  return &nepho::kModule;
}
