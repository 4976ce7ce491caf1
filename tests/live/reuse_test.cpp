// Pictures from a share of their pixels and those before, of a world whose rays are formulas.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "accuracy_report.h"
#include "gl/frame_data.h"
#include "gl/pixel_plan.h"
#include "live/pixel_reuse.h"
#include "live_scenes.h"

namespace nepho::test {
namespace {

constexpr int kWidth = 128, kHeight = 72;

struct Hit {
  glm::dvec3 radiance;
  float distance_m;
};

// A ball of 100 m, 400 m before a wall of 3 km; above the wall is sky. `centre`: of the world,
// where the ball is. `haze_per_m`: radiance that goes with the eye's place, not with what is seen.
// `wall`: how bright that is.
struct World {
  glm::dvec3 centre{0.0};
  double haze_per_m = 0, wall = 1;

  static double marks(const glm::dvec3& p, double period_m) {
    const double k = 6.283 / period_m;
    return 0.5 + 0.25 * std::sin(k * p.x + 1) * std::cos(0.7 * k * p.z) +
           0.25 * std::sin(0.37 * k * (p.x + 2 * p.z));
  }
  Hit hit(const glm::dvec3& eye, const glm::dvec3& d) const {
    const glm::dvec3 e = eye - centre;
    const double haze = haze_per_m * (e.x + 100);
    const double b = glm::dot(e, d), c = glm::dot(e, e) - 100 * 100.0, q = b * b - c;
    if (q > 0 && -b - std::sqrt(q) > 0) {
      const double t = -b - std::sqrt(q);
      return {glm::dvec3(1, 0.9, 0.8) * (1 + marks(e + t * d, 40)) + haze, float(t)};
    }
    const double t = (400 - e.y) / d.y;
    const glm::dvec3 p = e + t * d;
    if (t > 0 && p.z < 60 && std::abs(p.x) < 1500)
      return {glm::dvec3(0.2, 0.4, 0.2) * (wall * marks(p, 130)) + haze, float(t)};
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
      const Hit hit =
          world.hit(vec(view.eye_m), glm::normalize(vec(view.forward) +
                                                    ((2 * x + 1.0) / kWidth - 1) * vec(view.right) +
                                                    (1 - (2 * y + 1.0) / kHeight) * vec(view.up)));
      for (int c = 0; c < 3; ++c) out.image.rgb.push_back(float(hit.radiance[c]));
      out.image.optical_depth.push_back(hit.distance_m < gl::kNoGround_m ? 1 : 0);
      out.distance_m.push_back(hit.distance_m);
    }
  return out;
}

// As LiveRenderer::frame().
class Flight {
 public:
  Flight(const World& world, int each) : world_(world), each_(each) {}
  void frame(const Camera& camera) {
    const FrameData view = view_of(camera);
    const bool same = frames_++ > 0 && camera.eye_m == last_.eye_m &&
                      camera.target_m == last_.target_m && !world_changed_;
    world_changed_ = false;
    if (!same || shares_.whole()) shares_.begin(each_, kWidth, kHeight, true);
    offsets_.insert(shares_.offset());
    const Picture share = march(world_, view, each_, shares_.offset());
    shares_.add(share.image);
    picture_ = reuse_.picture(view, shares_, share.distance_m, same);
    share_ = share.image;
    last_ = camera;
  }
  void change(const World& world) {
    world_ = world;
    world_changed_ = true;
  }
  const HdrImage& picture() const { return picture_; }
  double error() const { return apart(picture_, truth()); }
  // Largest, away from the picture's edges, where there is nothing to go by; of the truth.
  double error_inside() const {
    const HdrImage is = truth();
    double most = 0;
    for (int y = 8; y < kHeight - 8; ++y)
      for (int x = 8; x < kWidth - 8; ++x) {
        const auto p = 3 * std::size_t(y * kWidth + x);
        most = std::max(most, std::abs(double(picture_.rgb[p] / is.rgb[p]) - 1));
      }
    return most;
  }
  double error_of_blocks() const { return apart(in_blocks(share_, each_), truth()); }
  HdrImage truth() const { return march(world_, view_of(last_)).image; }
  const World& world() const { return world_; }
  bool whole() const { return shares_.whole(); }
  std::size_t offsets() const { return offsets_.size(); }

 private:
  World world_;
  int each_, frames_ = 0;
  bool world_changed_ = false;
  PixelShares shares_;
  PixelReuse reuse_;
  HdrImage picture_, share_;
  Camera last_;
  std::set<std::array<int, 2>> offsets_;
};

// Before the ball, past which the eye goes sideways.
Camera beside(const World& world, double x_m, double turn = 0.2) {
  return {world.centre + glm::dvec3(x_m, -500, 20),
          world.centre + glm::dvec3(turn * x_m, 0, 10),
          {0, 0, 1},
          0.6};
}

struct Errors {
  double reuse = 0, blocks = 0;
};
Errors slow_flight(const World& world, int each, double speed_m) {
  Flight flight(world, each);
  Errors errors;
  const int shares = each * each;
  for (int n = 0; n < 2 * shares; ++n) {
    flight.frame(beside(world, speed_m * (n - shares)));
    if (n < shares) continue;
    errors.reuse += std::pow(flight.error(), 2) / shares;
    errors.blocks += std::pow(flight.error_of_blocks(), 2) / shares;
  }
  EXPECT_EQ(flight.offsets(), std::size_t(shares));  // each pixel in its turn
  return {std::sqrt(errors.reuse), std::sqrt(errors.blocks)};
}

// Speeds are 0.15, 0.6 and 2.4 pixels of the ball a frame.
TEST(PixelReuse, InSlowMotionIsFarBetterThanBlocks) {
  constexpr double kMost = 0.5;
  for (const int each : {2, 4, 8})
    for (const double speed_m : {0.5, 2.0, 8.0}) {
      const Errors errors = slow_flight({}, each, speed_m);
      const double part = errors.reuse / errors.blocks;
      std::printf("measured: every %d, %.1f m a frame: rms %.3f, in blocks %.3f\n", each, speed_m,
                  errors.reuse, errors.blocks);
      if (each == 2 && speed_m > 2) {  // new pixels are as near as the old ones were last
        EXPECT_LT(part, 0.7);
        continue;
      }
      report_accuracy("A view that moves", "pixel reuse: rms of that in blocks, formulas", part,
                      kMost, "1");
      EXPECT_LE(part, kMost) << each << ' ' << speed_m;
    }
}

// Where floats have half a metre: nothing depends on where the world is.
TEST(PixelReuse, IsTheSameOnAPlanet) {
  const Errors here = slow_flight({}, 4, 2);
  const Errors there = slow_flight({glm::dvec3(4e6, -3e6, 4e6)}, 4, 2);
  EXPECT_NEAR(there.reuse / here.reuse, 1, 0.02);
}

// Of the frame after `flight` and that of one that begins there.
double over_a_new_one(Flight& flight, int each, const Camera& camera) {
  Flight fresh(flight.world(), each);
  flight.frame(camera);
  fresh.frame(camera);
  std::printf("measured: rms %.4f, without what was before %.4f\n", flight.error(), fresh.error());
  return flight.error() / fresh.error();
}

// A ball comes before what was seen: no more than its new pixels are known, and no wall may be seen
// between them.
TEST(PixelReuse, WhatIsHiddenIsNotSeen) {
  for (const int each : {2, 4}) {
    Flight flight({}, each);
    for (int n = 0; n < each * each; ++n) flight.frame(beside({}, -400 + 0.01 * n, 1));
    EXPECT_LT(over_a_new_one(flight, each, beside({}, 0, 1)), 1.35);
  }
}

// What has changed without a word is not brighter than what is seen around it now.
TEST(PixelReuse, StaysWithinWhatIsAround) {
  Flight flight({}, 4);
  for (int n = 0; n < 16; ++n) flight.frame(beside({}, 0.01 * n));
  World dark;
  dark.wall = 0.1;
  flight.change(dark);
  EXPECT_LT(over_a_new_one(flight, 4, beside({}, 0.2)), 0.4);
}

// The eye turns under the sky by 0.6 pixels a frame: points lie beside the pixels' centres, and
// what is level between them would show as a pattern.
TEST(PixelReuse, WhatIsSmoothStaysSmooth) {
  Flight flight({}, 4);
  double error = 0;
  for (int n = 0; n < 32; ++n) {
    const double a = 0.3 + 0.003 * n;
    flight.frame({{}, {0.2 * a, -std::cos(a), std::sin(a)}, {0, 0, 1}, 0.6});
    if (n >= 16) error = std::max(error, flight.error_inside());
  }
  report_accuracy("A view that moves", "pixel reuse: a smooth sky, largest", error, 5e-4, "1");
  EXPECT_LT(error, 5e-4);
}

TEST(PixelReuse, FollowsWhatGoesWithTheEye) {
  World world;
  world.haze_per_m = 0.005;  // in sixteen frames by as much as the wall's marks
  const Errors clear = slow_flight({}, 4, 2), hazy = slow_flight(world, 4, 2);
  const double by_haze = hazy.reuse / hazy.blocks / (clear.reuse / clear.blocks);
  std::printf("measured: %.3f times the error without haze\n", by_haze);
  EXPECT_LT(by_haze, 1.05);
}

// After a flight past the edge and a cut: sixteen frames, and not one bit is of what was before.
TEST(PixelReuse, AtRestIsWhatIsMarched) {
  Flight flight({}, 4);
  for (int n = 0; n < 21; ++n) flight.frame(beside({}, 20 * n - 200));
  const Camera rest{{0, -300, 30}, {300, -290, 30}, {0, 0, 1}, 0.9};
  for (int n = 0; n < 16; ++n) {
    EXPECT_FALSE(flight.whole());
    flight.frame(rest);
    EXPECT_EQ(flight.picture().width, kWidth);
  }
  EXPECT_TRUE(flight.whole());
  EXPECT_EQ(flight.picture().rgb, flight.truth().rgb);
}

TEST(PixelShares, KnowTheFinestGridThatIsThere) {
  PixelShares shares;
  shares.begin(4, 8, 8);
  const HdrImage share{2, 2, std::vector<float>(12, 1), std::vector<float>(4, 1)};
  for (int n = 1; n <= 16; ++n) {
    shares.add(share);
    const PixelGrid grid = shares.finest_grid();
    EXPECT_EQ(grid.step, n < 4 ? 4 : n < 16 ? 2 : 1) << n;
    for (int y = grid.y; y < 8; y += grid.step)
      for (int x = grid.x; x < 8; x += grid.step) EXPECT_TRUE(shares.has(x, y));
  }
}

}  // namespace
}  // namespace nepho::test
