// Nodes that no ray of a picture meets have no light: rays of random cameras, walked piece by
// piece, must meet none of them.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "analytic_field.h"
#include "bricks/shell_chart.h"
#include "march_support.h"
#include "random.h"

namespace nepho {
namespace {

using test::FieldSource;
constexpr double kSide_m = 1000, kRadius_m = 6.36e6;

// Of random rays of the picture, the pieces with extinction that lie in nodes which are not seen.
struct Count {
  int pieces = 0, missed = 0, unseen_nodes = 0;
};

double to_ground_m(const Ray& ray) {
  const double b = glm::dot(ray.origin_m, ray.direction);
  const double c = glm::dot(ray.origin_m, ray.origin_m) - kRadius_m * kRadius_m;
  return b < 0 && b * b > c ? -b - std::sqrt(b * b - c) : 1e9;
}

Count walk(const BrickSource& source, const Camera& camera, bool planet, test::Random& random) {
  Refinement refinement;
  refinement.camera = camera;
  refinement.settings.width = 64;
  refinement.settings.height = 40;
  const std::vector<RenderVolume> volumes = {test::volume_of(source)};
  const Forest forest = build_forest(volumes, refinement);
  const VolumeTree& tree = forest.volumes[0];
  Count count;
  for (const TreeNode& node : tree.nodes)
    count.unseen_nodes += node.kind != NodeKind::kInner && !node.seen;
  const CutLevels cut(forest);
  const glm::dvec3 forward = glm::normalize(camera.target_m - camera.eye_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(camera.vertical_fov_rad / 2);
  for (int n = 0; n < 60; ++n) {
    // To the picture's very edge.
    const double x = std::clamp(random.uniform(-1.1, 1.1), -1.0, 1.0);
    const double y = std::clamp(random.uniform(-1.1, 1.1), -1.0, 1.0);
    const Ray ray{camera.eye_m, glm::normalize(forward + half * (1.6 * x * right + y * up))};
    VolumeWalk along(cut, 0, ray, planet ? to_ground_m(ray) : 1e9, false);
    while (along.next()) {
      if (along.kind() != NodeKind::kBrick && along.kind() != NodeKind::kConstant) continue;
      Index3 cell;
      for (std::size_t a = 0; a < 3; ++a) cell[a] = std::uint32_t(along.block().low[a]);
      ++count.pieces;
      count.missed += !leaf_at(tree, along.root(), cell).seen;
    }
  }
  return count;
}

template <class MakeCamera>
void expect_all_seen(const char* name, const BrickSource& source, bool planet, MakeCamera make) {
  test::Random random;
  Count sum;
  for (int n = 0; n < 25; ++n) {
    const Count count = walk(source, make(random), planet, random);
    sum.pieces += count.pieces;
    sum.missed += count.missed;
    sum.unseen_nodes += count.unseen_nodes;
  }
  std::printf("measured: %s: %d pieces met, %d of them in nodes without light; %d nodes unseen\n",
              name, sum.pieces, sum.missed, sum.unseen_nodes);
  EXPECT_EQ(sum.missed, 0);
  EXPECT_GT(sum.pieces, 1000);
  EXPECT_GT(sum.unseen_nodes, 100);
}

TEST(SeenNodes, RaysThroughABoxMeetNoOther) {
  const FieldSource source(test::box(kSide_m), test::isotropic(3),
                           [](glm::dvec3 p) { return test::cloud(7.0 / kSide_m * p); });
  expect_all_seen("box", source, false, [](test::Random& random) {
    Camera camera;
    const glm::dvec3 middle(kSide_m / 2);
    camera.eye_m = middle + random.log_uniform(0.1, 3) * kSide_m * random.direction();
    camera.target_m = middle + 0.3 * kSide_m * random.direction();
    camera.vertical_fov_rad = random.uniform(0.1, 1.5);
    return camera;
  });
}

const FieldSource& shell_source() {
  static const FieldSource source(
      std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0.0, 16000.0), test::isotropic(2),
      [](glm::dvec3 p) { return 1e-4 * test::cloud(9.0 / kRadius_m * p); });
  return source;
}

Camera over_planet(test::Random& random, double height_m, double reach_m) {
  Camera camera;
  const glm::dvec3 up = random.direction();
  camera.eye_m = (kRadius_m + height_m) * up;
  const glm::dvec3 at = kRadius_m * up + reach_m * random.direction();
  camera.target_m = kRadius_m * glm::normalize(at);
  camera.up = up;
  camera.vertical_fov_rad = random.uniform(0.1, 1.5);
  return camera;
}

TEST(SeenNodes, RaysFromLowOverAPlanetMeetNoOther) {
  expect_all_seen("shell", shell_source(), true, [](test::Random& random) {
    return over_planet(random, random.log_uniform(2, 5e5), 1e6);
  });
}

TEST(SeenNodes, RaysToAGlobeMeetNoOther) {
  expect_all_seen("globe", shell_source(), true, [](test::Random& random) {
    return over_planet(random, random.log_uniform(1e6, 3e7), 6e6);
  });
}

}  // namespace
}  // namespace nepho
