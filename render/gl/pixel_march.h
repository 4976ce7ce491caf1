#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gl/front_air.h"
#include "gl/object.h"
#include "gl/pixel_plan.h"
#include "renderer.h"

namespace nepho::gl {

struct PixelReport {
  bool interpolates = false;
  std::string why_all;  // where it does not
  double marched_share = 1, predicted_rms = 0;
  std::size_t checks = 0;
};

// Why all pixels are marched, whatever is in them; empty: some may be interpolated.
std::string why_all_pixels(const RenderRequest& request);

// y width + x of all, by blocks of neighbours.
std::vector<std::uint32_t> all_pixels(int width, int height);

// Runs a shader of rays (view.comp, ground.comp) for the pixels of `list`, with the distances of
// the ground in `values.met` (empty: none), and returns what it found, in their order. With the air
// in front of the clouds, rays of the view begin behind it. `depths`: a view.comp that was compiled
// with kDepthSwitch.
inline constexpr const char* kDepthSwitch = "#define NEPHO_SEEN_DEPTH 1\n";
PixelValues march_pixels(const Program& program, std::span<const std::uint32_t> list, int width,
                         const PixelValues& values, const FrontAir* front = nullptr,
                         bool depths = false);

// view.comp for that air alone.
void march_front(const Program& program, FrontAir& front);

}  // namespace nepho::gl
