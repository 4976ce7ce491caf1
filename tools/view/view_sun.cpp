#include "view/view_sun.h"

#include <cmath>
#include <cstdio>

#include "common/planet_scene.h"
#include "common/planet_view.h"
#include "scene/utc.h"
#include "sun/sun_position.h"

namespace nepho {
namespace {

constexpr std::int64_t kHour_ns = 3'600'000'000'000, kDay_ns = 24 * kHour_ns;
constexpr double kMoved_deg = 1e-6, kMoved_h = 1e-6;
// 2024-06-21T12Z, where the data have no date.
constexpr std::int64_t kNoon_ns = 1'718'971'200 * (kHour_ns / 3600);

std::int64_t date_of(const OpenedScene& opened) {
  if (opened.sun_utc_ns) return *opened.sun_utc_ns;
  for (std::size_t v = 0; v < opened.sources.size(); ++v) {
    const VolumeInfo& info = opened.sources[v]->info();
    if (info.time_origin_ns != 0) return utc_of(info, opened.request.volumes[v].time_s);
  }
  return kNoon_ns;
}

// Since midnight UTC, also before 1970.
std::int64_t time_of_day_ns(std::int64_t utc_ns) {
  return ((utc_ns % kDay_ns) + kDay_ns) % kDay_ns;
}

double hour_of(std::int64_t utc_ns) {
  return double(time_of_day_ns(utc_ns)) / double(kHour_ns);
}

}  // namespace

ViewSun::ViewSun(const OpenedScene& opened)
    : sun_(opened.request.sun),
      planet_(body_of(opened).has_value()),
      dated_(opened.sun_utc_ns.has_value()),
      utc_ns_(date_of(opened)),
      distance_au_(opened.sun_distance_au) {}

void ViewSun::stand(std::int64_t utc_ns) {
  const SunPosition position = sun_position(utc_ns);
  utc_ns_ = utc_ns;
  dated_ = true;
  sun_.to_sun = position.to_sun;
#ifdef NEPHO_MUTANT_SUN_AT_ONE_DISTANCE
  return;
#endif
  if (distance_au_ == 0) return;
  sun_.irradiance_W_per_m2_nm *= std::pow(distance_au_ / position.distance_au, 2);
  distance_au_ = position.distance_au;
}

void ViewSun::follow(std::int64_t utc_ns) {
  if (dated_)
    stand(utc_ns);
  else
    utc_ns_ = utc_ns;
}

void ViewSun::fill(Panel& panel, const LocalAxes& at) const {
  const glm::dvec2 angles = sun_angles_deg(at, sun_.to_sun);
  panel.planet = planet_;
  panel.sun_dated = dated_;
  panel.sun_azimuth_deg = angles.x;
  panel.sun_elevation_deg = angles.y;
  panel.sun_hour = hour_of(utc_ns_);
  panel.sun_utc_typed = false;
  if (panel.sun_utc_edited) return;
  std::snprintf(panel.sun_utc.data(), panel.sun_utc.size(), "%s", utc_text(utc_ns_).c_str());
}

void ViewSun::apply(const Panel& panel, const Panel& before, const LocalAxes& at) {
  if (panel.sun_utc_typed) return stand(utc_ns_value(panel.sun_utc.data(), "date of the sun"));
  if (panel.sun_dated != before.sun_dated) {
    if (panel.sun_dated) return stand(utc_ns_);
    dated_ = false;
  }
  if (dated_ && std::abs(panel.sun_hour - before.sun_hour) > kMoved_h) {
    // Whole minutes, as a slider's pixels are no finer.
    const auto minutes = std::int64_t(std::llround(60 * panel.sun_hour));
    return stand(utc_ns_ - time_of_day_ns(utc_ns_) + minutes * (kHour_ns / 60));
  }
  if (dated_ || (std::abs(before.sun_azimuth_deg - panel.sun_azimuth_deg) <= kMoved_deg &&
                 std::abs(before.sun_elevation_deg - panel.sun_elevation_deg) <= kMoved_deg))
    return;
  const double a = glm::radians(panel.sun_azimuth_deg), e = glm::radians(panel.sun_elevation_deg);
  sun_.to_sun =
      std::cos(e) * (std::sin(a) * at.east + std::cos(a) * at.north) + std::sin(e) * at.up;
}

}  // namespace nepho
