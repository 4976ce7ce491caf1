// Flights through a scene that streams in: what they leave behind, what they hold, what they show.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "accuracy_report.h"
#include "gl_fixture.h"
#include "live_scenes.h"

namespace nepho::test {
namespace {

using Streaming = GlFixture;

// Of all textures and buffers that there are, by what OpenGL says of them.
std::uint64_t bytes_in_opengl() {
  std::uint64_t bytes = 0;
  for (GLuint name = 1; name < 4096; ++name) {
    if (glIsBuffer(name)) {
      GLint64 size = 0;
      glGetNamedBufferParameteri64v(name, GL_BUFFER_SIZE, &size);
      bytes += std::uint64_t(size);
    }
    if (!glIsTexture(name)) continue;
    const auto of = [&](GLenum what) {
      GLint value = 0;
      glGetTextureLevelParameteriv(name, 0, what, &value);
      return std::uint64_t(value);
    };
    std::uint64_t bits = 0;
    for (const GLenum size :
         {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE})
      bits += of(size);
    bytes += of(GL_TEXTURE_WIDTH) * of(GL_TEXTURE_HEIGHT) * of(GL_TEXTURE_DEPTH) * bits / 8;
  }
  return bytes;
}

// Into the nearest puff, round it, and the same way back.
Camera on_the_way(const Camera& home, double u) {
  Camera camera = home;
  const double way = 1 - std::abs(1 - 2 * u);
  camera.eye_m += glm::dvec3(1500 * way, 3800 * way, -100 * way);
  camera.target_m = camera.eye_m + 1000.0 * glm::dvec3(std::sin(4 * way), std::cos(4 * way), -0.05);
  return camera;
}

// The finest voxels are not needed from home.
void coarsen(RenderRequest& request) {
  request.settings.pixels_per_voxel = 2.5;
  request.settings.tolerance = 0.03;
}

using Look = std::function<void(int)>;
void fly(LiveRenderer& live, RenderRequest request, int steps, const Look& look) {
  const Camera home = request.camera;
  for (int n = 0; n <= steps; ++n) {
    request.camera = on_the_way(home, double(n) / steps);
    live.set(request);
    live.update();
    look(n);
  }
}

// The largest difference of a value, over the picture's mean.
double most_apart(const HdrImage& a, const HdrImage& b) {
  if (a.rgb.size() != b.rgb.size()) return 1e9;
  double most = 0, mean = 0;
  for (std::size_t v = 0; v < a.rgb.size(); ++v) {
    most = std::max(most, std::abs(double(a.rgb[v]) - double(b.rgb[v])));
    mean += double(b.rgb[v]) / double(b.rgb.size());
  }
  return most / mean;
}

// Where the eye has been is nowhere in the picture: trees hold on to what they were in motion only.
TEST_F(Streaming, AFlightLeavesNoTrace) {
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true}) {
    RenderRequest request = planet ? planet_puffs_request(over_planet) : puffs_request(source);
    coarsen(request);
    LiveRenderer fresh(request), flown(request);
    ASSERT_TRUE(settle(fresh));
    const HdrImage truth = fresh.frame();
    ASSERT_TRUE(settle(flown));
    fly(flown, request, 40, [&](int n) {
      if (n == 20) {
        ASSERT_TRUE(settle(flown));
      }
      flown.frame(4);
    });
    flown.set(request);
    ASSERT_TRUE(settle(flown));
    EXPECT_GT(flown.status().bricks_uploaded, fresh.status().bricks_uploaded);
    EXPECT_EQ(flown.status().leaves, fresh.status().leaves) << planet;
    const double off = most_apart(flown.frame(), truth);
    report_accuracy("A view that moves",
                    planet ? "there and back over a planet: largest difference to a new one"
                           : "there and back: largest difference to a new one",
                    off, 1e-6, "1");
    EXPECT_LE(off, 1e-6) << planet;
  }
}

// What the whole tree of a place shows as cloud is never a gap, nor unlit: coarser bricks that
// were there before stand in for what is on the way.
TEST_F(Streaming, AFlightShowsNoHole) {
  const FieldSource source = puffs();
  const SlowSource slow(source, std::chrono::microseconds(300));
  RenderRequest request = puffs_request(source), streamed = puffs_request(slow);
  LiveLimits limits;
  limits.upload_bytes = 8 << 10;  // some bricks an update, some tiles
  limits.light_tiles = 4;
  LiveRenderer live(streamed, limits);
  ASSERT_TRUE(settle(live));
  int clouds = 0, gaps = 0, dark = 0;
  const Camera home = request.camera;
  fly(live, streamed, 48, [&](int n) {
    const HdrImage seen = live.frame();
    if (n % 6) return;
    request.camera = on_the_way(home, n / 48.0);
    const HdrImage whole = render(request).image;
    for (std::size_t p = 0; p < whole.optical_depth.size(); ++p) {
      if (!(whole.optical_depth[p] > 1)) continue;
      ++clouds;
      gaps += seen.optical_depth[p] < 0.05f;
      dark += seen.rgb[3 * p] < 0.2f * whole.rgb[3 * p];
    }
  });
  std::printf("measured: of %d pixels of cloud %d are gaps, %d unlit\n", clouds, gaps, dark);
  ASSERT_GT(clouds, 500);
  // At edges coarse voxels are fainter than fine ones.
  EXPECT_LE(gaps, clouds / 200);
  EXPECT_LE(dark, clouds / 200);
  EXPECT_GT(live.status().trees, 1u);
}

TEST_F(Streaming, AFlightKeepsItsBudget) {
  const FieldSource source = puffs();
  RenderRequest request = puffs_request(source);
  request.settings.budget_mib = 3;
  request.settings.pixels_per_voxel = 0.25;
  const std::uint64_t before = bytes_in_opengl();
  LiveRenderer live(request);
  double most = 0;
  const Look look = [&](int n) {
    const std::uint64_t real = bytes_in_opengl() - before;
    const LiveStatus status = live.status();
    most = std::max(most, double(status.bytes) / double(status.budget_bytes));
    ASSERT_LE(status.bytes, status.budget_bytes) << n;
    // What the device holds is what is told; apart from it a frame's own few hundred bytes.
    ASSERT_LE(real, status.gpu_bytes + 2048) << n;
    ASSERT_GE(real, status.gpu_bytes) << n;
  };
  fly(live, request, 120, look);
  while (!live.at_rest()) {
    live.update();
    look(-1);
  }
  EXPECT_TRUE(live.status().budget_bound);
  EXPECT_GT(most, 0.5);  // and it is made use of
  report_accuracy("A view that moves", "a flight in a full budget: most of it in use", most, 1,
                  "1");
}

// Room for three trees in memory and two in the atlases: what that costs, where it is full.
TEST_F(Streaming, AFullBudgetAtRestShowsWhatAThirdDoesOffline) {
  const FieldSource source = puffs(0, 4);
  RenderRequest request = puffs_request(source);
  request.settings.pixels_per_voxel = 0.25;
  const HdrImage truth = render(request).image;
  request.settings.budget_mib = 6;
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  ASSERT_TRUE(live.status().budget_bound);
  const double mine = apart(live.frame(), truth);
  request.settings.budget_mib = 2;
  const double third = apart(render(request).image, truth);
  std::printf("measured: %lu leaves, %.2g off the finest; offline in a third %.2g\n",
              live.status().leaves, mine, third);
  report_accuracy("A view that moves", "a full budget at rest: error over offline in a third of it",
                  mine / third, 1, "1");
  EXPECT_LE(mine, third);
}

// While one tree is uploaded for long, and requests go on.
TEST_F(Streaming, NoMoreTreesThanTheBudgetWasSharedAmong) {
  const FieldSource source = puffs();
  const SlowSource slow(source, std::chrono::milliseconds(1));
  RenderRequest request = puffs_request(slow);
  coarsen(request);
  LiveLimits limits;
  limits.upload_bytes = 1;
  LiveRenderer live(request, limits);
  ASSERT_TRUE(settle(live));
  const Camera home = request.camera;
  int moves = 0, most = 0;
  const auto move = [&] {
    request.camera = on_the_way(home, 0.3 + 0.02 * ++moves);
    live.set(request);
  };
  const auto watch = [&](int ms) {
    for (int n = 0; n < ms; ++n) {
      most = std::max(most, live.status().trees_held);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  move();
  const std::uint64_t uploaded = live.status().bricks_uploaded;
  for (int n = 0; n < 10000 && live.status().bricks_uploaded == uploaded; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    live.update();
  }
  for (int again = 0; again < 4; ++again) {  // none of them is taken
    move();
    watch(60);
  }
  std::printf("measured: at most %d trees\n", most);
  EXPECT_EQ(most, 3);
}

}  // namespace
}  // namespace nepho::test
