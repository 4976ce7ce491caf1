#include <functional>
#include <numbers>

#include "optics/phase_table.h"
#include "physics/physics_cpp.h"
#include "truth_support.h"

// Each sampler follows the density that it tells, also where that is extreme.

namespace nepho::test {
namespace {

using std::numbers::pi;

constexpr int kBins = 160;
constexpr double kEnd = 40;

// Bins of v = ln((1 - mu) / (1 + mu)) from -40 to 40 are narrow at both ends of 1 - mu.
double down_of(double v) {
  return 2 / (1 + std::exp(-v));
}
int bin_of(double one_minus_cos) {
  const double v = std::log(one_minus_cos / (2 - one_minus_cos));
  return int(std::clamp((v + kEnd) / (2 * kEnd) * kBins, 0.0, kBins - 1.0));
}

// Integral of density(1 - mu), 1/sr, over each bin: its element is 2 pi (1 - mu) (1 + mu) / 2 dv.
std::array<double, kBins> masses(const std::function<double(double)>& density) {
  constexpr int steps = 512;
  constexpr double width = 2 * kEnd / kBins / steps;
  const auto at = [&](double v) {
    const double down = down_of(v), up = down_of(-v);
    return pi * down * up * density(down);
  };
  std::array<double, kBins> mass{};
  for (int b = 0; b < kBins; ++b)
    for (int s = 0; s < steps; ++s)
      mass[std::size_t(b)] += width * at(-kEnd + (b * steps + s + 0.5) * width);
  return mass;
}

struct Followed {
  double integral = 0, p = 0, off = 0;  // off: sin^2 from 1 - cos^2
};
Followed follow_density(const std::function<Turn(Random&)>& sample,
                        const std::function<double(double)>& density) {
  const auto count = std::size_t(400000 * sample_factor());
  std::array<double, kBins> counts{}, expected = masses(density);
  Followed followed;
  for (const double mass : expected) followed.integral += mass;
  for (double& mass : expected) mass *= double(count) / followed.integral;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(case_seed(), i, 0);
    const Turn turn = sample(random);
    followed.off = std::max(followed.off, std::abs(turn.sine * turn.sine -
                                                   turn.one_minus_cos * (2 - turn.one_minus_cos)));
    ++counts[std::size_t(bin_of(turn.one_minus_cos))];
  }
  followed.p = chi_square(counts, expected).p;
  EXPECT_LT(followed.off, 1e-11);
  std::printf("truth: | chi-square | integral %.8f | p %.4f |\n", followed.integral, followed.p);
  return followed;
}

struct Peak {
  double g;
};
void PrintTo(const Peak& peak, std::ostream* out) {
  *out << "g = " << peak.g;
}
class HenyeyGreenstein : public testing::TestWithParam<Peak> {};
TEST_P(HenyeyGreenstein, IsSampledByItsDensity) {
  const double g = GetParam().g;
  const Followed followed =
      follow_density([&](Random& random) { return sample_hg(g, random.uniform()); },
                     [&](double down) { return f64::hg_phase(down, g); });
  EXPECT_NEAR(followed.integral, 1, 1e-6);
  EXPECT_GT(followed.p, kAccept);
}
INSTANTIATE_TEST_SUITE_P(Truth, HenyeyGreenstein,
                         testing::Values(Peak{0}, Peak{0.85}, Peak{-0.6}, Peak{0.99}, Peak{0.9999},
                                         Peak{-0.9999}),
                         [](const auto& with) {
                           const double g = with.param.g;
                           return (g < 0 ? "minus_" : "") +
                                  std::to_string(int(std::lround(std::abs(g) * 1e4)));
                         });

TEST(HenyeyGreensteinEnds, AreFiniteAndExact) {
  for (const double g : {-0.9999, -0.5, 0.0, 1e-9, 0.85, 0.9999}) {
    const Turn forward = sample_hg(g, 1), backward = sample_hg(g, 0);
    const auto expect = [&](const Turn& turn, double down) {
      EXPECT_NEAR(turn.one_minus_cos, down, 4e-16) << g;
      EXPECT_NEAR(turn.sine, 0, 1e-15) << g;
    };
    expect(forward.one_minus_cos < backward.one_minus_cos ? forward : backward, 0);
    expect(forward.one_minus_cos < backward.one_minus_cos ? backward : forward, 2);
    for (const double u : {0x1p-53, 0.25, 0.5, 1 - 0x1p-53}) {
      const Turn turn = sample_hg(g, u);
      EXPECT_TRUE(std::isfinite(turn.one_minus_cos) && turn.sine >= 0) << g << " " << u;
      EXPECT_NEAR(std::hypot(1 - turn.one_minus_cos, turn.sine), 1, 1e-14) << g << " " << u;
    }
  }
}

// Parameters of Jendersie and d'Eon (2023, doi:10.1145/3587421.3595409) for 20 um, and limits.
struct DrainePhase {
  double g, alpha;
};
void PrintTo(const DrainePhase& phase, std::ostream* out) {
  *out << phase.g << " " << phase.alpha;
}
class Draine : public testing::TestWithParam<DrainePhase> {};
TEST_P(Draine, IsSampledByItsDensity) {
  const auto [g, alpha] = GetParam();
  const auto sample = [&, g = g, alpha = alpha](Random& random) {
    return sample_draine(g, alpha, random);
  };
  const Followed followed = follow_density(
      sample, [&, g = g, alpha = alpha](double down) { return draine_phase(down, g, alpha); });
  EXPECT_NEAR(followed.integral, 1, 1e-6);
  EXPECT_GT(followed.p, kAccept);
  const auto mean = measure_to<1>(
      1, [&](Random& random) { return std::array{1 - sample(random).one_minus_cos}; });
  const double exact = g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3);
  expect_agreement("Draine g " + std::to_string(g), {{"mean cosine", mean[0], {exact}}});
}
INSTANTIATE_TEST_SUITE_P(Truth, Draine,
                         testing::Values(DrainePhase{0.593791, 27.1137}, DrainePhase{0.5, 1},
                                         DrainePhase{0.9, 0}, DrainePhase{0.994, 1}),
                         [](const auto& with) {
                           return "alpha_" + std::to_string(int(with.param.alpha)) + "_g_" +
                                  std::to_string(int(1000 * with.param.g));
                         });

// The peak alone, as far as it reaches.
class Peaks : public testing::TestWithParam<int> {};
TEST_P(Peaks, AreSampledByTheirDensity) {
  const PhaseKind kinds[] = {PhaseKind::kMie, PhaseKind::kHgDraine, PhaseKind::kHenyeyGreenstein};
  const PhaseSampler sampler(Phase{kinds[GetParam()], 10e-6, 0.85});
  ASSERT_TRUE(sampler.has_peak());
  for (int wavelength = 0; wavelength < 3; ++wavelength) {
    const Followed followed =
        follow_density([&](Random& random) { return sampler.sample_peak(wavelength, random); },
                       [&](double down) { return sampler.peak_values(down)[wavelength]; });
    EXPECT_NEAR(followed.integral, 1, 1e-3);  // of a jump at the end, in bins
    EXPECT_GT(followed.p, kAccept);
  }
}
INSTANTIATE_TEST_SUITE_P(Truth, Peaks, testing::Values(0, 1, 2), testing::PrintToStringParamName());

class FittedDroplets : public testing::TestWithParam<int> {};
TEST_P(FittedDroplets, AreSampledByTheirFormula) {
  const Phase phase{PhaseKind::kHgDraine, GetParam() * 1e-6, 0};
  const PhaseSampler sampler(phase);
  EXPECT_TRUE(sampler.grey());
  const auto sample = [&](Random& random) { return sampler.sample(1, random); };
  const Followed followed =
      follow_density(sample, [&](double down) { return sampler.value(1, down); });
  EXPECT_NEAR(followed.integral, 1, 1e-5);
  EXPECT_GT(followed.p, kAccept);
  const auto turned_away =
      measure_to<1>(1, [&](Random& random) { return std::array{sample(random).one_minus_cos}; });
  expect_agreement("HG + Draine, " + std::to_string(GetParam()) + " um",
                   {{"1 - asymmetry", turned_away[0], {1 - phase_bulk(phase).asymmetry[1]}}});
}
INSTANTIATE_TEST_SUITE_P(Truth, FittedDroplets, testing::Values(3, 10, 25),
                         testing::PrintToStringParamName());

TEST(Rayleigh, IsSampledByItsDensity) {
  const Followed followed = follow_density(
      sample_rayleigh, [](double down) { return 3 / (16 * pi) * (1 + (1 - down) * (1 - down)); });
  EXPECT_NEAR(followed.integral, 1, 1e-6);
  EXPECT_GT(followed.p, kAccept);
}

class Droplets : public testing::TestWithParam<int> {};
TEST_P(Droplets, AreSampledByTheirTable) {
  const Phase phase{.effective_radius_m = GetParam() * 1e-6};
  const PhaseSampler sampler(phase);
  for (int wavelength = 0; wavelength < 3; ++wavelength) {
    const auto sample = [&](Random& random) { return sampler.sample(wavelength, random); };
    const Followed followed =
        follow_density(sample, [&](double down) { return sampler.value(wavelength, down); });
    EXPECT_NEAR(followed.integral, 1, 1e-5);
    EXPECT_GT(followed.p, kAccept);
    const auto turned_away = measure_to<1>(std::uint64_t(wavelength), [&](Random& random) {
      return std::array{sample(random).one_minus_cos};
    });
    const double exact = 1 - phase_bulk(phase).asymmetry[std::size_t(wavelength)];
    expect_agreement(std::to_string(GetParam()) + " um, colour " + std::to_string(wavelength),
                     {{"1 - asymmetry", turned_away[0], {exact, 1e-4}}});
  }
}
INSTANTIATE_TEST_SUITE_P(Truth, Droplets, testing::Values(4, 10, 30),
                         testing::PrintToStringParamName());

TEST(Turned, KeepsItsAngleAndTakesAllAzimuths) {
  constexpr std::size_t bins = 64, count = 64000;
  for (const glm::dvec3& along :
       {glm::dvec3{0, 0, 1}, glm::dvec3{0, 0, -1}, glm::normalize(glm::dvec3{1e-9, -1, -1e-12}),
        glm::normalize(glm::dvec3{1, 2, -3})}) {
    std::array<double, bins> counts{}, expected;
    expected.fill(double(count) / bins);
    const glm::dvec3 side = glm::normalize(glm::cross(along, glm::dvec3{0.6, 0.7, 0.1}));
    for (std::size_t i = 0; i < count; ++i) {
      Random random(case_seed(), i, 0);
      const Turn turn = sample_hg(0.3, random.uniform());
      const glm::dvec3 way = turned(along, turn, random);
      EXPECT_NEAR(glm::length(way), 1, 1e-15);
      EXPECT_NEAR(one_minus_cos(along, way), turn.one_minus_cos, 1e-14);
      const double azimuth =
          std::atan2(glm::dot(way, glm::cross(along, side)), glm::dot(way, side));
      ++counts[std::min(std::size_t((azimuth / (2 * pi) + 0.5) * bins), bins - 1)];
    }
    EXPECT_GT(chi_square(counts, expected).p, kAccept);
  }
}

TEST(RandomNumbers, AreEvenAndReachFar) {
  Random random(1, 2, 3);
  std::vector<double> even, free;
  double most = 0;
  for (int i = 0; i < 100000; ++i) {
    even.push_back(random.uniform());
    free.push_back(random.depth());
    ASSERT_TRUE(even.back() >= 0 && even.back() < 1);
    most = std::max(most, free.back());
  }
  EXPECT_GT(kolmogorov_smirnov(even, [](double x) { return x; }).p, kAccept);
  EXPECT_GT(kolmogorov_smirnov(free, [](double x) { return -std::expm1(-x); }).p, kAccept);
  EXPECT_GT(most, 8);
}

}  // namespace
}  // namespace nepho::test
