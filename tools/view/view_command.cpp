// nephoscope view: window, session, files that are opened beside it.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <future>
#include <thread>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/saved_picture.h"
#include "cli/scene_input.h"
#include "cli/values.h"
#include "common/open_scene.h"
#include "common/output_file.h"
#include "core/error.h"
#include "core/log.h"
#include "scene/scene_file.h"
#include "view/camera_path.h"
#include "view/session_thread.h"
#include "view/window_loader.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What there is where nothing is named.
constexpr const char* kPlanet = R"({
  "name": "the procedural planet",
  "volumes": [{"name": "sky", "source": "noise", "parameters": {"seed": 3}}],
  "sun": {"utc": "2024-05-10T17:00:00Z"},
  "camera": {"look_from": {"lat_deg": -19.7, "lon_deg": -35.2, "height_m": 12000},
             "look_at": {"lat_deg": -20.0, "lon_deg": -35.45, "height_m": 2000}, "fov_deg": 45}
})";

// From one frame of the window to the next: after a new picture, while more is to come, and at
// rest. Whoever reads, refines or marches has the processor meanwhile.
constexpr double kNext_s = 0.008, kBusy_s = 0.02, kRest_s = 0.05;

class Viewer {
 public:
  explicit Viewer(const ViewOptions& options);
  void run();

 private:
  glm::ivec2 first_size() const;
  SessionThread::Options session_options() const;
  void open(const RenderOptions& options);
  void take_opened();
  void take_news();
  void drop(const std::vector<std::string>& files);
  void say(const std::string& text, bool error);
  void refuse(const Error& error);
  void save(std::optional<fs::path> output);
  void tell_last(bool must_succeed);
  fs::path free_name() const;
  double wait_s() const;
  bool frame();  // false: the end
  std::string await_error();
  void report();

  const ViewOptions& options_;
  PictureFiles pictures_;
  SourceHost host_;
  std::optional<CameraPath> replay_;
  int most_frames_ = 0, coarse_ = 0;
  glm::ivec2 size_{960, 540};  // of the window at first, and of pictures that are saved
  glm::ivec2 across_{0};       // of the window now
  std::unique_ptr<Window> window_;
  std::unique_ptr<SessionThread> session_;  // before the window in destruction
  std::future<OpenedScene> opening_;
  bool stands_in_ = false;    // the planet, where what was asked for could not be shown
  bool sized_ = false;        // the window, for the first scene
  bool scene_given_ = false;  // the session has one, or is about to
  std::string opening_name_;
  Panel panel_;
  bool hidden_ = false, fresh_ = false;  // the panel; the picture that was shown last
  std::string told_;                     // the last error line in the log
  std::vector<FrameTimes> gaps_;         // of the window, while they are counted
  Clock::time_point last_;
  double last_cpu_s_ = 0;
};

Viewer::Viewer(const ViewOptions& options)
    : options_(options), pictures_(default_module_folders()), host_(default_module_folders()) {
  if (options.render.target_error || options.render.target_ms)
    throw Error({"a view that moves keeps no target",
                 options.render.target_error ? "--target-error" : "--target-ms", "--tolerance", "",
                 "nephoscope render chooses settings for a target"});
  if (options.path) replay_ = read_camera_path(*options.path);
  if (options.frames) most_frames_ = int(number_value("--frames", *options.frames));
  if (options.coarse) coarse_ = int(number_value("--coarse", *options.coarse));
  if (options.frames && most_frames_ < 1)
    throw Error({"bad value", "--frames", "a number of frames from 1 on", *options.frames, ""});
  if (options.coarse && coarse_ != 1 && coarse_ != 2 && coarse_ != 4 && coarse_ != 8)
    throw Error({"bad value", "--coarse", "1, 2, 4 or 8", *options.coarse, ""});
  if (replay_) most_frames_ = int(replay_->cameras.size());
  size_ = first_size();
  window_ = open_window(default_module_folders(), size_.x, size_.y, "Nephoscope");
  log(LogLevel::kInfo, window_->description());
  panel_.scene = "opening";
  panel_.busy = true;
  constexpr std::array<std::uint8_t, 3> kBlack{};
  for (int twice = 0; twice < 2; ++twice)  // compiles: before anything else is on the way
    window_->show(kBlack.data(), 1, 1, panel_);
  session_ = std::make_unique<SessionThread>(*window_, session_options());
  open(options.render);
}

// What is known before anything large is read: pictures may take long to say theirs.
glm::ivec2 Viewer::first_size() const {
  const RenderOptions& render = options_.render;
  if (render.size) return size_value("--size", *render.size);
  const auto is_picture = [](const std::string& file) {
    return input_kind(file) == InputKind::kPicture;
  };
  try {
    if (render.inputs.empty() || std::ranges::any_of(render.inputs, is_picture)) return size_;
    const RenderSettings settings = scene_from(render, pictures_).render;
    return {settings.width, settings.height};
  } catch (const Error&) {  // told where it is opened
    return size_;
  }
}

SessionThread::Options Viewer::session_options() const {
  return {coarse_,
          replay_,
          options_.settle,
          most_frames_,
          options_.record.has_value(),
          most_frames_ > 0 || options_.bench.has_value(),
          !options_.no_reuse};
}

void Viewer::say(const std::string& text, bool error) {
  panel_.message = text;
  panel_.message_is_error = error;
  log(error ? LogLevel::kWarning : LogLevel::kInfo, text);
}

// Beside the window, which goes on with what it has: files, modules and automatic views take long.
void Viewer::open(const RenderOptions& options) {
  opening_name_ = options.inputs.empty() ? "the procedural planet"
                                         : fs::path(options.inputs.front()).filename().string();
  if (!panel_.message_is_error) say("opening " + opening_name_, false);
  opening_ = std::async(std::launch::async, [this, options] {
    return open_scene(host_, options.inputs.empty() ? parse_scene(kPlanet, "the planet", ".")
                                                    : scene_from(options, pictures_));
  });
}

void Viewer::drop(const std::vector<std::string>& files) {
  if (opening_.valid()) return say("the last files are still being opened", true);
  for (const std::string& file : files)
    if (fs::is_directory(file))
      return refuse(
          Error({"a folder cannot be opened", file, "files: scenes, pictures, data", "", ""}));
  panel_.message_is_error = false;
  RenderOptions options;
  options.inputs = files;
  open(options);
}

// The scene before stays; where there was none and somebody looks, the planet is there.
void Viewer::refuse(const Error& error) {
  const bool nothing = !scene_given_ && !opening_.valid();
  if (nothing && (most_frames_ > 0 || stands_in_)) throw Error(error);
  say(error.what(), true);
  if (!nothing) return;
  stands_in_ = true;
  open({});
}

void Viewer::take_opened() {
  if (!opening_.valid() || opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  try {
    OpenedScene opened = opening_.get();
    const RenderSettings& settings = opened.scene.render;
    const glm::ivec2 size(settings.width, settings.height);
    if (!sized_ && !options_.render.inputs.empty() && !options_.render.size && size != size_) {
      size_ = size;
      window_->set_size(size_.x, size_.y);
    }
    sized_ = scene_given_ = true;
    session_->open(std::move(opened), opening_name_);
    if (!panel_.message_is_error) panel_.message.clear();
  } catch (const Error& error) {
    refuse(error);
  }
}

void Viewer::take_news() {
  for (const SessionThread::News& news : session_->take_news())
    if (!news.error) {
      say(news.text, false);
    } else {
      scene_given_ = session_->has_session();
      refuse(*news.error);
    }
}

fs::path Viewer::free_name() const {
  const char* ending = ".png";
  try {
    pictures_.check_format("picture.png");
  } catch (const Error&) {
    ending = ".ppm";
  }
  for (int n = 1;; ++n) {
    const fs::path name = "nephoscope-" + std::to_string(n) + ending;
    if (!fs::exists(name)) return name;
  }
}

// By the offline renderer, with its error line and the scene in it; without a name, under the first
// that is free then.
void Viewer::save(std::optional<fs::path> name) {
  session_->ask([this, name, size = size_](ViewSession& session) {
    const fs::path output = name ? *name : free_name();
    const PictureFormat format = picture_format(output);
    pictures_.check_format(output);
    const OpenedScene seen = session.as_seen(size.x, size.y);
    OutputFile file(output, largest_size(seen.scene.render, format));
    const RenderResult result = render(seen.request);
    const std::string error = error_line(result.error);
    write_picture(pictures_, file.temporary(), format, seen, linear_image(result.image),
                  metadata_of(seen, output, error));
    file.commit();
    return output.string() + ": " + error;
  });
}

double Viewer::wait_s() const {
  const bool still = session_->at_rest() && !opening_.valid() && most_frames_ == 0;
  return still ? kRest_s : kBusy_s;
}

bool Viewer::frame() {
  // What moves the mouse is no reason to draw more often.
  std::this_thread::sleep_until(last_ + std::chrono::duration<double>(kNext_s));
  const WindowInput input = window_->poll(fresh_ ? 0 : wait_s());
  const auto now = Clock::now();
  const double gap_s = std::chrono::duration<double>(now - last_).count();
  const double cpu_s = thread_cpu_s();
  if (most_frames_ > 0) gaps_.push_back({1e3 * gap_s, 1e3 * (cpu_s - last_cpu_s_), {}});
  last_ = now;
  last_cpu_s_ = cpu_s;
  across_ = {input.width, input.height};
  session_->check();
  if (!input.dropped.empty()) drop(input.dropped);
  take_opened();
  take_news();
  session_->apply(panel_);
  session_->act(input, gap_s);
  if (input.close) return false;
  fresh_ = session_->fill(panel_);
  if (!session_->has_session()) {
    panel_.busy = true;
    panel_.scene = "opening";
  }
  if (input.screenshot && !session_->has_session()) say("there is nothing to draw yet", true);
  if (input.screenshot && session_->has_session()) {
    say("drawing the picture at full quality", false);
    save({});
  }
  if (input.hide) hidden_ = !hidden_;
  panel_.hidden = hidden_;
  if (const auto error = session_->error(); error && most_frames_ == 0 && told_ != *error) {
    told_ = *error;
    log(LogLevel::kInfo, "at rest: " + told_);
  }
  const ByteImage& picture = session_->picture();
  window_->show(picture.values.empty() ? nullptr : picture.values.data(), picture.width,
                picture.height, panel_);
  return !session_->done();
}

void Viewer::run() {
  last_ = Clock::now();
  last_cpu_s_ = thread_cpu_s();
  while (frame()) {
  }
  tell_last(false);
  if (options_.screenshot) {
    if (!session_->has_session())
      throw Error(
          {"no picture was drawn", "--screenshot", "a scene", "the end before one was open", ""});
    save(*options_.screenshot);
    tell_last(true);
  }
  report();
}

// Of what was asked for before the end.
void Viewer::tell_last(bool must_succeed) {
  session_->wait_until_handled();
  session_->check();
  for (const SessionThread::News& news : session_->take_news()) {
    if (news.error && must_succeed) throw Error(*news.error);
    say(news.error ? news.error->what() : news.text, news.error.has_value());
  }
}

// Of a run of so many frames that ended at rest.
std::string Viewer::await_error() {
  std::string text;
  session_->ask([&text, size = across_](ViewSession& session) {
    while (session.awaits_error()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      session.advance(size.x, size.y);
    }
    text = session.error_text();
    return std::string();
  });
  session_->wait_until_handled();
  session_->check();
  return text;
}

void Viewer::report() {
  std::vector<FrameTimes> times = session_->times();
  if (!times.empty()) times.pop_back();  // its end was not seen
  if (options_.record) write_camera_path(*options_.record, session_->recorded());
  if (options_.bench) write_pass_times(*options_.bench, summarise(times));
  if (most_frames_ == 0 || times.empty()) return;
  const LiveStatus status = session_->status();
  std::printf("%zu frames; %s\n", times.size(), gap_histogram(times).c_str());
  std::printf("window: %zu frames; %s\n", gaps_.size(), gap_histogram(gaps_).c_str());
  std::printf("%lu leaves, %.1f of %.0f MiB, %lu bricks read, %lu uploaded, %lu tiles lit, %s\n",
              status.leaves, double(status.bytes) / 1048576, double(status.budget_bytes) / 1048576,
              status.bricks_read, status.bricks_uploaded, status.tiles_lit,
              session_->at_rest() ? "at rest" : "not at rest");
  std::printf("%s\n", await_error().c_str());
  std::printf("peak memory %.0f MiB\n", usage_now().peak_mib);
  if (!panel_.message.empty()) std::printf("%s\n", panel_.message.c_str());
}

}  // namespace

void view_command(const ViewOptions& options) {
  Viewer(options).run();
}

}  // namespace nepho
