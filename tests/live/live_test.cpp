// A renderer that keeps its state from frame to frame against one that draws each picture anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "accuracy_report.h"
#include "gl_fixture.h"
#include "live_scenes.h"

namespace nepho::test {
namespace {

using Live = GlFixture;
// At rest: trees at least as fine, the same steps. Half of what the tolerance lets a picture be
// off.
constexpr double kAtRest = 5e-3;

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

TEST_F(Live, APictureAtRestIsTheOfflineOne) {
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true}) {
    const RenderRequest request =
        planet ? planet_puffs_request(over_planet) : puffs_request(source);
    LiveRenderer live(request);
    ASSERT_TRUE(settle(live));
    const HdrImage truth = render(request).image;
    const double first = apart(live.frame(), truth);
    report_accuracy("A view that moves", planet ? "at rest, over a planet" : "at rest, in a box",
                    first, kAtRest, "1");
    EXPECT_LE(first, kAtRest) << planet;
    ASSERT_EQ(live.status().overruns, 0u);
  }
}

TEST_F(Live, ComesBackFromAFlight) {
  const FieldSource source = puffs();
  const RenderRequest home = puffs_request(source);
  LiveRenderer live(home);
  ASSERT_TRUE(settle(live));
  const std::uint64_t read = live.status().bricks_read;
  RenderRequest away = home;
  for (int n = 0; n <= 20; ++n) {  // into the nearest puff, and round it
    const double u = n / 20.0;
    away.camera.eye_m = {1500 * u, -5000 + 3800 * u, 1500 - 100 * u};
    away.camera.target_m = away.camera.eye_m + glm::dvec3(std::sin(4 * u), std::cos(4 * u), -0.1);
    live.set(away);
    for (int k = 0; k < 5; ++k) live.update();
    ASSERT_FALSE(live.frame().rgb.empty());
  }
  ASSERT_TRUE(settle(live));
  const double there = apart(live.frame(), render(away).image);
  live.set(home);
  ASSERT_TRUE(settle(live));
  const LiveStatus status = live.status();
  const double back = apart(live.frame(), render(home).image);
  report_accuracy("A view that moves", "after a flight into a cloud", there, kAtRest, "1");
  report_accuracy("A view that moves", "and back", back, kAtRest, "1");
  EXPECT_LE(there, kAtRest);
  EXPECT_LE(back, kAtRest);
  EXPECT_GT(status.bricks_read, read);        // what was near has come
  EXPECT_GT(status.bricks_remembered, read);  // and was not read again for each tree
  std::printf("measured: %lu bricks read, %lu remembered, %lu uploaded, %lu tiles lit, %lu trees\n",
              status.bricks_read, status.bricks_remembered, status.bricks_uploaded,
              status.tiles_lit, status.trees);
}

// Sixteen shares of every fourth pixel are the picture; one alone is a small one of it.
TEST_F(Live, SharesOfThePixelsMakeTheWhole) {
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true}) {
    const RenderRequest request =
        planet ? planet_puffs_request(over_planet) : puffs_request(source);
    const HdrImage truth = render(request).image;
    LiveRenderer live(request);
    live.reuse_pixels(false);
    ASSERT_TRUE(settle(live));
    HdrImage picture;
    double before = 1e9;
    for (int share = 1; share <= 16; ++share) {
      ASSERT_FALSE(live.whole());
      EXPECT_EQ(live.update(), share == 1);
      picture = live.frame(4);
      EXPECT_EQ(picture.width, share == 1 ? 16 : 64);
      if (share == 4 || share == 16) {  // a grid of every second pixel, and all
        const double off = apart(picture, truth);
        EXPECT_LT(off, before);
        before = off;
      }
    }
    EXPECT_TRUE(live.whole());
    report_accuracy("A view that moves",
                    planet ? "in 16 shares, over a planet" : "in 16 shares, in a box", before,
                    kAtRest, "1");
    EXPECT_LE(before, kAtRest);
    // A change throws them all away.
    RenderRequest moved = request;
    moved.camera.eye_m.z += 1;
    live.set(moved);
    EXPECT_FALSE(live.whole());
    EXPECT_EQ(live.frame(4).width, 16);
    EXPECT_THROW(live.frame(3), Error);
  }
}

// A slow flight past the puffs, for as many frames as there are shares after the first of them.
TEST_F(Live, PixelsAreUsedAgainInMotion) {
  constexpr double kMost = 0.5;
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true})
    for (const int each : {2, 4}) {
      RenderRequest request = planet ? planet_puffs_request(over_planet) : puffs_request(source);
      request.settings.width = 128;
      request.settings.height = 72;
      LiveRenderer live(request), bare(request);
      bare.reuse_pixels(false);
      ASSERT_TRUE(settle(live) && settle(bare));
      double squares = 0, of_blocks = 0;
      for (int n = 0; n < 2 * each * each; ++n) {
        request.camera.eye_m.x += 10;
        request.camera.target_m.x += 6;
        live.set(request);
        const HdrImage picture = live.frame(each);
        ASSERT_EQ(picture.width, 128);
        if (n < each * each) continue;
        bare.set(request);
        const HdrImage share = bare.frame(each), truth = bare.frame();
        squares += std::pow(apart(picture, truth), 2);
        of_blocks += std::pow(apart(in_blocks(share, each), truth), 2);
      }
      const double part = std::sqrt(squares / of_blocks);
      std::printf("measured: every %d of %s: rms %.4f, in blocks %.4f\n", each,
                  planet ? "a planet" : "a box", std::sqrt(squares) / each,
                  std::sqrt(of_blocks) / each);
      report_accuracy("A view that moves",
                      planet ? "pixel reuse: rms of that in blocks, over a planet"
                             : "pixel reuse: rms of that in blocks, in a box",
                      part, kMost, "1");
      EXPECT_LE(part, kMost);
    }
}

// Past the edge of a puff, behind which others come out, and a cut of a quarter turn.
TEST_F(Live, SixteenFramesAfterAFlightAreThePicture) {
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true}) {
    RenderRequest request = planet ? planet_puffs_request(over_planet) : puffs_request(source);
    const RenderRequest home = request;
    const HdrImage before = render(home).image;
    LiveRenderer live(request);
    ASSERT_TRUE(settle(live));
    const glm::dvec3 eye_m = request.camera.eye_m, target_m = request.camera.target_m;
    for (int n = 0; n < 24; ++n) {
      request.camera.eye_m = eye_m + glm::dvec3(100 * n, 150 * n, 0);
      request.camera.target_m = target_m + (n < 16 ? glm::dvec3(0) : glm::dvec3(1e5, 0, 0));
      live.set(request);
      live.update();
      ASSERT_EQ(live.frame(4).width, 64);
    }
    ASSERT_TRUE(settle(live));
    HdrImage picture;
    for (int n = 0; n < 16; ++n) picture = live.frame(4);
    EXPECT_TRUE(live.whole());
    const double off = apart(picture, render(request).image);
    report_accuracy(
        "A view that moves",
        planet ? "16 frames after a flight, over a planet" : "16 frames after a flight, in a box",
        off, kAtRest, "1");
    EXPECT_LE(off, kAtRest);
    // And without reuse the same bits; nor does a picture of render() depend on the flight.
    live.reuse_pixels(false);
    HdrImage bare;
    for (int n = 0; n < 16; ++n) bare = live.frame(4);
    EXPECT_EQ(picture.rgb, bare.rgb);
    EXPECT_EQ(picture.optical_depth, bare.optical_depth);
    EXPECT_EQ(render(home).image.rgb, before.rgb);
  }
}

// What was seen by another sun is not shown again.
TEST_F(Live, PixelsOfAnotherSunAreNotUsed) {
  const FieldSource source = puffs();
  RenderRequest request = puffs_request(source);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  for (int n = 0; n < 16; ++n) live.frame(4);
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.9, -0.2, 0.2));
  request.camera.eye_m.x += 1;
  live.set(request);
  ASSERT_TRUE(settle(live));
  LiveRenderer fresh(request);
  ASSERT_TRUE(settle(fresh));
  fresh.frame(4);  // both with the second share
  live.frame(4);
  const HdrImage truth = render(request).image;
  EXPECT_LE(apart(live.frame(4), truth), 1.05 * apart(fresh.frame(4), truth));
}

TEST_F(Live, FollowsTheSun) {
  const FieldSource source = puffs();
  RenderRequest request = puffs_request(source);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  const HdrImage morning = live.frame();
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.9, -0.2, 0.2));
  live.set(request);
  ASSERT_TRUE(settle(live));
  const HdrImage truth = render(request).image;
  const double off = apart(live.frame(), truth);
  report_accuracy("A view that moves", "with another sun", off, kAtRest, "1");
  EXPECT_LE(off, kAtRest);
  EXPECT_GT(apart(morning, truth), 5 * kAtRest);
}

TEST_F(Live, NothingChangedCostsNothing) {
  const FieldSource source = puffs();
  const RenderRequest request = puffs_request(source);
  {
    LiveRenderer warm(request);
    ASSERT_TRUE(settle(warm));
  }  // compiles
  LiveRenderer live(request);
  const double before_s = cpu_s();
  ASSERT_TRUE(settle(live));
  const double whole_s = cpu_s() - before_s;
  live.frame();
  const LiveStatus rest = live.status();
  constexpr int kUpdates = 100;
  const double begin_s = cpu_s();
  for (int n = 0; n < kUpdates; ++n) {
    live.set(request);
    EXPECT_FALSE(live.update());
  }
  const double each_s = (cpu_s() - begin_s) / kUpdates;
  const LiveStatus after = live.status();
  EXPECT_EQ(after.bricks_uploaded, rest.bricks_uploaded);
  EXPECT_EQ(after.tiles_lit, rest.tiles_lit);
  EXPECT_EQ(after.trees, rest.trees);
  report_accuracy("A view that moves", "cost of an update with nothing changed, of a full one",
                  each_s / whole_s, 0.01, "1");
  EXPECT_LT(each_s, 0.01 * whole_s);
}

// Before any new tree: what was behind the eye is there, coarser, and lit.
TEST_F(Live, TurningAroundShowsNoHole) {
  const FieldSource source = puffs();
  RenderRequest request = puffs_request(source);
  request.camera = {{0, 0, 1500}, {1000, 1000, 1400}, {0, 0, 1}, 1.2};
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  request.camera.target_m = {-1000, -1000, 1400};
  live.set(request);
  const HdrImage turned = live.frame();
  ASSERT_TRUE(settle(live));
  const HdrImage rested = live.frame();
  double tau = 0, tau_rest = 0;
  for (const float t : turned.optical_depth) tau += double(std::min(t, 20.0f));
  for (const float t : rested.optical_depth) tau_rest += double(std::min(t, 20.0f));
  ASSERT_GT(tau_rest, 100);
  report_accuracy("A view that moves", "turned around at once: optical depth", tau / tau_rest - 1,
                  0.1, "1");
  EXPECT_NEAR(tau / tau_rest, 1, 0.1);
  const double off = apart(turned, rested);
  report_accuracy("A view that moves", "turned around at once: picture", off, 0.1, "1");
  EXPECT_LE(off, 0.1);
}

TEST_F(Live, NoFrameWaitsForASource) {
  const FieldSource source = puffs();
  {
    LiveRenderer warm(puffs_request(source));
    ASSERT_TRUE(settle(warm));
    warm.frame();
  }
  const SlowSource slow(source, std::chrono::milliseconds(4));
  RenderRequest request = puffs_request(slow);
  LiveRenderer live(request);
  std::vector<double> gaps_ms;
  std::vector<std::uint64_t> leaves;
  int frames = 0;
  auto last = std::chrono::steady_clock::now();
  const auto begin = last;
  while (!live.at_rest()) {
    live.update();
    frames += live.frame().rgb.empty() ? 0 : 1;
    const auto now = std::chrono::steady_clock::now();
    gaps_ms.push_back(std::chrono::duration<double, std::milli>(now - last).count());
    last = now;
    const std::uint64_t shown = live.status().leaves;
    if (leaves.empty() || leaves.back() != shown) leaves.push_back(shown);
    ASSERT_LT(now - begin, std::chrono::minutes(1));
  }
  const double whole_ms = std::chrono::duration<double, std::milli>(last - begin).count();
  std::printf("measured: %d frames in %.0f ms of %d slow reads, longest block %.0f ms\n", frames,
              whole_ms, int(slow.reads), *std::ranges::max_element(gaps_ms));
  // Coarse first, finer as it comes; and frames went on all the while.
  EXPECT_TRUE(std::ranges::is_sorted(leaves));
  EXPECT_GE(leaves.size(), 3u);
  EXPECT_GT(frames, 5);
}

TEST_F(Live, ASourceThatFailsLeavesThePictureBefore) {
  const FieldSource source = puffs();
  SlowSource slow(source, std::chrono::microseconds(0));
  RenderRequest request = puffs_request(slow);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  const HdrImage before = live.frame();
  slow.fails = true;
  request.camera.eye_m = {0, -1500, 1500};
  live.set(request);
  ASSERT_TRUE(settle(live));
  const LiveStatus status = live.status();
  ASSERT_TRUE(status.failure);
  EXPECT_NE(std::string(status.failure->what()).find("the disc is gone"), std::string::npos);
  EXPECT_EQ(live.frame().rgb.size(), before.rgb.size());
  slow.fails = false;
  request.camera.eye_m.y -= 1;
  live.set(request);
  ASSERT_TRUE(settle(live));
  EXPECT_FALSE(live.status().failure);
}

TEST_F(Live, EndsWhileItReads) {
  const FieldSource source = puffs();
  const SlowSource slow(source, std::chrono::milliseconds(50));
  const auto begin = std::chrono::steady_clock::now();
  {
    LiveRenderer live(puffs_request(slow));
    while (slow.reads == 0) std::this_thread::yield();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(slow.reads, 100);  // of 190: what was begun is ended
  std::printf("measured: ended after %.2f s and %d reads of 50 ms\n", took.count(),
              int(slow.reads));
}

}  // namespace
}  // namespace nepho::test
