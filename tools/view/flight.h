#pragma once

#include <optional>

#include "common/planet_ground.h"
#include "scene/scene.h"
#include "view/window_module.h"

namespace nepho {

enum class FlightMode { kFree, kOrbit, kFirstPerson };

// An eye that a user moves. Over a planet up is that of the place, and the speed follows the height
// over the ground; elsewhere the scene's own up and size rule.
class Flight {
 public:
  // `ground`: absent where there is no planet; `size_m`: of what there is to see otherwise.
  Flight(const Camera& start, std::optional<PlanetGround> ground, double size_m);

  void set_mode(FlightMode mode);
  FlightMode mode() const { return mode_; }
  const Camera& camera() const { return camera_; }
  void set_camera(const Camera& camera);
  void reset() { set_camera(start_); }
  // Over a planet, `height_m` over the ground there; the heading stays. Throws Error where there is
  // no planet or no such place.
  void go_to(double latitude_deg, double longitude_deg, double height_m);

  // What was done in `seconds`. True where the camera is another.
  bool move(const WindowInput& input, double seconds);
  double speed_m_per_s() const;
  double height_m() const;  // over the ground; without a planet, from what is looked at

  static constexpr double kLeastHeight_m = 1.8, kMostHeight_m = 1e8;

 private:
  glm::dvec3 up_at(const glm::dvec3& place) const;
  void turn(double yaw_rad, double pitch_rad);
  void orbit(double yaw_rad, double pitch_rad);
  void step(const glm::dvec3& by_m);
  void keep_above_ground();

  Camera start_, camera_;
  std::optional<PlanetGround> ground_;
  double size_m_;
  FlightMode mode_ = FlightMode::kFree;
};

}  // namespace nepho
