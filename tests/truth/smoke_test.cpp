#include "analytic_field.h"
#include "truth_support.h"

namespace nepho::test {
namespace {

Phase hg(double g) {
  return {.kind = PhaseKind::kHenyeyGreenstein, .asymmetry = g};
}

// Cosine-law inflow on the box's surface: mean number of scatterings is 4 int k dV / S for any
// field and phase function (Blanco and Fournier 2003).
TEST(PathLength, IsInvariantInAHeterogeneousBox) {
  const double side = 1000;
  Medium m(std::make_shared<BoxChart>(glm::dvec3{0.0}, glm::dmat3(side)), 2, hg(0.85), 0,
           [&](const glm::dvec3& p) { return 1.5 * cloud(p / 200.0) + 0.001; });
  // integral by samples of the trilinear field = sum c V
  double sum = 0;
  const int n = 32;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double w =
            (i == 0 || i == n ? .5 : 1) * (j == 0 || j == n ? .5 : 1) * (k == 0 || k == n ? .5 : 1);
        sum += w * (1.5 * cloud(glm::dvec3(i, j, k) * (side / n) / 200.0) + 0.001);
      }
  const double exact = 4 * sum * std::pow(side / n, 3) / (6 * side * side);
  PathTracer tracer(m.forest, m.request);
  const Measured got = measure(1, 200000, [&](Random& random) {
    const int axis = int(3 * random.uniform()), up = random.uniform() < 0.5;
    glm::dvec3 p{side * random.uniform(), side * random.uniform(), side * random.uniform()};
    p[axis] = up ? side : 0;
    glm::dvec3 normal{0.0};
    normal[axis] = up ? -1 : 1;
    const double u = random.uniform(), c = std::sqrt(1 - u);
    Ray ray{p, turned(normal, {1 - c, std::sqrt(u)}, random)};
    int count = 0;
    while (true) {
      const auto hit = tracer.medium().collide(ray, kNoDistance_m, random);
      if (hit.volume < 0) return double(count);
      ++count;
      ray.origin_m += hit.t_m * ray.direction;
      ray.direction = tracer.scattered(hit, ray.direction, 1, random);
    }
  });
  std::printf("scatterings %.5f +- %.5f exact %.5f z %.2f violations %lu\n", got.mean,
              got.standard_error, exact, (got.mean - exact) / got.standard_error,
              tracer.medium().violations());
  EXPECT_LT(std::abs(got.mean - exact), 4 * got.standard_error);
}

TEST(Slab, ReflectsAsInTheTable) {
  for (const double tau : {1.0, 8.0}) {
    Medium m(std::make_shared<BoxChart>(glm::dvec3{0.0}, glm::dmat3(100.0), Periodic{true, true}),
             1, hg(0.85), 0,
             [&](const glm::dvec3& p) { return 2 * tau / 100 * (1 - std::abs(p.z / 50 - 1)); });
    PathTracer tracer(m.forest, m.request);
    const Measured got = measure(1, 200000, [&](Random& random) {
      Ray ray{{50, 50, 101}, {0, 0, -1}};
      while (true) {
        const auto hit = tracer.medium().collide(ray, kNoDistance_m, random);
        if (hit.volume < 0) return ray.direction.z > 0 ? 1.0 : 0.0;
        ray.origin_m += hit.t_m * ray.direction;
        ray.direction = tracer.scattered(hit, ray.direction, 1, random);
      }
    });
    std::printf("tau %g R %.5f +- %.5f\n", tau, got.mean, got.standard_error);
  }
}

TEST(Furnace, IsWhite) {
  Medium m(std::make_shared<BoxChart>(glm::dvec3{0.0}, glm::dmat3(1000.0)), 2, {}, 0,
           [&](const glm::dvec3& p) { return 3 * cloud(p / 200.0); });
  m.request.sky.zenith_W_per_m2_sr_nm = m.request.sky.horizon_W_per_m2_sr_nm =
      m.request.sky.below_W_per_m2_sr_nm = glm::dvec3{1.0};
  m.request.sun.irradiance_W_per_m2_nm = glm::dvec3{0.0};
  m.request.camera.eye_m = {-1500, 300, 700}, m.request.camera.target_m = {500, 500, 500};
  m.request.settings.width = 32, m.request.settings.height = 18;
  PathTracer tracer(m.forest, m.request);
  const PathPicture picture = path_trace(tracer, m.request, {.samples = 64}, {});
  double worst = 0, mean = 0;
  for (const float v : picture.image.rgb)
    worst = std::max(worst, std::abs(double(v) - 1)), mean += v;
  std::printf("furnace mean %.6f worst %.4f noise %.5f\n", mean / double(picture.image.rgb.size()),
              worst, picture.noise);
}

}  // namespace
}  // namespace nepho::test
