#pragma once

#include <cmath>

namespace nepho {

// Angles of tangents that follow each other closely, as a ray's do: by the difference from one that
// is known, to 1e-16 rad; std::atan only where that is 0.02 rad or more.
class NearAngle {
 public:
  double of(double tangent) {
    const double apart = (tangent - tangent_) / (1 + tangent * tangent_);
    if (!(std::abs(apart) < kNear_rad)) {
      tangent_ = tangent;
      return angle_ = std::atan(tangent);
    }
    const double s = apart * apart;
    return angle_ + apart * (1 - s * (1.0 / 3 - s * (1.0 / 5 - s * (1.0 / 7))));
  }

 private:
  static constexpr double kNear_rad = 0.02;
  double tangent_ = 0, angle_ = 0;
};

}  // namespace nepho
