#include "view/view_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <stdexcept>

#include "cli/report.h"
#include "cli/saved_picture.h"
#include "common/planet_scene.h"
#include "common/planet_view.h"
#include "geo/place.h"
#include "gl/frame_data.h"
#include "image/tone.h"
#include "live/live_budget.h"
#include "scene/scene_file.h"
#include "scene/utc.h"

namespace nepho {
namespace {

// A frame is to be there within the first, and need not be sooner than the second.
constexpr double kSlow_ms = 90, kQuick_ms = 18;
constexpr int kCoarsest = 8, kStartCoarse = 8;
constexpr int kSlowInARow = 2, kQuickInARow = 8;

std::optional<PlanetGround> ground_of(const OpenedScene& opened) {
  const auto body = body_of(opened);
  if (!body) return std::nullopt;
  PlanetGround ground{*body, {}};
  if (opened.terrain) {
    ground.maps.push_back(opened.terrain);
    return ground;
  }
  for (const auto& source : opened.sources)
    if (source->info().surface) ground.maps.push_back(source->info().surface);
  return ground;
}

std::size_t volume_with_times(const OpenedScene& opened) {
  for (std::size_t v = 0; v < opened.sources.size(); ++v)
    if (opened.sources[v]->info().times_s.size() > 1) return v;
  return 0;
}

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
  char text[160];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

std::string length_text(double length_m) {
  return length_m < 1e4 ? line("%.0f m", length_m) : line("%.4g km", 1e-3 * length_m);
}

}  // namespace

ViewSession::ViewSession(OpenedScene opened, int coarse)
    : opened_(std::move(opened)),
      shown_(opened_.sources.size(), true),
      timed_(volume_with_times(opened_)),
      flight_(opened_.request.camera, ground_of(opened_),
              glm::length(opened_.request.camera.target_m - opened_.request.camera.eye_m)),
      sun_(opened_),
      fixed_coarse_(coarse > 0),
      coarse_(coarse > 0 ? coarse : kStartCoarse),
      exposure_ev_(opened_.scene.exposure_ev),
      exposure_found_(!exposure_ev_) {
  if (!opened_.sources.empty()) {
    const std::vector<double>& times_s = opened_.sources[timed_]->info().times_s;
    time_ =
        int(std::ranges::find(times_s, opened_.request.volumes[timed_].time_s) - times_s.begin());
  }
  make_live(everything(opened_.request.settings.width, opened_.request.settings.height));
}

void ViewSession::make_live(const RenderRequest& request) {
  live_ = std::make_unique<LiveRenderer>(request);
  live_->reuse_pixels(reuse_);
}

void ViewSession::reuse_pixels(bool reuse) {
  reuse_ = reuse;
  live_->reuse_pixels(reuse);
}

void ViewSession::act(const WindowInput& input, double seconds) {
  if (input.reset) flight_.reset();
  if (input.next_mode) flight_.set_mode(FlightMode((int(flight_.mode()) + 1) % 3));
  moved_ |= flight_.move(input, seconds);
}

void ViewSession::set_camera(const Camera& camera) {
  flight_.set_camera(camera);
  moved_ = true;
}

// Where angles of the sun are told: under what the camera looks at.
LocalAxes ViewSession::axes() const {
  if (const auto ground = ground_of(opened_)) return ground->axes(flight_.camera().eye_m);
  const Placement frame = scene_frame(opened_.scene);
  return {axis(frame, 0), axis(frame, 1), axis(frame, 2)};
}

void ViewSession::apply(const Panel& panel, const Panel& before) {
  if (!panel.changed) return;
  RenderSettings& settings = opened_.request.settings;
  if (panel.budget_mib != before.budget_mib) set_budget(panel.budget_mib);
  if (panel.go && panel.go_to)
    flight_.go_to(panel.go_to->latitude_deg, panel.go_to->longitude_deg, panel.go_to->height_m);
  sun_.apply(panel, before, axes());
  if (panel.mode != before.mode) flight_.set_mode(FlightMode(panel.mode));
  if (panel.exposure_ev != before.exposure_ev) {
    exposure_ev_ = panel.exposure_ev;
    exposure_found_ = false;
    show_again_ = true;
  }
  settings.tolerance = panel.tolerance;
  settings.step_voxels.reset();
  if (panel.fixed_step) settings.step_voxels = panel.step_voxels;
  settings.pixels_per_voxel = panel.pixels_per_voxel;
  for (std::size_t v = 0; v < shown_.size(); ++v) shown_[v] = panel.volumes[v].shown;
  if (panel.time != before.time) set_time(panel.time);
  opened_.request.sun = sun_.sun();
}

// What was read is read again: the memory for it is another, and never both. The old stays where
// the new is too small.
void ViewSession::set_budget(double budget_mib) {
  RenderRequest request = everything(frame_.width, frame_.height);
  request.settings.budget_mib = budget_mib;
  share_budget(budget_mib, gl::sky_lights(request), gl::tells_ice(request));
  live_.reset();
  try {
    make_live(request);
  } catch (const Error& error) {  // more than OpenGL gives
    try {
      make_live(everything(frame_.width, frame_.height));
    } catch (const Error&) {  // no Error: the session is at its end
      throw std::runtime_error(error.what());
    }
    throw;
  }
  opened_.request.settings.budget_mib = budget_mib;
}

// All volumes go to the time that is nearest; the sun goes along where times are dates.
void ViewSession::set_time(int index) {
  time_ = index;
  const VolumeInfo& clock = opened_.sources[timed_]->info();
  const double time_s = clock.times_s[std::size_t(index)];
  const bool dated = clock.time_origin_ns != 0;
  for (std::size_t v = 0; v < opened_.sources.size(); ++v) {
    const VolumeInfo& info = opened_.sources[v]->info();
    const double apart_s = 1e-9 * double(clock.time_origin_ns - info.time_origin_ns);
    const double wanted_s = time_s + (dated && info.time_origin_ns != 0 ? apart_s : 0);
    opened_.request.volumes[v].time_s = *std::ranges::min_element(
        info.times_s, {}, [&](double t) { return std::abs(t - wanted_s); });
  }
  if (dated) sun_.follow(utc_of(clock, time_s));
}

// Of a window of this size, in sides that any coarseness divides; all volumes, shown or not: what
// is made for fewer cannot show the others later.
RenderRequest ViewSession::everything(int width, int height) const {
  RenderRequest request = opened_.request;
  request.camera = flight_.camera();
  request.settings.width = std::max(width / kCoarsest, 1) * kCoarsest;
  request.settings.height = std::max(height / kCoarsest, 1) * kCoarsest;
  return request;
}

RenderRequest ViewSession::wanted(int width, int height) const {
  RenderRequest request = everything(width, height);
  std::vector<RenderVolume> volumes;
  for (std::size_t v = 0; v < shown_.size(); ++v)
    if (shown_[v]) volumes.push_back(request.volumes[v]);
  request.volumes = std::move(volumes);
  return request;
}

bool ViewSession::advance(int width, int height) {
  live_->set(wanted(width, height));
  const bool changed = live_->update();
  bool fresh = false;
  // The rest of a picture that is soon another one is not worth the time.
  if (changed || (!live_->whole() && !live_->streaming())) {
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t programs = status_.programs;
    // Once it stands still the shares go on as they began.
    if (changed) each_ = coarse_;
    frame_ = live_->frame(each_);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    status_ = live_->status();
    frame_ms_ = took.count();
    fresh = !frame_.rgb.empty();
    if (fresh && programs == status_.programs) choose_coarseness(frame_ms_);
  } else {
    status_ = live_->status();
  }
  update_error();
  if ((!fresh && !show_again_) || frame_.rgb.empty()) return false;
  const FloatImage linear = linear_image(frame_);
  // Until the first whole picture of the whole tree is there, or somebody moves on; then exposure
  // stays, whatever comes into sight.
  if (!exposure_ev_ || exposure_found_) {
    exposure_ev_ = find_exposure(opened_, linear, frame_.optical_depth);
    exposure_found_ = !status_.complete || !(live_->whole() || moved_);
  }
  picture_ = to_display(linear, *exposure_ev_, opened_.scene.tone_map, opened_.scene.dither,
                        display_white(opened_.scene));
  show_again_ = false;
  return true;
}

void ViewSession::update_error() {
  error_failure_.clear();
  error_.reset();
  try {
    error_ = live_->error(frame_);
  } catch (const Error& error) {
    error_failure_ = error.what();
  }
}

bool ViewSession::awaits_error() const {
  return at_rest() && !error_ && error_failure_.empty() && !status_.failure &&
         opened_.request.settings.probe_pixels > 0 && frame_.width > 0;
}

std::string ViewSession::error_text() const {
  if (error_) return error_line(*error_);
  if (!error_failure_.empty()) return "error: not known: " + error_failure_;
  if (opened_.request.settings.probe_pixels <= 0) return "error: not measured (0 probe pixels)";
  if (awaits_error()) return "error: being measured";
  return at_rest() ? "error: not known" : "error: not known before it is at rest";
}

// Cost goes with the pixels: coarser at once, finer a step at a time.
void ViewSession::choose_coarseness(double frame_ms) {
  if (fixed_coarse_) return;
  slow_ = frame_ms > kSlow_ms ? slow_ + 1 : 0;
  quick_ = frame_ms < kQuick_ms ? quick_ + 1 : 0;
  if (slow_ >= kSlowInARow && coarse_ < kCoarsest) {
    const double times = std::max(std::sqrt(frame_ms / kSlow_ms), 1.01);
    while (coarse_ < kCoarsest && coarse_ < times * each_) coarse_ *= 2;
    slow_ = 0;
  } else if (quick_ >= kQuickInARow && coarse_ > 1) {
    coarse_ /= 2;
    quick_ = 0;
  }
}

void ViewSession::fill(Panel& panel) const {
  panel.scene = opened_.scene.name.empty() && !opened_.sources.empty()
                    ? opened_.sources.front()->info().name
                    : opened_.scene.name;
  panel.mode = int(flight_.mode());
  panel.exposure_ev = exposure_ev_.value_or(0);
  const RenderSettings& settings = opened_.request.settings;
  panel.tolerance = settings.tolerance;
  panel.fixed_step = settings.step_voxels.has_value();
  panel.step_voxels = settings.step_voxels.value_or(2);
  panel.pixels_per_voxel = settings.pixels_per_voxel;
  panel.budget_mib = settings.budget_mib;
  panel.error_line = error_text();
  sun_.fill(panel, axes());
  if (const auto body = body_of(opened_)) {
    const GeodeticPoint at = geodetic_point(*body, flight_.camera().eye_m);
    panel.place = {at.latitude_deg, at.longitude_deg, flight_.height_m()};
  }
  panel.go = false;
  panel.volumes.clear();
  for (std::size_t v = 0; v < shown_.size(); ++v)
    panel.volumes.push_back({opened_.sources[v]->info().name, shown_[v]});
  panel.time = time_;
  panel.times = 1;
  if (!opened_.sources.empty()) {
    const VolumeInfo& info = opened_.sources[timed_]->info();
    panel.times = int(info.times_s.size());
    const double time_s = info.times_s[std::size_t(time_)];
    panel.time_text =
        info.time_origin_ns != 0 ? utc_text(utc_of(info, time_s)) : line("%.6g s", time_s);
  }
  panel.busy = !at_rest();
  constexpr double kMib = 1024.0 * 1024.0;
  panel.lines = {(panel.planet ? "height " : "distance ") + length_text(flight_.height_m()) +
                     ", speed " + length_text(flight_.speed_m_per_s()) + "/s",
                 line("frame %dx%d, %.1f ms", frame_.width, frame_.height, frame_ms_)};
  for (const PassReport& pass : status_.passes)
    panel.lines.push_back(pass.gpu_s >= 0
                              ? line("  %s %.1f ms GPU", pass.name.c_str(), 1e3 * pass.gpu_s)
                              : line("  %s %.1f ms CPU", pass.name.c_str(), 1e3 * pass.cpu_s));
  panel.lines.push_back(
      line("%lu leaves of %lu nodes%s", status_.leaves, status_.nodes,
           status_.complete && status_.budget_bound ? ", the budget is full" : ""));
  panel.lines.push_back(line("%.1f of %.0f MiB, %lu bricks read", double(status_.bytes) / kMib,
                             double(status_.budget_bytes) / kMib, status_.bricks_read));
  if (status_.failure) panel.lines.push_back(status_.failure->what());
}

OpenedScene ViewSession::as_seen(int width, int height) const {
  OpenedScene seen{opened_.scene, {}, opened_.terrain, opened_.request, opened_.assumptions};
  RenderSettings& settings = seen.request.settings;
  settings.width = width;
  settings.height = height;
  settings.engine = Engine::kMarch;  // what draws it here, whatever drew it before
  const Camera& camera = flight_.camera();
  seen.request.camera = camera;
  Scene& scene = seen.scene;
  scene.render = settings;
  scene.target = {};
  scene.camera = {camera.eye_m, camera.target_m, camera.up, camera.vertical_fov_rad, {}, {}};
  scene.sun.to_sun = seen.request.sun.to_sun;
  scene.sun.irradiance_W_per_m2_nm = seen.request.sun.irradiance_W_per_m2_nm;
  scene.exposure_ev = exposure_ev_.value_or(0);
  for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
    scene.volumes[v].time_s = seen.request.volumes[v].time_s;
    scene.volumes[v].utc_ns.reset();
  }
  for (std::size_t v = shown_.size(); v-- > 0;) {
    if (shown_[v]) continue;
    scene.volumes.erase(scene.volumes.begin() + std::ptrdiff_t(v));
    seen.request.volumes.erase(seen.request.volumes.begin() + std::ptrdiff_t(v));
  }
  return seen;
}

}  // namespace nepho
