#include "analytic_field.h"
#include "truth_support.h"

// Light that enters a convex body from all sides alike, and is not absorbed in it, scatters on
// average 4 integral(k dV) / surface times: for any field of extinction k and any phase function
// (Blanco and Fournier 2003, doi:10.1209/epl/i2003-00208-x). Of an even sphere: 2/3 of the optical
// depth of its diameter.

namespace nepho::test {
namespace {

struct Ball {
  std::string name;
  double depth;  // optical, of the diameter
  Phase phase;
};
void PrintTo(const Ball& ball, std::ostream* out) {
  *out << ball.name;
}

std::vector<Compared> run(const Ball& ball, double planted = 1) {
  Medium medium;
  add_ball(medium, planted * ball.depth, ball.phase);
  const PathTracer& tracer = medium.tracer();
  const auto ours = measure_to<1>(1, [&](Random& random) {
    const glm::dvec3 out = turned({0, 0, 1}, sample_hg(0, random.uniform()), random);
    const Ray in{kBallRadius_m * out, cosine_law(-out, random)};
    return std::array{double(walk(tracer, in, random).scatterings)};
  });
  return {{"scatterings", ours[0], {2.0 / 3.0 * ball.depth}}};
}

class Balls : public testing::TestWithParam<Ball> {};
TEST_P(Balls, ScatterTwoThirdsOfTheirDepth) {
  expect_agreement("sphere " + GetParam().name, run(GetParam()));
}
const std::vector<Ball> kBalls{{"tau2_backward", 2, hg(-0.5)}, {"tau2_even", 2, hg(0)},
                               {"tau2_g85", 2, hg(0.85)},      {"tau10_g85", 10, hg(0.85)},
                               {"tau10_g99", 10, hg(0.99)},    {"tau10_mie", 10, Phase{}},
                               {"tau50_g85", 50, hg(0.85)}};
INSTANTIATE_TEST_SUITE_P(Truth, Balls, testing::ValuesIn(kBalls),
                         [](const auto& with) { return with.param.name; });

TEST(PathLengthBias, OfExtinctionIsCaught) {
  expect_caught("sphere tau10_g85", run({"", 10, hg(0.85)}, 1 + kBias));
}

struct Box {
  std::string name;
  glm::dmat3 edges_m;
  double g;
  int volumes;
  double (*field)(const glm::dvec3& q);  // 1/m; of coordinates 0 .. 1
};
void PrintTo(const Box& box, std::ostream* out) {
  *out << box.name;
}

constexpr int kLevels = 2, kCells = 8 << kLevels;

// Integral of the trilinear field between samples at the cells' corners.
double mean_of(double (*field)(const glm::dvec3&)) {
  const auto weight = [](int i) { return i == 0 || i == kCells ? 0.5 : 1.0; };
  double sum = 0;
  for (int k = 0; k <= kCells; ++k)
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i)
        sum += weight(i) * weight(j) * weight(k) * field(glm::dvec3(i, j, k) / double(kCells));
  return sum / std::pow(kCells, 3);
}

std::vector<Compared> run(const Box& box, double planted = 1) {
  Medium medium;
  const auto chart = std::make_shared<BoxChart>(glm::dvec3{0.0}, box.edges_m);
  for (int v = 0; v < box.volumes; ++v)
    medium.add(
        chart, isotropic(kLevels),
        [&](const glm::dvec3& p) {
          return planted * box.field(glm::inverse(box.edges_m) * p) / box.volumes;
        },
        hg(box.g));
  const PathTracer& tracer = medium.tracer();
  std::array<double, 3> areas_m2;
  for (int a = 0; a < 3; ++a)
    areas_m2[std::size_t(a)] =
        glm::length(glm::cross(box.edges_m[(a + 1) % 3], box.edges_m[(a + 2) % 3]));
  const double half_m2 = areas_m2[0] + areas_m2[1] + areas_m2[2];
  const double volume_m3 = std::abs(glm::determinant(box.edges_m));
  const auto ours = measure_to<1>(1, [&](Random& random) {
    double pick = half_m2 * random.uniform();
    int axis = 0;
    while (axis < 2 && pick >= areas_m2[std::size_t(axis)]) pick -= areas_m2[std::size_t(axis++)];
    glm::dvec3 q{random.uniform(), random.uniform(), random.uniform()};
    q[axis] = random.uniform() < 0.5 ? 0 : 1;
    glm::dvec3 normal =
        glm::normalize(glm::cross(box.edges_m[(axis + 1) % 3], box.edges_m[(axis + 2) % 3]));
    if (glm::dot(normal, box.edges_m * (glm::dvec3{0.5} - q)) < 0) normal = -normal;
    const Ray in{box.edges_m * q, cosine_law(normal, random)};
    return std::array{double(walk(tracer, in, random).scatterings)};
  });
  EXPECT_EQ(tracer.medium().violations(), 0u);
  return {{"scatterings", ours[0], {4 * mean_of(box.field) * volume_m3 / (2 * half_m2)}}};
}

double clouds(const glm::dvec3& q) {
  return 1.5 * cloud(5.0 * q) + 0.0005;
}
double blobs(const glm::dvec3& q) {
  return 2.5 * puffs(3.0 * q);
}
// A ball by what part of a cell is in it: thin where it is cut.
double voxel_ball(const glm::dvec3& q) {
  return 0.02 * std::clamp((0.4 - glm::length(q - 0.5)) * kCells + 0.5, 0.0, 1.0);
}

class Boxes : public testing::TestWithParam<Box> {};
TEST_P(Boxes, ScatterByTheIntegralOfTheirField) {
  expect_agreement("box " + GetParam().name, run(GetParam()));
}
const glm::dmat3 kCube{1000.0};
const glm::dmat3 kSheared{glm::dvec3{1200, 100, -200}, glm::dvec3{-300, 900, 0},
                          glm::dvec3{150, 250, 700}};
const std::vector<Box> kBoxes{
    {"of_clouds", kCube, 0.85, 1, clouds},        {"of_clouds_backward", kCube, -0.7, 1, clouds},
    {"of_blobs_peaked", kCube, 0.9999, 1, blobs}, {"sheared", kSheared, 0.5, 1, clouds},
    {"of_voxels", kCube, 0.85, 1, voxel_ball},    {"of_two_volumes", kSheared, 0.85, 2, clouds}};
INSTANTIATE_TEST_SUITE_P(Truth, Boxes, testing::ValuesIn(kBoxes),
                         [](const auto& with) { return with.param.name; });

TEST(PathLengthBias, OfExtinctionInABoxIsCaught) {
  expect_caught("box of_clouds", run(kBoxes[0], 1 + kBias));
}

}  // namespace
}  // namespace nepho::test
