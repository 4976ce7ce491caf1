// Stiff cases of planets and lattices: each computes its naive form beside the project's.
#include <cmath>
#include <numbers>

#include "bricks/lattice.h"
#include "expect_stable.h"
#include "physics/physics_cpp.h"
#include "random.h"

namespace nepho::test {
namespace {

using Real = long double;
constexpr double kRadius_m = 6371e3;

TEST(Shell, HeightOfAPointNearby) {
  Random random;
  double worst = 0, naive = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const glm::vec3 q(glm::dvec3(random.uniform(-2e4, 2e4), random.uniform(-2e4, 2e4),
                                 random.uniform(-100, 1e3)));
    const Real x = q.x, y = q.y, z = q.z, r = kRadius_m;
    const Real rise = 2 * r * z + x * x + y * y + z * z;
    const Real exact = rise / (std::sqrt(r * r + rise) + r);
    const float found = f32::height_of_offset(float(kRadius_m), q.z, glm::dot(q, q));
    worst = std::max(worst, double(std::abs(Real(found) - exact)));
    const glm::vec3 p(q.x, q.y, float(kRadius_m) + q.z);
    naive = std::max(naive, double(std::abs(Real(glm::length(p) - float(kRadius_m)) - exact)));
  }
  expect_stable("13", worst, 3e-4, naive, "m, within 20 km");
}

struct Sight {
  double eye_m, shell_m, elevation_rad;
};

// Distance from inside a shell to it, forwards: of floats, in extended precision and as is usual.
Real exact_exit_m(float radius, float above, float sine) {
  const Real b = Real(radius) * Real(sine), c = Real(above) * (2 * Real(radius) - Real(above));
  const Real root = std::sqrt(b * b - c);
  return b > 0 ? -c / (b + root) : root - b;
}
float naive_exit_m(float radius, float shell_radius, float sine) {
  const float b = radius * sine, c = radius * radius - shell_radius * shell_radius;
  return -b + std::sqrt(std::max(b * b - c, 0.0f));
}

TEST(Shell, DistanceFromUnderIt) {
  double worst = 0, naive = 0;
  for (const Sight& sight : {Sight{1.7, 2000, 0}, Sight{1.7, 2000, 0.05}, Sight{1.7, 2000, 1},
                             Sight{1999.99, 2000, 1e-3}, Sight{1999, 2000, 0.2}}) {
    const float radius = float(kRadius_m + sight.eye_m), above = float(sight.eye_m - sight.shell_m),
                sine = float(std::sin(sight.elevation_rad));
    float first = 0, second = 0;
    f32::sphere_wall_distances(radius, above, sine, first, second);
    const Real exact = exact_exit_m(radius, above, sine);
    worst = std::max(worst, double(std::abs(Real(second) - exact)));
    naive = std::max(
        naive, double(std::abs(Real(naive_exit_m(radius, float(kRadius_m + sight.shell_m), sine)) -
                               exact)));
  }
  expect_stable("14", worst, 1e-2, naive, "m, up to 160 km");
}

// Rays within some ulp of the limb, from 400 km: hit or miss, decided of the same floats. A wrong
// decision counts by how far its ray passes the limb.
TEST(Shell, LimbIsHitOrMissed) {
  double worst = 0, naive = 0;
  int hits = 0, rays = 0;
  for (double shell_m = 2000; shell_m < 20000; shell_m += 137) {
    const float radius = float(kRadius_m + 4e5), above = float(4e5 - shell_m);
    const Real c = Real(above) * (2 * Real(radius) - Real(above));
    float sine = float(-std::sqrt(c) / Real(radius));
    for (int ulp = 0; ulp < 40; ++ulp) sine = std::nextafter(sine, -1.0f);
    for (int ulp = 0; ulp < 80; ++ulp, sine = std::nextafter(sine, 0.0f)) {
      const Real b = Real(radius) * Real(sine), past_m = std::abs(b * b - c) / (2 * Real(radius));
      const bool hit = b * b >= c;
      float first = 0, second = 0;
      f32::sphere_wall_distances(radius, above, sine, first, second);
      if ((first < f32::no_hit()) != hit) worst = std::max(worst, double(past_m));
      const float fb = radius * sine, shell = radius - above;
      if ((fb * fb - (radius * radius - shell * shell) >= 0) != hit)
        naive = std::max(naive, double(past_m));
      hits += hit;
      ++rays;
    }
  }
  EXPECT_GT(hits, rays / 4);
  EXPECT_LT(hits, rays * 3 / 4);
  expect_stable("15", worst, 0.05, naive, "m past the limb");
}

TEST(Shell, TheSunSetsGradually) {
  constexpr double step_rad = 1e-5;
  double worst = 0, naive = 0;
  for (const double height_m : {0.0, 2000.0, 12000.0, 4e5}) {
    float before = 0;
    bool risen_before = false;
    const double dip = std::acos(kRadius_m / (kRadius_m + height_m));
    for (double sun = -dip - 0.01; sun < -dip + 0.01; sun += step_rad) {
      const float seen =
          f32::sun_above_horizon(float(kRadius_m), float(height_m), float(std::sin(sun)));
      EXPECT_GE(seen, before - 1e-3f);  // float's rounding of the angle; monotone but for it
      EXPECT_LE(seen, 1);
      worst = std::max(worst, std::abs(double(seen - before)));
      before = seen;
      const bool risen = sun > -dip;  // a sun without extent
      naive = std::max(naive, double(risen != risen_before));
      risen_before = risen;
    }
    EXPECT_EQ(before, 1);
  }
  expect_stable("21", worst, 0.01, naive, "of the disc in 1e-5 rad");
}

TEST(Lattice, NodesAreFoundAtAnyDepth) {
  const Lattice lattice(std::vector<SplitMask>(16, kSplitXyz));
  Random random;
  int missed = 0, naive = 0, asked = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    const int level = random.integer(0, 16);
    const Index3 n = lattice.nodes(level);
    Index3 at{}, sample{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = std::uint32_t(random.integer(0, int(n[axis]) - 1));
      sample[axis] = std::uint32_t(random.integer(0, 7));
    }
    const NodeKey key(0, level, at[0], at[1], at[2]);
    const glm::dvec3 q = lattice.q(level, Lattice::global_sample(key, sample));
    missed += lattice.node_at(0, q, level) != key;
    // Corners in metres from the planet's centre, as float, of a root as wide as a planet.
    const float width_m = 12.8e6f, node_m = width_m / float(n[0]);
    const glm::vec3 metres =
        glm::vec3(q) * width_m + glm::vec3(float(kRadius_m)) - glm::vec3(float(kRadius_m));
    for (int axis = 0; axis < 3; ++axis)
      if (std::uint32_t(std::floor(metres[axis] / node_m)) != at[std::size_t(axis)]) {
        ++naive;
        break;
      }
    ++asked;
  }
  expect_stable("39", double(missed) / asked, 0, double(naive) / asked, "of the nodes missed");
}

}  // namespace
}  // namespace nepho::test
