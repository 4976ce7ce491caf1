// VDB value = finest decoded sample: OpenVDB's own reading of each file against the bricks.

#include "identity.h"

namespace nepho::test {
namespace {

constexpr double kScale_per_m = 0.07;

Identity compare_twin(const std::string& name, const std::string& grid = "density",
                      glm::dvec3 (*to_local)(const glm::dvec3&) = y_up) {
  const std::string file = twin(name);
  const auto source = open(file, {number("density_scale", kScale_per_m)});
  return compare(*source, 0, kScale_per_m, active_voxels(file, grid), to_local);
}

TEST(Identity, HoldsForEveryTwin) {
  for (const char* name : {"plain", "half", "double", "non_uniform", "sheared", "no_class",
                           "not_finite", "background", "zeros"}) {
    const Identity found = compare_twin(name);
    expect_identity(name, found);
    EXPECT_GT(found.not_zero, 30000u) << name;
    EXPECT_GE(double(found.decoded_not_zero), 0.99 * double(found.not_zero)) << name;
  }
  expect_identity("other_name", compare_twin("other_name", "smoke"));
  expect_identity("blender",
                  compare_twin("blender", "density", [](const glm::dvec3& p) { return p; }));
}

TEST(Identity, HoldsForTilesOfAllSizes) {
  const Identity found = compare_twin("tiles");
  expect_identity("tiles", found);
  EXPECT_GT(found.voxels, 3u * 128 * 128 * 128);
  // constant nodes are not descended, so fewer samples are read than there are voxels
  EXPECT_LT(found.decoded_not_zero, found.not_zero);
}

// The comparison itself must see a wrong scale, a wrong axis and a missing voxel.
TEST(Identity, SeesWhatIsWrong) {
  const std::string file = twin("plain");
  const auto source = open(file, {number("density_scale", kScale_per_m)});
  auto voxels = active_voxels(file, "density");
  EXPECT_GT(compare(*source, 0, 1.001 * kScale_per_m, voxels, y_up).worst_of_bound, 1);
  EXPECT_GT(compare(*source, 0, kScale_per_m, voxels,
                    [](const glm::dvec3& p) { return y_up(p) + glm::dvec3(0, 0, 1); })
                .worst_of_bound,
            1);
  voxels.resize(voxels.size() / 2);
  const Identity half = compare(*source, 0, kScale_per_m, voxels, y_up);
  EXPECT_GT(half.decoded_not_zero, half.not_zero);
}

TEST(Identity, HoldsForPlacedVolumes) {
  static const SourceHost host({NEPHO_TEST_MODULES});
  VolumeSpec volume;
  volume.name = "placed", volume.source = "openvdb", volume.files = {twin("sheared")};
  volume.parameters = {number("density_scale", kScale_per_m), number("metres_per_unit", 100),
                       word("up", "z")};
  volume.place = GeodeticPlace{47, 8, 600, 30};
  const auto source = host.open(volume);
  // the place's frame, from three of its points
  VolumeSpec free = volume;
  free.place.reset();
  const auto at_origin = host.open(free);
  const auto corner = [](const BrickSource& s, glm::dvec3 q) {
    return s.info().chart->ecef_m({0, q});
  };
  static glm::dmat3 turn;
  static glm::dvec3 shift;
  glm::dmat3 from, to;
  for (int a = 0; a < 3; ++a) {
    glm::dvec3 q(0.0);
    q[a] = 1;
    from[a] = corner(*at_origin, q) - corner(*at_origin, glm::dvec3(0.0));
    to[a] = corner(*source, q) - corner(*source, glm::dvec3(0.0));
  }
  turn = to * glm::inverse(from);
  EXPECT_NEAR(glm::determinant(turn), 1, 1e-9);
  shift = corner(*source, glm::dvec3(0.0)) - turn * corner(*at_origin, glm::dvec3(0.0));
  EXPECT_NEAR(glm::length(shift), 6.367e6, 2e4);
  const Identity found =
      compare(*source, 0, kScale_per_m, active_voxels(volume.files[0], "density"),
              [](const glm::dvec3& p) { return shift + turn * (100.0 * p); });
  expect_identity("placed", found);
}

TEST(Identity, RefusesAFrustum) {
  const std::string file = (folder() / "frustum.vdb").string();
  write_frustum(file);
  try {
    open(file);
    FAIL() << "a frustum was taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("affine"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace nepho::test
