#include "truth_support.h"

#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "accuracy_report.h"

namespace nepho::test {
namespace {

// Two-sided p of kAccept, in standard errors.
constexpr double kAcceptSigmas = 3.2905;

struct Judged {
  double p, power, sigma;
};
Judged judge(const std::string& name, const Compared& c) {
  const double sigma = std::hypot(c.ours.standard_error, c.truth.standard_error);
  const Judged judged{z_test(c.ours, c.truth).p, power(kBias * c.truth.value, sigma), sigma};
  std::printf("truth: | %s: %s | %.6g | %.6g | %.2g | %.3f | %.3f |\n", name.c_str(),
              c.what.c_str(), c.truth.value, c.ours.value, sigma, judged.p, judged.power);
  return judged;
}

}  // namespace

double sample_factor() {
  const char* text = std::getenv("NEPHO_TRUTH_SAMPLES");
  return text ? std::max(1.0, std::atof(text)) : 1.0;
}

std::uint64_t case_seed() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::uint64_t seed = 0xcbf29ce484222325u;  // FNV-1a
  for (const char* names : {test->test_suite_name(), test->name()})
    for (const char* c = names; *c; ++c) seed = (seed ^ std::uint64_t(*c)) * 0x100000001b3u;
  return seed;
}

void expect_agreement(const std::string& name, const std::vector<Compared>& all) {
  ASSERT_FALSE(all.empty());
  for (const Compared& c : all) {
    const Judged judged = judge(name, c);
    EXPECT_GT(judged.p, kAccept) << name << ": " << c.what;
    EXPECT_GT(judged.power, kPower) << name << ": " << c.what;
    append_accuracy_row("Path tracer against truth", name + ": " + c.what,
                        std::abs(c.ours.value / c.truth.value - 1),
                        kAcceptSigmas * judged.sigma / std::abs(c.truth.value), "1");
  }
}

void expect_caught(const std::string& name, const std::vector<Compared>& all) {
  double least = 1;
  for (const Compared& c : all) least = std::min(least, judge(name + ", 2 % off", c).p);
  EXPECT_LT(least, kAccept) << name;
}

Medium::Medium() {
  request.sun.irradiance_W_per_m2_nm = glm::dvec3{0.0};
}

RenderVolume& Medium::add(std::shared_ptr<const BrickSource> source, const Phase& phase,
                          double co_albedo) {
  RenderVolume volume;
  volume.source = source.get();
  volume.phase = phase;
  volume.co_albedo = glm::dvec3{co_albedo};
  sources_.push_back(std::move(source));
  request.volumes.push_back(volume);
  return request.volumes.back();
}

const PathTracer& Medium::tracer() {
  if (!tracer_) {
    forest_ = finest_forest(request, 4096);
    tracer_ = std::make_unique<PathTracer>(forest_, request, settings);
  }
  return *tracer_;
}

glm::dvec3 cosine_law(const glm::dvec3& normal, Random& random) {
  const double u = random.uniform();
  return turned(normal, {u / (1 + std::sqrt(1 - u)), std::sqrt(u)}, random);
}

void add_slab(Medium& medium, Profile profile, double optical_depth, const Phase& phase,
              double co_albedo) {
  const double mean_per_m = optical_depth / kSlab_m;
  medium.add(
      std::make_shared<BoxChart>(glm::dvec3{0.0}, glm::dmat3(kSlab_m), Periodic{true, true}),
      isotropic(profile == Profile::kTent ? 1 : 0),
      [=](const glm::dvec3& p) {
        if (profile == Profile::kEven) return mean_per_m;
        return 2 * mean_per_m * (1 - std::abs(2 * p.z / kSlab_m - 1));
      },
      phase, co_albedo);
}

void add_ball(Medium& medium, double optical_depth, const Phase& phase, double co_albedo) {
  const double per_m = optical_depth / (2 * kBallRadius_m);
  medium.add(
      std::make_shared<ShellChart>(Ellipsoid::sphere(kBallRadius_m), -0.999 * kBallRadius_m, 0.0),
      Lattice({}), [=](const glm::dvec3&) { return per_m; }, phase, co_albedo);
}

}  // namespace nepho::test
