// What the procedural sky is drawn with: the functions of the closure, and noise that is standard
// normal with sound bounds.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "accuracy_report.h"
#include "random.h"
#include "sources/noise/lattice_noise.h"
#include "sources/noise/normal.h"
#include "sources/noise/planet.h"

namespace nepho::test {
namespace {

using namespace noise;

TEST(NoiseParts, NormalFunctionsAreTheLibrarys) {
  double exp_off = 0, cdf_off = 0, inverse_off = 0, tan_off = 0, turn_off = 0;
  for (int n = 0; n <= 4000; ++n) {
    const double x = n * 0.01;
    exp_off = std::max(exp_off, std::abs(exp_minus(x) / std::exp(-x) - 1) / (4e-16 * x + 1e-15));
    const double z = -6 + n * 0.003, p = normal_cdf(z);
    const double tail = 0.5 * std::erfc(std::abs(z) / std::sqrt(2.0));
    cdf_off = std::max(cdf_off, std::abs((z < 0 ? p : 1 - p) - tail) / (1.3e-7 * tail + 1e-16));
    if (std::abs(z) < 4) inverse_off = std::max(inverse_off, std::abs(normal_quantile(p) - z));
    const double s = -1 + n * 5e-4, exact = std::tan(s * 0.78539816339744831);
    if (s != 0) tan_off = std::max(tan_off, std::abs(tan_quarter_turn(s) - exact));
    const glm::dvec2 turn = cosine_sine(z * 20);
    turn_off = std::max(
        {turn_off, std::abs(turn.x - std::cos(z * 20)), std::abs(turn.y - std::sin(z * 20))});
  }
  EXPECT_EQ(exp_minus(800), 0);
  EXPECT_EQ(tan_quarter_turn(1), 1);
  EXPECT_EQ(tan_quarter_turn(0), 0);
  EXPECT_LE(exp_off, 1);
  EXPECT_LE(cdf_off, 1);
  EXPECT_LE(inverse_off, 1e-8);
  EXPECT_LE(tan_off, 1e-15);
  EXPECT_LE(turn_off, 1);
}

// E max(0, m + s Z) and its square, against the integral.
TEST(NoiseParts, ExpectedExcessIsTheIntegral) {
  double worst = 0;
  for (const double s : {0.05, 0.3, 1.0})
    for (double m = -3.5; m <= 3.5; m += 0.25) {
      double mean = 0, square = 0;
      constexpr double kStep = 1e-3;
      for (double z = -8; z < 8; z += kStep) {
        const double excess = std::max(0.0, m * s + s * z);
        const double w = std::exp(-0.5 * z * z) * kStep / std::sqrt(2 * 3.14159265358979);
        mean += w * excess, square += w * excess * excess;
      }
      const Moments found = expected_excess(m * s, s);
      worst = std::max(
          {worst, std::abs(found.mean - mean) / s, std::abs(found.square - square) / (s * s)});
    }
  report_accuracy("procedural sky", "closure of one octave's ramp, off its integral", worst, 2e-5,
                  "1");
  EXPECT_LE(worst, 2e-5);
  EXPECT_EQ(expected_excess(-4.0, 1).mean, 0);
  EXPECT_EQ(expected_excess(0.5, 0).mean, 0.5);
  EXPECT_EQ(expected_excess(0.5, 0).square, 0.25);
}

// Mean, variance and the shares beyond +-1 of a shape, over points and seeds.
TEST(NoiseParts, EveryShapeIsStandardNormal) {
  using Draw = std::function<double(const glm::dvec3&, std::uint32_t)>;
  const std::pair<const char*, Draw> shapes[] = {
      {"value, plane",
       [](const glm::dvec3& p, auto s) {
         return value_noise(glm::dvec2{p.x, p.y}, s);
       }},
      {"value, space", [](const glm::dvec3& p, auto s) { return value_noise(p, s); }},
      {"billow", [](const glm::dvec3& p, auto s) { return billow(value_noise(p, s)); }},
      {"cells", [](const glm::dvec3& p, auto s) {
         return cells(glm::dvec2{p.x, p.y}, s);
       }}};
  for (const auto& [name, draw] : shapes) {
    Random random;
    double mean = 0, square = 0, above = 0, below = 0;
    constexpr int kDraws = 200000;
    for (int n = 0; n < kDraws; ++n) {
      const glm::dvec3 p = {random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4),
                            random.uniform(-1e4, 1e4)};
      const double x = draw(p, std::uint32_t(n) * 2654435761u);
      mean += x, square += x * x, above += x > 1, below += x < -1;
    }
    mean /= kDraws;
    const double off =
        std::max({std::abs(mean), std::abs(square / kDraws - mean * mean - 1),
                  std::abs(above / kDraws - 0.1587), std::abs(below / kDraws - 0.1587)});
    report_accuracy("procedural sky", std::string("noise, ") + name + ": moments off a normal's",
                    off, 0.01, "1");
    EXPECT_LE(off, 0.01) << name;
  }
}

TEST(NoiseParts, RangesHoldTheirBoxes) {
  Random random;
  int outside = 0;
  double width = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double r = random.log_uniform(0.01, 1);
    const glm::dvec3 p = {random.uniform(-50, 50), random.uniform(-50, 50),
                          random.uniform(-50, 50)};
    const glm::dvec2 flat = {p.x, p.y};
    const auto seed = std::uint32_t(trial);
    const Range space = value_noise_range(p - glm::dvec3(r), p + glm::dvec3(r), seed);
    const Range plane = value_noise_range(flat - glm::dvec2(r), flat + glm::dvec2(r), seed);
    const Range disc = cells_range(flat, r, seed);
    for (int n = 0; n < 40; ++n) {
      const glm::dvec3 d = {random.uniform(-r, r), random.uniform(-r, r), random.uniform(-r, r)};
      const glm::dvec2 e = {d.x, d.y};
      const double a = value_noise(p + d, seed), b = value_noise(flat + e, seed);
      outside += a < space.low || a > space.high || b < plane.low || b > plane.high;
      if (glm::length(e) > r) continue;
      const double c = cells(flat + e, seed);
      outside += c < disc.low || c > disc.high;
    }
    if (r < 0.1) width = std::max(width, space.high - space.low);
  }
  EXPECT_EQ(outside, 0);
  EXPECT_LT(width, 6);  // not just the clip, 8
}

TEST(NoiseParts, SheetsKeepVarianceAndStormsTheirStretch) {
  const Sheets sheets(6.378137e6, 0.7, 11);
  const Storms storms(11);
  Random random;
  double variance_off = 0, worst = 0;
  int none = 0;
  for (int n = 0; n < 4000; ++n) {
    const glm::dvec3 d = random.direction();
    double square = 0;
    for (const SheetPoint& point : sheets.at(d)) square += point.weight * point.weight;
    none += sheets.at(d).size == 0;
    variance_off = std::max(variance_off, std::abs(square - 1));
    const double reach = random.log_uniform(1e-4, 0.05);
    const glm::dvec3 e = glm::normalize(d + reach * random.uniform(0, 1) * random.direction());
    const double apart = glm::length(e - d);
    if (apart > reach) continue;
    worst = std::max(
        worst, glm::length(storms.wound(e) - storms.wound(d)) / (apart * storms.stretch(d, reach)));
  }
  EXPECT_EQ(none, 0);
  EXPECT_LE(variance_off, 1e-12);
  EXPECT_LE(worst, 1);
}

}  // namespace
}  // namespace nepho::test
