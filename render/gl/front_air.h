#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gl/pixel_plan.h"

namespace nepho::gl {

// The air between an eye above all clouds and the sphere around these: its light and what it leaves
// vary with a ray's direction alone, and slowly. They are marched for rays kStep pixels apart and
// interpolated by cubics along rows and columns for those between.
class FrontAir {
 public:
  static constexpr int kStep = 8;
  struct Air {
    std::array<float, 3> radiance, transmittance;  // W m-2 sr-1 nm-1
  };
  // Of a ray that misses the sphere there is none.
  static constexpr float kMissed = -1;  // in place of the optical depth of clouds

  FrontAir(int width, int height, double tolerance);

  // Places of the rays to march, in pixels; some lie outside of the picture.
  std::vector<std::array<int, 2>> places() const;
  // What was found there, in their order.
  void set(const PixelValues& found);
  // Of a pixel. False where a ray around it misses the sphere, or where cubics and parabolas
  // through the rays around it differ by more than a hundredth of the tolerance.
  bool at(std::uint32_t pixel, Air& air) const;

 private:
  using Node = std::array<double, 6>;
  bool smooth(std::size_t first, std::size_t stride) const;
  bool cell_is_good(int x, int y) const;

  int width_, columns_, rows_;
  double tolerance_;
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> met_, good_;  // by node, and by the cell behind it
};

}  // namespace nepho::gl
