#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/open_scene.h"
#include "image/image.h"
#include "live/live_renderer.h"
#include "view/flight.h"
#include "view/view_sun.h"
#include "view/window_module.h"

namespace nepho {

// A scene that is open and flown through. Needs the OpenGL context that was current when it was
// made; throws Error where the budget is too small.
class ViewSession {
 public:
  // `coarse`: while something changes, a frame has every so many'th pixel of the window, 1, 2, 4 or
  // 8; 0: as the device can bear.
  ViewSession(OpenedScene opened, int coarse);

  // What the user did, and what he changed in the panel that fill() was called for; throws Error
  // where that cannot be, and nothing else of it counts then.
  void act(const WindowInput& input, double seconds);
  // `before`: what it was when the user changed it; what he left alone may be of an earlier step.
  void apply(const Panel& panel, const Panel& before);
  void reuse_pixels(bool reuse);
  void set_camera(const Camera& camera);  // replayed
  // One step of streaming, and a new picture where there is one. True where it is new.
  bool advance(int width, int height);

  const ByteImage& picture() const { return picture_; }
  const Camera& camera() const { return flight_.camera(); }
  const LiveStatus& status() const { return status_; }
  bool at_rest() const { return live_->at_rest() && live_->whole(); }
  bool streaming() const { return live_->streaming(); }
  // Of the picture: none while it moves, and for a while after.
  const std::optional<ErrorEstimate>& error() const { return error_; }
  // The line that `render` prints, or why there is none.
  std::string error_text() const;
  bool awaits_error() const;
  void fill(Panel& panel) const;
  // The scene as it is seen now, to be drawn in this size. Its sources stay here.
  OpenedScene as_seen(int width, int height) const;

 private:
  RenderRequest everything(int width, int height) const;
  RenderRequest wanted(int width, int height) const;
  void make_live(const RenderRequest& request);
  LocalAxes axes() const;
  void set_time(int index);
  void set_budget(double budget_mib);
  void update_error();
  void choose_coarseness(double frame_ms);

  OpenedScene opened_;
  std::vector<bool> shown_;  // by volume
  int time_ = 0;
  std::size_t timed_ = 0;  // the volume whose times the slider has
  Flight flight_;
  ViewSun sun_;
  bool reuse_ = true;
  bool fixed_coarse_;
  int coarse_, each_ = 1;     // of the next picture; of the one that is being made
  int slow_ = 0, quick_ = 0;  // frames in a row
  std::optional<double> exposure_ev_;
  bool exposure_found_ = false;  // and may be found again in a better picture
  bool moved_ = false;           // away from the scene's camera
  std::unique_ptr<LiveRenderer> live_;
  LiveStatus status_;
  std::optional<ErrorEstimate> error_;
  std::string error_failure_;
  ByteImage picture_;
  double frame_ms_ = 0;
  bool show_again_ = false;  // the picture that is there, otherwise exposed
  HdrImage frame_;
};

}  // namespace nepho
