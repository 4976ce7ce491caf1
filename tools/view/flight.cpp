#include "view/flight.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"
#include "geo/place.h"

namespace nepho {
namespace {

constexpr double kTurn_rad_per_height = 1;  // of the field of view, for a drag over the window
constexpr double kHeightsPerSecond = 0.5, kLeastSpeed_m_per_s = 3;
constexpr double kSteepest = 0.999;  // sine of the steepest sight: up stays up

glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double rad) {
  return v * std::cos(rad) + glm::cross(axis, v) * std::sin(rad) +
         axis * glm::dot(axis, v) * (1 - std::cos(rad));  // Rodrigues
}

}  // namespace

Flight::Flight(const Camera& start, std::optional<PlanetGround> ground, double size_m)
    : start_(start), camera_(start), ground_(std::move(ground)), size_m_(size_m) {
  set_camera(start);
}

void Flight::set_camera(const Camera& camera) {
  camera_ = camera;
}

void Flight::set_mode(FlightMode mode) {
  mode_ = mode;
  if (mode != FlightMode::kFirstPerson) return;
  // Who comes down looks ahead, not at his feet.
  const glm::dvec3 up = up_at(camera_.eye_m), sight = camera_.target_m - camera_.eye_m;
  const glm::dvec3 level = sight - glm::dot(sight, up) * up;
  if (glm::length(level) > 0)
    camera_.target_m = camera_.eye_m + glm::length(sight) * glm::normalize(level);
  keep_above_ground();
}

void Flight::go_to(double latitude_deg, double longitude_deg, double height_m) {
  if (!ground_) throw Error({"places are on a planet", "go to", "", "a scene without one", ""});
  GeodeticPoint point{latitude_deg, longitude_deg, 0};
  point.height_m = ground_->height_m(ecef_m(ground_->body, point)) + height_m;
  const glm::dvec3 eye = ecef_m(ground_->body, point), sight = camera_.target_m - camera_.eye_m;
  const LocalAxes from = ground_->axes(camera_.eye_m), to = ground_->axes(eye);
  camera_.eye_m = eye;
  camera_.target_m = eye + glm::dot(sight, from.east) * to.east +
                     glm::dot(sight, from.north) * to.north + glm::dot(sight, from.up) * to.up;
  camera_.up = to.up;
  keep_above_ground();
}

glm::dvec3 Flight::up_at(const glm::dvec3& place) const {
  return ground_ ? ground_->axes(place).up : glm::normalize(start_.up);
}

double Flight::height_m() const {
  if (!ground_) return glm::length(camera_.target_m - camera_.eye_m);
  // Along the normal, good to the square of the flattening: a speed, no place.
  const glm::dvec3 foot = ground_->point_m(glm::normalize(camera_.eye_m), 0);
  return glm::dot(camera_.eye_m - foot, up_at(camera_.eye_m)) - ground_->height_m(camera_.eye_m);
}

double Flight::speed_m_per_s() const {
  const double scale_m = ground_ ? std::max(height_m(), 0.0) : 0.4 * size_m_;
  return std::max(kHeightsPerSecond * scale_m, kLeastSpeed_m_per_s);
}

bool Flight::move(const WindowInput& input, double seconds) {
  const glm::dvec3 eye = camera_.eye_m, target = camera_.target_m;
  const double per_pixel =
      kTurn_rad_per_height * camera_.vertical_fov_rad / std::max(input.height, 1);
  const double yaw = -input.turn_x * per_pixel, pitch = -input.turn_y * per_pixel;
  if (mode_ == FlightMode::kOrbit) {
    orbit(4 * yaw + 0.6 * seconds * input.right, 4 * pitch + 0.6 * seconds * input.up);
    const double closer = std::exp(-0.1 * input.scroll - seconds * input.faster * input.forward);
    camera_.eye_m = camera_.target_m + closer * (camera_.eye_m - camera_.target_m);
  } else {
    turn(yaw, pitch);
    const double far_m = speed_m_per_s() * seconds * input.faster;
    const glm::dvec3 up = up_at(camera_.eye_m);
    glm::dvec3 ahead = glm::normalize(camera_.target_m - camera_.eye_m);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, up));
    if (mode_ == FlightMode::kFirstPerson) ahead = glm::cross(up, right);
    const double notch_m = 0.25 * speed_m_per_s() * input.scroll;
    step((far_m * input.forward + notch_m) * ahead + far_m * input.right * right +
         (mode_ == FlightMode::kFree ? far_m * input.up : 0.0) * up);
  }
  if (camera_.eye_m != eye || camera_.target_m != target) keep_above_ground();
  return camera_.eye_m != eye || camera_.target_m != target;
}

void Flight::turn(double yaw_rad, double pitch_rad) {
  if (yaw_rad == 0 && pitch_rad == 0) return;
  const glm::dvec3 up = up_at(camera_.eye_m);
  const glm::dvec3 sight = camera_.target_m - camera_.eye_m;
  glm::dvec3 ahead = turned(glm::normalize(sight), up, yaw_rad);
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, up));
  const glm::dvec3 pitched = turned(ahead, right, pitch_rad);
  if (std::abs(glm::dot(pitched, up)) < kSteepest) ahead = pitched;
  camera_.target_m = camera_.eye_m + glm::length(sight) * ahead;
  camera_.up = up;
}

void Flight::orbit(double yaw_rad, double pitch_rad) {
  if (yaw_rad == 0 && pitch_rad == 0) return;
  const glm::dvec3 up = up_at(camera_.target_m);
  glm::dvec3 out = turned(camera_.eye_m - camera_.target_m, up, yaw_rad);
  const glm::dvec3 right = glm::normalize(glm::cross(up, out));
  const glm::dvec3 pitched = turned(out, right, -pitch_rad);
  if (std::abs(glm::dot(glm::normalize(pitched), up)) < kSteepest) out = pitched;
  camera_.eye_m = camera_.target_m + out;
  camera_.up = up;
}

// Over a planet the sight turns with the horizon.
void Flight::step(const glm::dvec3& by_m) {
  if (by_m == glm::dvec3(0)) return;
  glm::dvec3 sight = camera_.target_m - camera_.eye_m;
  const glm::dvec3 before = up_at(camera_.eye_m);
  camera_.eye_m += by_m;
  const glm::dvec3 after = up_at(camera_.eye_m);
  const glm::dvec3 axis = glm::cross(before, after);
  const double sine = glm::length(axis);
  if (sine > 1e-15) sight = turned(sight, axis / sine, std::asin(std::min(sine, 1.0)));
  camera_.target_m = camera_.eye_m + sight;
  camera_.up = after;
}

void Flight::keep_above_ground() {
  if (!ground_) return;
  const glm::dvec3 sight = camera_.target_m - camera_.eye_m;
  const double height = height_m();
  double wanted = std::clamp(height, kLeastHeight_m, kMostHeight_m);
  if (mode_ == FlightMode::kFirstPerson) wanted = kLeastHeight_m;
  if (wanted == height) return;
  camera_.eye_m += (wanted - height) * up_at(camera_.eye_m);
  if (mode_ != FlightMode::kOrbit) camera_.target_m = camera_.eye_m + sight;
}

}  // namespace nepho
