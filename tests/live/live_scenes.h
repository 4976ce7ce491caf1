#pragma once

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "live/live_renderer.h"
#include "render/planet_scenes.h"

namespace nepho::test {

// Four puffs and a veil in a box 4 km wide: what is near the eye is refined, what is far is not.
inline FieldSource puffs(double floor_m = 0, int levels = 3) {
  const auto chart =
      std::make_shared<BoxChart>(glm::dvec3(-2000, -2000, floor_m + 500),
                                 glm::dmat3(4000., 0., 0., 0., 4000., 0., 0., 0., 2000.));
  return FieldSource(chart, isotropic(levels), [=](glm::dvec3 p) {
    p.z -= floor_m;
    double sum = 0;
    for (int n = 0; n < 4; ++n) {
      const glm::dvec3 c(1200 * ((n & 1) ? 1 : -1), 1100 * ((n & 2) ? 1 : -1), 1300 + 100 * n);
      const glm::dvec3 d = (p - c) / 450.0;
      const double r = glm::length(d) * (1 + 0.25 * std::sin(7 * d.x) * std::cos(6 * d.y + d.z));
      if (r < 1) sum += 0.02 * (1 - r);
    }
    return sum;
  });
}

inline RenderRequest puffs_request(const BrickSource& source) {
  RenderRequest request = request_of({&source});
  request.settings.width = 64;
  request.settings.height = 36;
  request.settings.budget_mib = 64;
  request.sun.to_sun = glm::normalize(glm::dvec3(0.5, 0.3, 0.6));
  request.sky.zenith_W_per_m2_sr_nm = {0.02, 0.04, 0.1};
  request.sky.horizon_W_per_m2_sr_nm = {0.06, 0.08, 0.1};
  request.sky.below_W_per_m2_sr_nm = {0.03, 0.03, 0.03};
  request.camera = {{0, -5000, 1500}, {0, 0, 1300}, {0, 0, 1}, 0.9};
  return request;
}

// The same over a planet, seen from near the ground.
inline RenderRequest planet_puffs_request(const BrickSource& source) {
  RenderRequest request = planet_request({&source});
  request.settings.width = 64;
  request.settings.height = 36;
  request.settings.budget_mib = 64;
  look(request, 900, 6);
  request.camera.eye_m.y -= 6000;
  request.camera.target_m.y -= 6000;
  return request;
}

// Updates until nothing is left to do; false after a minute.
inline bool settle(LiveRenderer& renderer) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!renderer.at_rest()) {
    renderer.update();
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

// Rms of luminance where there is anything to see, over the mean of the truth.
inline double apart(const HdrImage& a, const HdrImage& truth) {
  double squares = 0, mean = 0;
  const std::size_t pixels = truth.optical_depth.size();
  if (a.rgb.size() != truth.rgb.size()) return 1e9;
  for (std::size_t p = 0; p < pixels; ++p) {
    const auto luminance = [&](const HdrImage& image) {
      return 0.2126 * image.rgb[3 * p] + 0.7152 * image.rgb[3 * p + 1] +
             0.0722 * image.rgb[3 * p + 2];
    };
    const double d = luminance(a) - luminance(truth);
    squares += d * d;
    mean += luminance(truth);
  }
  return std::sqrt(squares / double(pixels)) / (mean / double(pixels));
}

// A share as blocks of its pixels: what is shown without reuse.
inline HdrImage in_blocks(const HdrImage& share, int each) {
  HdrImage image{each * share.width, each * share.height, {}, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto p = std::size_t(y / each * share.width + x / each);
      for (std::size_t c = 0; c < 3; ++c) image.rgb.push_back(share.rgb[3 * p + c]);
      image.optical_depth.push_back(share.optical_depth[p]);
    }
  return image;
}

// A source whose bricks take their time.
class SlowSource final : public BrickSource {
 public:
  SlowSource(const BrickSource& source, std::chrono::microseconds each)
      : source_(source), each_(each) {}
  const VolumeInfo& info() const noexcept override { return source_.info(); }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return source_.summary(key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    if (fails) {
      set_last_error("the disc is gone");
      return Status::kReadFailed;
    }
    std::this_thread::sleep_for(each_);
    ++reads;
    return source_.read(key, time_s, brick);
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return source_.last_error(buffer, size);
  }
  mutable std::atomic<int> reads = 0;
  std::atomic<bool> fails = false;

 private:
  const BrickSource& source_;
  std::chrono::microseconds each_;
};

}  // namespace nepho::test
