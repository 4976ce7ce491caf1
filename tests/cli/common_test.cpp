#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "bricks/box_chart.h"
#include "common/framing.h"
#include "common/output_file.h"
#include "core/error.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("nephoscope_output_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

TEST_F(OutputFileTest, appears_whole_on_commit_and_not_before) {
  const fs::path target = folder_ / "a.txt";
  {
    OutputFile file(target, 100);
    std::ofstream(file.temporary()) << "whole";
    EXPECT_FALSE(fs::exists(target));
    file.commit();
  }
  EXPECT_EQ(content(target), "whole");
  EXPECT_EQ(files(), 1u);
}

TEST_F(OutputFileTest, leaves_nothing_and_the_old_file_alone_without_commit) {
  const fs::path target = folder_ / "a.txt";
  std::ofstream(target) << "old";
  { OutputFile file(target, 100); }
  EXPECT_EQ(content(target), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(OutputFileTest, writes_through_a_link) {
  std::ofstream(folder_ / "real.txt") << "old";
  fs::create_symlink("real.txt", folder_ / "link.txt");
  OutputFile file(folder_ / "link.txt", 10);
  std::ofstream(file.temporary()) << "new";
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(content(folder_ / "real.txt"), "new");
}

TEST_F(OutputFileTest, ctrl_c_removes_the_temporary) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = fork();
    if (child == 0) {
      remove_output_on_signals();
      OutputFile file(folder_ / "a.txt", 100);
      std::ofstream(file.temporary()) << "half";
      std::raise(signal);
      _exit(0);  // not reached: the signal ends the process
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    EXPECT_EQ(files(), 0u);
  }
}

// A full cube of one value, or nothing but one node of the finest level.
class OneNodeSource : public BrickSource {
 public:
  OneNodeSource() {
    info_.name = "one";
    info_.lattice = Lattice({kSplitXyz, kSplitXyz, kSplitXyz});
    info_.chart = std::make_shared<BoxChart>(glm::dvec3(0), glm::dmat3(800.0));
  }
  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double, NodeSummary& summary) const noexcept override {
    summary = {};
    // The node (5, 2, 7) of level 3: its ancestors have it below, all else is empty.
    const int up = 3 - key.level();
    const bool above = key.i() == 5u >> up && key.j() == 2u >> up && key.k() == 7u >> up;
    if (!above) return Status::kOk;
    summary.empty = false;
    summary.constant = false;
    if (up > 0) {
      const int low = up - 1;
      summary.children =
          std::uint8_t(1u << ((5u >> low & 1) | (2u >> low & 1) << 1 | (7u >> low & 1) << 2));
    }
    return Status::kOk;
  }
  Status read(NodeKey, double, BrickView) const noexcept override { return Status::kUnsupported; }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  VolumeInfo info_;
};

TEST(Framing, finds_the_part_that_is_not_empty_without_reading_bricks) {
  const auto points = occupied_points(OneNodeSource(), 0);
  ASSERT_EQ(points.size(), 8u);
  glm::dvec3 low(1e9), high(-1e9);
  for (const auto& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_EQ(low, glm::dvec3(500, 200, 700));
  EXPECT_EQ(high, glm::dvec3(600, 300, 800));
}

// Corners of a box, as the pictures sees them: |x|, |y| <= 1 is inside.
std::vector<glm::dvec2> projected(const Camera& c, const std::vector<glm::dvec3>& points,
                                  double aspect) {
  const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, c.up));
  const glm::dvec3 upward = glm::cross(right, forward);
  const double tan_y = std::tan(c.vertical_fov_rad / 2);
  std::vector<glm::dvec2> result;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 d = p - c.eye_m;
    EXPECT_GT(glm::dot(d, forward), 0);
    result.emplace_back(glm::dot(d, right) / (glm::dot(d, forward) * tan_y * aspect),
                        glm::dot(d, upward) / (glm::dot(d, forward) * tan_y));
  }
  return result;
}

std::vector<glm::dvec3> box(const glm::dvec3& middle, const glm::dvec3& size) {
  std::vector<glm::dvec3> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(middle + size * (glm::dvec3(c & 1, c >> 1 & 1, c >> 2) - 0.5));
  return corners;
}

TEST(Framing, every_shape_fills_the_picture_and_stays_inside) {
  const glm::dvec3 sizes[] = {
      {1, 1, 1}, {100, 3, 40}, {5, 5, 900}, {4000, 3000, 50}, {1e7, 1e7, 1e7}};
  for (const glm::dvec3& size : sizes)
    for (const double aspect : {16.0 / 9, 1.0, 0.5})
      for (const double fov_rad : {0.05, 0.6, 2.0}) {
        const auto corners = box({1e6, -3e5, 7e3}, size);
        CameraSpec wish;
        wish.vertical_fov_rad = fov_rad;
        const Camera camera = frame_camera(corners, {}, wish, aspect);
        glm::dvec2 low(9), high(-9);
        for (const glm::dvec2& p : projected(camera, corners, aspect)) {
          low = glm::min(low, p);
          high = glm::max(high, p);
        }
        EXPECT_LE(std::max(high.x, -low.x), 1.0);
        EXPECT_LE(std::max(high.y, -low.y), 1.0);
        // The tighter of the two directions is used up to the margin, on both sides.
        const double across = high.x - low.x, along = high.y - low.y;
        EXPECT_NEAR(std::max(across, along), 2 / 1.08, 1e-6);
        const bool tight_x = across > along;
        EXPECT_NEAR(tight_x ? low.x + high.x : low.y + high.y, 0, 1e-6);
      }
}

TEST(Framing, looks_up_at_a_cloud_and_down_on_a_layer) {
  const Camera cloud = frame_camera(box(glm::dvec3(0), {10, 10, 8}), {}, {}, 1.5);
  const Camera layer = frame_camera(box(glm::dvec3(0), {100, 100, 3}), {}, {}, 1.5);
  EXPECT_LT(cloud.eye_m.z, cloud.target_m.z);
  EXPECT_GT(layer.eye_m.z, layer.target_m.z + 10);
}

// From the side, or below its top, the eye would stand in a layer that goes on for ever.
TEST(Framing, stands_above_a_layer_without_an_end) {
  for (const double height : {3.0, 100.0, 900.0}) {
    const auto corners = box(glm::dvec3(0), {100, 100, height});
    const Camera camera = frame_camera(corners, {}, {}, 1.5, true);
    EXPECT_GT(camera.eye_m.z, height / 2) << height;
    const glm::dvec3 ahead = glm::normalize(camera.target_m - camera.eye_m);
    EXPECT_LT(std::asin(ahead.z) + 0.3, 0) << "the horizon is out of the picture, " << height;
  }
}

TEST(Framing, what_is_asked_for_is_kept) {
  CameraSpec wish;
  wish.eye_m = glm::dvec3(10, 20, 30);
  const auto corners = box(glm::dvec3(100, 0, 0), glm::dvec3(2));
  Camera camera = frame_camera(corners, {}, wish, 1);
  EXPECT_EQ(camera.eye_m, *wish.eye_m);
  EXPECT_NEAR(glm::length(camera.target_m - glm::dvec3(100, 0, 0)), 0, 1e-12);
  wish.eye_m = glm::dvec3(100, 0, 50);  // straight down: `up` needs another axis
  camera = frame_camera(corners, {}, wish, 1);
  EXPECT_GT(glm::length(glm::cross(camera.up, camera.target_m - camera.eye_m)), 1);
}

TEST(Framing, sun_is_40_degrees_high_behind_the_left_shoulder) {
  const glm::dvec3 up(0, 0, 1);
  for (const glm::dvec3& target :
       {glm::dvec3(0, 1, 0), glm::dvec3(3, -2, 1), glm::dvec3(0, 1, -4)}) {
    Camera camera;
    camera.target_m = target;
    const glm::dvec3 sun = sun_over_left_shoulder(camera, up);
    EXPECT_NEAR(glm::length(sun), 1, 1e-15);
    EXPECT_NEAR(std::asin(glm::dot(sun, up)), glm::radians(40.0), 1e-14);
    EXPECT_LT(glm::dot(sun, glm::dvec3(target.x, target.y, 0)), 0);       // behind
    EXPECT_GT(glm::dot(sun, glm::cross(up, glm::normalize(target))), 0);  // left
  }
}

}  // namespace
}  // namespace nepho
