#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "view/camera_path.h"
#include "view/view_session.h"

namespace nepho {

// A session on a thread and an OpenGL context of its own: what it compiles, uploads, marches and
// saves never holds up the window, which shows the newest picture that there is. A step is what was
// done since the last one, an update, and a picture where there is a new one.
class SessionThread {
 public:
  struct Options {
    int coarse = 0;                      // as ViewSession
    std::optional<CameraPath> replay;    // a camera a step, in place of what is done in the window
    bool settle = false;                 // a camera of it stays until nothing is to come
    int most_steps = 0;                  // then it stands still; 0: no end
    bool record = false, times = false;  // kept, of each step
    bool reuse = true;                   // of pixels of the last pictures
  };
  // `window` has the context, and outlives this. Throws nothing: see check().
  SessionThread(Window& window, Options options);
  ~SessionThread();

  // Takes the place of the scene before, which stays where this one cannot be shown (take_news()).
  void open(OpenedScene opened, const std::string& name);
  // What a user did in `seconds`, in a window of `input`'s size; what of it is not used by the next
  // step is added up.
  void act(const WindowInput& input, double seconds);
  void apply(const Panel& panel);
  // Between two steps; what it returns (but for nothing) or throws becomes news.
  void ask(std::function<std::string(ViewSession&)> task);
  void wait_until_handled();  // all that was told before

  // All but what a user has just changed in the panel. True where the picture is a new one.
  bool fill(Panel& panel);
  const ByteImage& picture() const { return *picture_; }
  bool has_session() const;
  bool done() const;  // most_steps were made, the path is at its end
  bool at_rest() const;
  LiveStatus status() const;
  std::optional<std::string> error() const;  // the error line, once it is known
  // Of the steps; only once it is done, or stands still.
  std::vector<FrameTimes> times() const;
  CameraPath recorded() const;

  struct News {
    std::string text;
    std::optional<Error> error;
  };
  std::vector<News> take_news();
  // Throws what ended the thread.
  void check() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Task = std::function<std::string(ViewSession&)>;

  // What crosses from the window.
  struct Wanted {
    std::optional<OpenedScene> opened;
    std::string opened_name;
    std::optional<WindowInput> input;
    double seconds = 0;
    std::optional<Panel> panel;
    Panel panel_before;
    std::uint64_t panel_number = 0, panel_scene = 0;  // how many before it, and of which scene
    std::vector<Task> tasks;
    bool any() const { return opened || input || panel || !tasks.empty(); }
  };
  void run(Window& window);
  bool wait_for_wanted(Wanted& wanted);  // false: the end
  bool steps_left() const;
  void show(OpenedScene opened, const std::string& name);
  void move(const Wanted& wanted);
  void do_tasks(const std::vector<Task>& tasks);
  void step(const Wanted& wanted);
  void note_step(Clock::time_point begin, double cpu_s);
  void publish(const Wanted& wanted);
  void add_news(News news);

  const Options options_;
  mutable std::mutex mutex_;
  std::condition_variable wake_, handled_one_;
  Wanted wanted_;
  bool stop_ = false;
  std::uint64_t posted_ = 0, taken_ = 0, handled_ = 0;  // numbers of what crossed
  std::exception_ptr ended_by_;
  std::vector<News> news_;
  // What crosses to the window.
  Panel panel_;
  std::uint64_t panels_used_ = 0, panel_of_ = 0;  // the latter: the number of its scene
  std::shared_ptr<const ByteImage> fresh_;        // not yet shown
  bool has_session_ = false, at_rest_ = false, done_ = false;
  LiveStatus status_;
  std::optional<std::string> error_;
  std::vector<FrameTimes> times_;
  CameraPath recorded_;

  // Of the window's thread only.
  std::shared_ptr<const ByteImage> picture_ = std::make_shared<ByteImage>();
  std::uint64_t panels_posted_ = 0, filled_from_ = 0;  // the latter: a scene
  Panel filled_;                                       // what a change is told from

  // Of the session's thread only.
  // The scene before stays until there is a picture of the next.
  std::unique_ptr<ViewSession> session_, before_;
  std::uint64_t scene_ = 0;     // its number
  int width_ = 0, height_ = 0;  // of the window
  bool fresh_step_ = false;     // the last one made a picture
  bool flown_ = false;          // a path begins once there is something to see
  int steps_ = 0;
  std::size_t camera_ = 0;  // of the replay
  Clock::time_point last_;
  double last_cpu_s_ = 0;
  std::thread thread_;
};

}  // namespace nepho
