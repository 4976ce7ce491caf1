// nephoscope view: window, session, files that are opened beside it.
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
#include "view/view_session.h"
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

class Viewer {
 public:
  explicit Viewer(const ViewOptions& options);
  void run();

 private:
  void open(const RenderOptions& options);
  void take_opened();
  void drop(const std::vector<std::string>& files);
  void say(const std::string& text, bool error);
  void save(const fs::path& output);
  fs::path free_name() const;
  bool frame();  // false: the end

  const ViewOptions& options_;
  PictureFiles pictures_;
  SourceHost host_;
  std::optional<CameraPath> replay_;
  CameraPath record_;
  int most_frames_ = 0, coarse_ = 0;
  glm::ivec2 size_{0};  // of the window, and of pictures that are saved
  std::unique_ptr<Window> window_;
  std::unique_ptr<ViewSession> session_;  // before the window in destruction
  std::future<OpenedScene> opening_;
  Panel panel_;
  std::vector<FrameTimes> times_;
  Clock::time_point last_ = Clock::now();
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
  RenderOptions render = options.render;
  Scene scene =
      render.inputs.empty() ? parse_scene(kPlanet, "the procedural planet", ".") : Scene();
  if (!render.inputs.empty()) {
    try {
      scene = scene_from(render, pictures_);
    } catch (const Error& error) {
      if (most_frames_ > 0) throw;  // nobody looks at the window
      say(error.what(), true);
      scene = parse_scene(kPlanet, "the procedural planet", ".");
    }
  }
  size_ = {scene.render.width, scene.render.height};
  if (render.inputs.empty() && !render.size) size_ = {960, 540};
  if (render.size) size_ = size_value("--size", *render.size);
  window_ = open_window(default_module_folders(), size_.x, size_.y, "Nephoscope");
  log(LogLevel::kInfo, window_->description());
  opening_ = std::async(std::launch::async,
                        [this, scene = std::move(scene)] { return open_scene(host_, scene); });
}

void Viewer::say(const std::string& text, bool error) {
  panel_.message = text;
  panel_.message_is_error = error;
  log(error ? LogLevel::kWarning : LogLevel::kInfo, text);
}

void Viewer::drop(const std::vector<std::string>& files) {
  if (opening_.valid()) return say("the last files are still being opened", true);
  try {
    for (const std::string& file : files)
      if (fs::is_directory(file))
        throw Error({"a folder cannot be opened", file, "files: scenes, pictures, data", "", ""});
    RenderOptions options;
    options.inputs = files;
    Scene scene = scene_from(options, pictures_);
    say("opening " + fs::path(files.front()).filename().string(), false);
    opening_ = std::async(std::launch::async,
                          [this, scene = std::move(scene)] { return open_scene(host_, scene); });
  } catch (const Error& error) {
    say(error.what(), true);
  }
}

// What was opened meanwhile takes the place of what was there; what could not be opened does not.
void Viewer::take_opened() {
  if (!opening_.valid() || opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  try {
    OpenedScene opened = opening_.get();
    auto session = std::make_unique<ViewSession>(std::move(opened), coarse_);
    session->reuse_pixels(!options_.no_reuse);
    session_ = std::move(session);
    Panel empty;  // what it says is of the scene before, but for why another one was not opened
    if (panel_.message_is_error) {
      empty.message = panel_.message;
      empty.message_is_error = true;
    }
    panel_ = empty;
  } catch (const Error& error) {
    if (!session_ && most_frames_ > 0) throw;
    say(error.what(), true);
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

// By the offline renderer, with its error line and the scene in it.
void Viewer::save(const fs::path& output) {
  const PictureFormat format = picture_format(output);
  pictures_.check_format(output);
  const OpenedScene seen = session_->as_seen(size_.x, size_.y);
  OutputFile file(output, largest_size(seen.scene.render, format));
  const RenderResult result = render(seen.request);
  const std::string error = error_line(result.error);
  write_picture(pictures_, file.temporary(), format, seen, linear_image(result.image),
                metadata_of(seen, output, error));
  file.commit();
  say(output.string() + ": " + error, false);
}

bool Viewer::frame() {
  const auto now = Clock::now();
  const double gap_s = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  const WindowInput input = window_->poll();
  if (input.close) return false;
  if (!input.dropped.empty()) drop(input.dropped);
  take_opened();
  bool fresh = false;
  if (session_) {
    if (!times_.empty()) times_.back().gap_ms = 1e3 * gap_s;  // of the frame before, all of it
    session_->apply(panel_);
    if (replay_)
      session_->set_camera(replay_->cameras[times_.size() % replay_->cameras.size()]);
    else
      session_->act(input, std::min(gap_s, 0.1));
    fresh = session_->advance(input.width, input.height);
    session_->fill(panel_);
    times_.push_back({0, session_->status().passes});
    if (options_.record) record_.cameras.push_back(session_->camera());
    if (input.screenshot) try {
        save(free_name());
      } catch (const Error& error) {
        say(error.what(), true);
      }
  } else {
    panel_.busy = true;
    panel_.scene = "opening";
  }
  panel_.changed = false;
  const ByteImage none;
  const ByteImage& picture = session_ ? session_->picture() : none;
  window_->show(picture.values.empty() ? nullptr : picture.values.data(), picture.width,
                picture.height, panel_);
  // Nothing new: the next look need not be at once, and whoever reads or refines has the processor.
  if (!fresh && !replay_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return most_frames_ == 0 || int(times_.size()) < most_frames_;
}

void Viewer::run() {
  while (frame()) {
  }
  if (!times_.empty()) times_.pop_back();  // its end was not seen
  if (options_.screenshot && session_) save(*options_.screenshot);
  if (options_.record) write_camera_path(*options_.record, record_);
  if (options_.bench) write_pass_times(*options_.bench, summarise(times_));
  if (most_frames_ == 0 || times_.empty()) return;
  const LiveStatus& status = session_->status();
  std::printf("%zu frames; %s\n", times_.size(), gap_histogram(times_).c_str());
  std::printf("%lu leaves, %.1f of %.0f MiB, %lu bricks read, %lu uploaded, %lu tiles lit, %s\n",
              status.leaves, double(status.bytes) / 1048576, double(status.budget_bytes) / 1048576,
              status.bricks_read, status.bricks_uploaded, status.tiles_lit,
              session_->at_rest() ? "at rest" : "not at rest");
  std::printf("peak memory %.0f MiB\n", usage_now().peak_mib);
  if (!panel_.message.empty()) std::printf("%s\n", panel_.message.c_str());
}

}  // namespace

void view_command(const ViewOptions& options) {
  Viewer(options).run();
}

}  // namespace nepho
