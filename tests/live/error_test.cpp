// The error line of a view that stands still.
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "accuracy_report.h"
#include "gl_fixture.h"
#include "live_scenes.h"

namespace nepho::test {
namespace {

using LiveErrorLine = GlFixture;

// Bricks wait at a gate, or fail there.
class GatedSource final : public BrickSource {
 public:
  explicit GatedSource(const BrickSource& source) : source_(source) {}
  const VolumeInfo& info() const noexcept override { return source_.info(); }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return source_.summary(key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    std::unique_lock lock(mutex_);
    waits_ = waits_ || !open_;
    opened_.wait(lock, [this] { return open_; });
    if (!fails_) return source_.read(key, time_s, brick);
    set_last_error("the disc is gone");
    return Status::kReadFailed;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return source_.last_error(buffer, size);
  }
  void set(bool open, bool fails) {
    const std::lock_guard lock(mutex_);
    open_ = open;
    fails_ = fails;
    opened_.notify_all();
  }
  bool somebody_waits() const {
    const std::lock_guard lock(mutex_);
    return waits_;
  }

 private:
  const BrickSource& source_;
  mutable std::mutex mutex_;
  mutable std::condition_variable opened_;
  mutable bool waits_ = false;
  bool open_ = true, fails_ = false;
};

// Coarser than there are bricks, so that the probe reads some.
RenderRequest coarse_puffs(const BrickSource& source, bool planet = false) {
  RenderRequest request = planet ? planet_puffs_request(source) : puffs_request(source);
  request.settings.pixels_per_voxel = 6;
  request.settings.probe_pixels = 32;
  request.settings.probe_paths = 0;
  return request;
}

std::optional<ErrorEstimate> await_error(LiveRenderer& live, const HdrImage& frame) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    if (auto error = live.error(frame)) return error;
    std::this_thread::yield();
  }
  return std::nullopt;
}

TEST_F(LiveErrorLine, IsThatOfTheOfflinePicture) {
  const FieldSource source = puffs(), over_planet = puffs(kRadius_m);
  for (const bool planet : {false, true}) {
    const RenderRequest request = coarse_puffs(planet ? over_planet : source, planet);
    const ErrorEstimate truth = render(request).error;
    LiveRenderer live(request);
    ASSERT_TRUE(settle(live));
    const HdrImage frame = live.frame();
    const auto error = await_error(live, frame);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->probe_pixels, truth.probe_pixels);
    EXPECT_EQ(error->light_model_basis, truth.light_model_basis);
    // Trees of a view that moves may be finer, and their light is that of more leaves.
    constexpr double kApart = 0.03;
    double worst = 0;
    for (const auto term : {&ErrorEstimate::integration, &ErrorEstimate::level_of_detail,
                            &ErrorEstimate::light_model}) {
      EXPECT_GT(truth.*term, 0);
      worst = std::max(worst, std::abs((*error).*term / truth.*term - 1));
    }
    report_accuracy("A view that moves",
                    planet ? "error line at rest against render's, over a planet"
                           : "error line at rest against render's, in a box",
                    worst, kApart, "1");
    EXPECT_LE(worst, kApart);
  }
}

TEST_F(LiveErrorLine, NobodyWaitsForIt) {
  const FieldSource field = puffs();
  GatedSource source(field);
  const RenderRequest request = coarse_puffs(source);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  const HdrImage frame = live.frame();
  source.set(false, false);
  EXPECT_FALSE(live.error(frame));
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!source.somebody_waits() && std::chrono::steady_clock::now() < end) {
    EXPECT_FALSE(live.error(frame));
    std::this_thread::yield();
  }
  ASSERT_TRUE(source.somebody_waits());
  EXPECT_LE(live.status().bytes, live.status().budget_bytes);
  // The probe stands at the gate; frames of another place go on.
  RenderRequest moved = request;
  for (int n = 0; n < 20; ++n) {
    moved.camera.eye_m.x += 20;
    live.set(moved);
    live.update();
    const HdrImage next = live.frame();
    EXPECT_EQ(next.width, request.settings.width);
    EXPECT_FALSE(live.error(next));
  }
  EXPECT_GT(apart(live.frame(), frame), 0.01);
  source.set(true, false);
  ASSERT_TRUE(settle(live));
  EXPECT_TRUE(await_error(live, live.frame()));
}

TEST_F(LiveErrorLine, IsDroppedOnAChange) {
  const FieldSource source = puffs();
  RenderRequest request = coarse_puffs(source);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  const auto before = await_error(live, live.frame());
  ASSERT_TRUE(before);
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.9, -0.2, 0.2));
  live.set(request);
  ASSERT_TRUE(settle(live));
  const HdrImage frame = live.frame();
  const auto after = await_error(live, frame);  // the first one there is
  ASSERT_TRUE(after);
  EXPECT_NE(after->integration, before->integration);
  // And stays while nothing changes.
  live.set(request);
  EXPECT_FALSE(live.update());
  const auto again = live.error(frame);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->integration, after->integration);
}

TEST_F(LiveErrorLine, SaysWhyThereIsNone) {
  const FieldSource field = puffs();
  GatedSource source(field);
  const RenderRequest request = coarse_puffs(source);
  LiveRenderer live(request);
  ASSERT_TRUE(settle(live));
  const HdrImage frame = live.frame();
  source.set(true, true);
  try {
    await_error(live, frame);
    FAIL() << "a source that fails";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the disc is gone"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(live.frame().width, request.settings.width);
}

}  // namespace
}  // namespace nepho::test
