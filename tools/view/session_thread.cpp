// window: input, panel, files -> Wanted -> this: steps of a session -> picture, panel, news
#include "view/session_thread.h"

#include <algorithm>
#include <utility>

#include "core/log.h"

namespace nepho {
namespace {

// A step that waits for bricks looks so often whether there are any.
constexpr std::chrono::milliseconds kLook{10};
// Motion that a long step has missed is not caught up with.
constexpr double kLongestMove_s = 0.25;

void add(WindowInput& sum, const WindowInput& more) {
  const WindowInput before = std::exchange(sum, more);
  sum.turn_x += before.turn_x;
  sum.turn_y += before.turn_y;
  sum.scroll += before.scroll;
  sum.next_mode |= before.next_mode;
  sum.reset |= before.reset;
}

}  // namespace

SessionThread::SessionThread(Window& window, Options options)
    : options_(std::move(options)), thread_([this, &window] { run(window); }) {}

SessionThread::~SessionThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void SessionThread::open(OpenedScene opened, const std::string& name) {
  const std::lock_guard lock(mutex_);
  wanted_.opened = std::move(opened);
  wanted_.opened_name = name;
  ++posted_;
  wake_.notify_one();
}

void SessionThread::act(const WindowInput& input, double seconds) {
  const std::lock_guard lock(mutex_);
  if (!wanted_.input) wanted_.input.emplace();
  add(*wanted_.input, input);
  wanted_.seconds += seconds;
  ++posted_;
  wake_.notify_one();
}

void SessionThread::apply(const Panel& panel) {
  const std::lock_guard lock(mutex_);
  if (!panel.changed || !has_session_) return;
  const bool go = wanted_.panel && wanted_.panel->go;
  const bool typed = wanted_.panel && wanted_.panel->sun_utc_typed;
  if (!wanted_.panel) wanted_.panel_before = filled_;
  wanted_.panel = panel;
  filled_ = panel;
  wanted_.panel->go |= go;
  wanted_.panel->sun_utc_typed |= typed;
  wanted_.panel_number = ++panels_posted_;
  wanted_.panel_scene = filled_from_;
  ++posted_;
  wake_.notify_one();
}

void SessionThread::ask(Task task) {
  const std::lock_guard lock(mutex_);
  wanted_.tasks.push_back(std::move(task));
  ++posted_;
  wake_.notify_one();
}

void SessionThread::wait_until_handled() {
  std::unique_lock lock(mutex_);
  handled_one_.wait(lock, [&, all = posted_] { return ended_by_ || handled_ >= all; });
}

// What is typed, dragged or said in the window is its own.
bool SessionThread::fill(Panel& panel) {
  const std::lock_guard lock(mutex_);
  if (has_session_ && panels_used_ == panels_posted_) {
    Panel filled = panel_;
    filled.message = panel.message;
    filled.message_is_error = panel.message_is_error;
    filled.dragged_budget_mib = panel.dragged_budget_mib;
    filled.sun_utc_edited = panel.sun_utc_edited;
    if (panel.sun_utc_edited) filled.sun_utc = panel.sun_utc;
    if (filled_from_ == panel_of_) filled.go_to = panel.go_to;
    panel = std::move(filled);
    filled_from_ = panel_of_;
  } else if (has_session_) {  // what was changed is not there yet: it is not taken back
    panel.lines = panel_.lines;
    panel.error_line = panel_.error_line;
    panel.place = panel_.place;
    panel.busy = true;
  }
  panel.go = panel.sun_utc_typed = false;
  panel.changed = false;
  filled_ = panel;
  if (!fresh_) return false;
  picture_ = std::move(fresh_);
  return true;
}

bool SessionThread::has_session() const {
  const std::lock_guard lock(mutex_);
  return has_session_;
}
bool SessionThread::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}
bool SessionThread::at_rest() const {
  const std::lock_guard lock(mutex_);
  return at_rest_;
}
LiveStatus SessionThread::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}
std::optional<std::string> SessionThread::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}
std::vector<FrameTimes> SessionThread::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}
CameraPath SessionThread::recorded() const {
  const std::lock_guard lock(mutex_);
  return recorded_;
}

std::vector<SessionThread::News> SessionThread::take_news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

void SessionThread::add_news(News news) {
  const std::lock_guard lock(mutex_);
  news_.push_back(std::move(news));
}

void SessionThread::check() const {
  const std::lock_guard lock(mutex_);
  if (ended_by_) std::rethrow_exception(ended_by_);
}

void SessionThread::run(Window& window) {
  try {
    window.use_second_context();
    Wanted wanted;
    while (wait_for_wanted(wanted)) {
      if (wanted.input) {
        width_ = wanted.input->width;
        height_ = wanted.input->height;
      }
      if (wanted.opened) show(std::move(*wanted.opened), wanted.opened_name);
      do_tasks(wanted.tasks);
      if (steps_left()) step(wanted);
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    ended_by_ = std::current_exception();
  }
  before_.reset();  // while their context is current
  session_.reset();
  window.leave_second_context();
  handled_one_.notify_all();
}

bool SessionThread::steps_left() const {
  return session_ && width_ > 0 && !done_;
}

bool SessionThread::wait_for_wanted(Wanted& wanted) {
  std::unique_lock lock(mutex_);
  handled_ = taken_;
  handled_one_.notify_all();
  const auto something = [&] { return stop_ || wanted_.any(); };
  const bool flies = options_.replay && flown_ && (!options_.settle || at_rest_);
  if (!steps_left() || (at_rest_ && !flies))
    wake_.wait(lock, something);
  else if (!flies && !fresh_step_ && !session_->streaming())
    wake_.wait_for(lock, kLook, something);
  if (stop_) return false;
  wanted = std::exchange(wanted_, {});
  taken_ = posted_;
  return true;
}

void SessionThread::show(OpenedScene opened, const std::string& name) {
  try {
    auto session = std::make_unique<ViewSession>(std::move(opened), options_.coarse);
    session->reuse_pixels(options_.reuse);
    if (!before_) before_ = std::move(session_);
    session_ = std::move(session);
    ++scene_;
    log(LogLevel::kInfo, "opened " + name);
    const std::lock_guard lock(mutex_);
    fresh_.reset();
  } catch (const Error& error) {
    add_news({"", error});
  }
}

void SessionThread::do_tasks(const std::vector<Task>& tasks) {
  for (const Task& task : tasks) {
    if (!session_) continue;
    try {
      std::string text = task(*session_);
      if (!text.empty()) add_news({std::move(text), {}});
    } catch (const Error& error) {
      add_news({"", error});
    } catch (const std::exception& error) {
      add_news({"", Error({"the picture was not drawn", "", "", error.what(), ""})});
    }
  }
}

void SessionThread::step(const Wanted& wanted) {
  const auto now = Clock::now();
  const double cpu_s = thread_cpu_s();
  move(wanted);
  try {
    fresh_step_ = session_->advance(width_, height_);
  } catch (const Error& error) {
    if (!before_) throw;
    session_ = std::move(before_);
    ++scene_;
    add_news({"", error});
    return;
  }
  if (fresh_step_) before_.reset();
  publish(wanted);
  if (fresh_step_ || session_->status().failure) flown_ = true;
  if (flown_ || !options_.replay) note_step(now, cpu_s);
}

void SessionThread::move(const Wanted& wanted) {
  if (wanted.panel && wanted.panel_scene == scene_) try {
      session_->apply(*wanted.panel, wanted.panel_before);
    } catch (const Error& error) {
      add_news({"", error});
    }
  if (options_.replay) {
    const std::vector<Camera>& cameras = options_.replay->cameras;
    if (steps_ > 0 && (!options_.settle || at_rest_) && camera_ + 1 < cameras.size()) ++camera_;
    session_->set_camera(cameras[camera_]);
  } else if (wanted.input) {
    session_->act(*wanted.input, std::min(wanted.seconds, kLongestMove_s));
  }
}

void SessionThread::note_step(Clock::time_point begin, double cpu_s) {
  const std::lock_guard lock(mutex_);
  if (options_.times && steps_ > 0) {  // of the step before, all of it
    times_.back().gap_ms = 1e3 * std::chrono::duration<double>(begin - last_).count();
    times_.back().cpu_ms = 1e3 * (cpu_s - last_cpu_s_);
  }
  last_ = begin;
  last_cpu_s_ = cpu_s;
  if (options_.times) times_.push_back({});
  if (options_.times && fresh_step_) times_.back().passes = status_.passes;
  if (options_.record) recorded_.cameras.push_back(session_->camera());
  ++steps_;
  done_ = options_.settle ? camera_ + 1 == options_.replay->cameras.size() && at_rest_
                          : options_.most_steps > 0 && steps_ >= options_.most_steps;
}

void SessionThread::publish(const Wanted& wanted) {
  Panel panel;
  session_->fill(panel);
  std::shared_ptr<const ByteImage> picture;
  if (fresh_step_) picture = std::make_shared<const ByteImage>(session_->picture());
  const std::lock_guard lock(mutex_);
  panel_ = std::move(panel);
  panel_of_ = scene_;
  if (wanted.panel) panels_used_ = wanted.panel_number;
  if (picture) fresh_ = std::move(picture);
  has_session_ = true;
  at_rest_ = session_->at_rest();
  status_ = session_->status();
  error_.reset();
  if (session_->error()) error_ = session_->error_text();
}

}  // namespace nepho
