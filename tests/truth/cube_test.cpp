#include "truth_support.h"
#include "truth_table.h"

// Through which faces a cube in the sun lets go of its light, against histories of another program.

namespace nepho::test {
namespace {

const std::array<std::string, 6> kFaces{"px", "mx", "py", "my", "top", "bottom"};

struct Cube {
  std::string name;
  double depth, sun_zenith_deg, g;
  bool ramps;  // as two volumes over each other, whose extinctions rise and fall along the cube
};
void PrintTo(const Cube& cube, std::ostream* out) {
  *out << cube.name;
}
const std::vector<Cube> kCubes{{"tau2_overhead", 2, 0, 0.85, false},
                               {"tau2_slanted", 2, 60, 0.85, false},
                               {"tau10_overhead_of_two_ramps", 10, 0, 0.85, true},
                               {"tau10_slanted_of_two_ramps", 10, 60, 0.85, true},
                               {"tau10_even_phase", 10, 0, 0, false}};

void add_cube(Medium& medium, const Cube& cube, double co_albedo) {
  const auto chart = std::make_shared<BoxChart>(glm::dvec3{0.0}, glm::dmat3(1.0));
  const auto add = [&](auto&& field) {
    medium.add(chart, isotropic(1), field, hg(cube.g), co_albedo);
  };
  if (!cube.ramps) return add([&](const glm::dvec3&) { return cube.depth; });
  const glm::dvec3 along = cube.depth * glm::dvec3{0.5, 0.2, 0.3};
  add([&](const glm::dvec3& p) { return glm::dot(along, p); });
  add([&](const glm::dvec3& p) { return glm::dot(along, 1.0 - p); });
}

// The face through which a ray from inside leaves.
std::size_t face_of(const Ray& ray) {
  double least = kNoDistance_m;
  std::size_t face = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = ray.direction[a], wall = d > 0 ? 1 : 0;
    const double t = d == 0 ? kNoDistance_m : (wall - ray.origin_m[a]) / d;
    if (t < least) least = t, face = std::size_t(2 * a + (d > 0 ? 0 : 1));
  }
  return face;
}

struct Faces {
  std::array<Estimate, 6> ours, truth;
};
Faces run(const Cube& cube, double co_albedo = 0) {
  const TruthTable table(NEPHO_TRUTH_DIR "/cube_escape.csv");
  std::size_t row = 0;
  while (table.at(row, "tau") != cube.depth || table.at(row, "sza_deg") != cube.sun_zenith_deg ||
         table.at(row, "g") != cube.g)
    ++row;
  Faces faces;
  for (std::size_t f = 0; f < 6; ++f)
    faces.truth[f] = {table.at(row, kFaces[f]), table.at(row, kFaces[f] + "_se")};
  Medium medium;
  add_cube(medium, cube, co_albedo);
  const PathTracer& tracer = medium.tracer();
  const double zenith_rad = cube.sun_zenith_deg * 0.017453292519943295;
  const glm::dvec3 down{std::sin(zenith_rad), 0, -std::cos(zenith_rad)};
  const double top_part = -down.z / (down.x - down.z);
  const auto means = measure<6>(1, std::size_t(600000 * sample_factor()), [&](Random& random) {
    glm::dvec3 in{random.uniform(), random.uniform(), 1};
    if (random.uniform() >= top_part) in = {0, in.x, in.y};
    const Escape escape = walk(tracer, {in, down}, random);
    std::array<double, 6> hits{};
    if (!escape.absorbed) hits[face_of(escape.ray)] = 1;
    return hits;
  });
  for (std::size_t f = 0; f < 6; ++f) faces.ours[f] = mean_of(means[f]);
  EXPECT_EQ(tracer.medium().violations(), 0u);
  return faces;
}

// The faces that this number of histories can tell from ones that are 2 % off.
std::vector<Compared> bright(const Faces& faces) {
  std::vector<Compared> all;
  for (std::size_t f = 0; f < 6; ++f)
    if (faces.truth[f].value > 0.1) all.push_back({kFaces[f], faces.ours[f], faces.truth[f]});
  return all;
}

class Cubes : public testing::TestWithParam<Cube> {};
TEST_P(Cubes, LetGoThroughTheirFaces) {
  const Faces faces = run(GetParam());
  EXPECT_GT(z_per_pixel(faces.ours, faces.truth).p, kAccept);
  expect_agreement("cube " + GetParam().name, bright(faces));
}
INSTANTIATE_TEST_SUITE_P(Truth, Cubes, testing::ValuesIn(kCubes),
                         [](const auto& with) { return with.param.name; });

TEST(CubeBias, OfAlbedoIsCaught) {
  expect_caught("cube tau10", bright(run(kCubes[2], kBias)));
}

}  // namespace
}  // namespace nepho::test
