#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nepho {

// What crosses to the run-time module that knows GLFW and Dear ImGui: the program opens it for
// `view` only, and links neither. Built by the same compiler, as source modules are.

inline constexpr std::uint32_t kWindowModuleVersion = 2;

// What a user did since the last frame.
struct WindowInput {
  int width = 0, height = 0;  // of the window, pixels
  bool close = false;
  double right = 0, up = 0, forward = 0;  // keys held, -1 to 1 each
  double faster = 1;                      // a factor, while shift or control is held
  double turn_x = 0, turn_y = 0;          // pixels that the mouse was dragged, y downwards
  double scroll = 0;                      // notches
  bool screenshot = false, next_mode = false, reset = false, hide = false;
  std::vector<std::string> dropped;
};

// What the panel shows, and what it changes. `changed` is set where a user changed something.
struct Panel {
  std::string scene, message;
  bool message_is_error = false;
  std::vector<std::string> lines;  // passes, bricks, bytes
  std::string error_line;          // of the picture, or why there is none
  bool hidden = false;             // all but the message
  int mode = 0;                    // of flight: free, orbit, first person
  double exposure_ev = 0, tolerance = 0.01, step_voxels = 0, pixels_per_voxel = 1;
  bool fixed_step = false;
  double budget_mib = 0, dragged_budget_mib = 0;  // in force; while the slider is held
  // The sun as at a date, where there is a planet, or free: angles under the camera.
  bool planet = false, sun_dated = false;
  std::array<char, 32> sun_utc{};  // as utc_text() writes it; what was typed counts with
  bool sun_utc_typed = false;      // this
  bool sun_utc_edited = false;     // not to be overwritten
  double sun_hour = 0;             // of that day
  double sun_azimuth_deg = 0, sun_elevation_deg = 0;
  // Where the camera is, and where it is to go: over a planet.
  struct Place {
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
  };
  Place place;
  std::optional<Place> go_to;  // as typed so far
  bool go = false;
  struct Volume {
    std::string name;
    bool shown = true;
  };
  std::vector<Volume> volumes;
  int time = 0, times = 1;
  std::string time_text;
  bool busy = false;  // bricks or light are still to come
  bool changed = false;
};

class Window {
 public:
  virtual ~Window() = default;
  // `wait_s`: for something to happen, at most.
  virtual WindowInput poll(double wait_s) = 0;
  // Draws a picture of 8-bit RGB over the whole window (none: black), the panel over it, and shows
  // both.
  virtual void show(const std::uint8_t* rgb, int width, int height, Panel& panel) = 0;
  virtual std::string description() const = 0;  // of the OpenGL context
  virtual void set_size(int width, int height) = 0;
  // A second context, of the same device and sharing nothing with the window's: current on the
  // thread that calls it, until the same thread leaves it.
  virtual void use_second_context() = 0;
  virtual void leave_second_context() = 0;
};

struct WindowModule {
  std::uint32_t version;
  // A window with a current OpenGL 4.5 core context, or null and a text: what failed, and what was
  // found instead, by lines.
  Window* (*open)(int width, int height, const char* title, char* what, std::size_t what_size,
                  char* found, std::size_t found_size);
};

}  // namespace nepho

// What the module exports: const nepho::WindowModule* nepho_window_module();
extern "C" {
using nepho_window_module_fn = const nepho::WindowModule*();
}
