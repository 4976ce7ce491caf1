// Pictures from a share of their pixels and those before, of a world whose rays are formulas.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "accuracy_report.h"
#include "gl/frame_data.h"
#include "live/pixel_reuse.h"
#include "live_scenes.h"

namespace nepho::test {
namespace {

constexpr int kWidth = 128, kHeight = 72;

struct Hit {
  glm::dvec3 radiance;
  float distance_m;
};

// A ball of 100 m, 400 m before a wall of 3 km; above the wall is sky. `centre`: of the world, where
// the ball is. `haze`: radiance that goes with the eye's place, not with what is seen.
struct World {
  glm::dvec3 centre{0.0};
  double haze_per_m = 0;

  static double marks(const glm::dvec3& p, double period_m) {
    const double k = 6.283 / period_m;
    return 0.5 + 0.25 * std::sin(k * p.x + 1) * std::cos(0.7 * k * p.z) +
           0.25 * std::sin(0.37 * k * (p.x + 2 * p.z));
  }
  Hit hit(const glm::dvec3& eye, const glm::dvec3& d) const {
    const glm::dvec3 e = eye - centre;
    const double haze = haze_per_m * (e.x + 1000);
    const double b = glm::dot(e, d), c = glm::dot(e, e) - 100 * 100.0, q = b * b - c;
    if (q > 0 && -b - std::sqrt(q) > 0) {
      const double t = -b - std::sqrt(q);
      return {glm::dvec3(1, 0.9, 0.8) * (1 + marks(e + t * d, 40)) + haze, float(t)};
    }
    const double t = (400 - e.y) / d.y;
    const glm::dvec3 p = e + t * d;
    if (t > 0 && p.z < 60 && std::abs(p.x) < 1500)
      return {glm::dvec3(0.2, 0.4, 0.2) * marks(p, 130) + haze, float(t)};
    return {glm::dvec3(0.1, 0.2, 0.5) * (1 + 0.5 * d.z) + haze, gl::kNoGround_m};
  }
};

FrameData view_of(const Camera& camera) {
  RenderSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  FrameData frame{};
  gl::set_camera(frame, camera, settings);
  return frame;
}

struct Picture {
  HdrImage image;
  std::vector<float> distance_m;
};
Picture march(const World& world, const FrameData& view, int each = 1,
              std::array<int, 2> offset = {0, 0}) {
  const auto vec = [](const double(&v)[3]) { return glm::dvec3(v[0], v[1], v[2]); };
  Picture out{{kWidth / each, kHeight / each, {}, {}}, {}};
  for (int y = offset[1]; y < kHeight; y += each)
    for (int x = offset[0]; x < kWidth; x += each) {
      const Hit hit = world.hit(
          vec(view.eye_m), glm::normalize(vec(view.forward) +
                                          ((2 * x + 1.0) / kWidth - 1) * vec(view.right) +
                                          (1 - (2 * y + 1.0) / kHeight) * vec(view.up)));
      for (int c = 0; c < 3; ++c) out.image.rgb.push_back(float(hit.radiance[c]));
      out.image.optical_depth.push_back(hit.distance_m < gl::kNoGround_m ? 1 : 0);
      out.distance_m.push_back(hit.distance_m);
    }
  return out;
}

// The nearest marched pixel of each block, as a small picture is shown.
HdrImage blocks(const HdrImage& share, int each) {
  HdrImage image{kWidth, kHeight, {}, {}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto p = std::size_t(y / each * share.width + x / each);
      for (std::size_t c = 0; c < 3; ++c) image.rgb.push_back(share.rgb[3 * p + c]);
      image.optical_depth.push_back(share.optical_depth[p]);
    }
  return image;
}

// As LiveRenderer::frame().
class Flight {
 public:
  Flight(const World& world, int each) : world_(world), each_(each) {}
  const HdrImage& frame(const Camera& camera) {
    const FrameData view = view_of(camera);
    const bool same = have_last_ && camera.eye_m == last_.eye_m && camera.target_m == last_.target_m;
    if (!same || shares_.whole()) shares_.begin(each_, kWidth, kHeight, true);
    const Picture share = march(world_, view, each_, shares_.offset());
    shares_.add(share.image);
    picture_ = reuse_.picture(view, shares_, share.distance_m, same);
    share_ = share.image;
    last_ = camera;
    have_last_ = true;
    return picture_;
  }
  double error() const { return apart(picture_, march(world_, view_of(last_)).image); }
  double error_of_blocks() const {
    return apart(blocks(share_, each_), march(world_, view_of(last_)).image);
  }
  World& world() { return world_; }
  bool whole() const { return shares_.whole(); }

 private:
  World world_;
  int each_;
  PixelShares shares_;
  PixelReuse reuse_;
  HdrImage picture_, share_;
  Camera last_;
  bool have_last_ = false;
};

// Sideways before the ball, a fifth of a pixel of the ball to two pixels a frame.
Camera sideways(const World& world, double x_m) {
  return {world.centre + glm::dvec3(x_m, -500, 20), world.centre + glm::dvec3(0.2 * x_m, 0, 10),
          {0, 0, 1}, 0.6};
}

TEST(PixelReuse, InSlowMotionIsFarBetterThanBlocks) {
  for (const int each : {2, 4, 8})
    for (const double speed_m : {0.5, 2.0, 8.0}) {
      Flight flight({}, each);
      double error = 0, of_blocks = 0;
      const int frames = 3 * each * each;
      for (int n = 0; n < frames; ++n) {
        flight.frame(sideways(flight.world(), speed_m * (n - frames / 2)));
        if (n < each * each) continue;
        error = std::max(error, flight.error());
        of_blocks = std::max(of_blocks, flight.error_of_blocks());
      }
      std::printf("each %d, %.1f m: %.4f of %.4f: %.3f\n", each, speed_m, error, of_blocks,
                  error / of_blocks);
    }
}

}  // namespace
}  // namespace nepho::test
