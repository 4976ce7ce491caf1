// The march over a source's own field: against closed forms and sums along the ray, where bricks
// are off by what they cannot hold.
#include "reference/own_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy_report.h"
#include "core/error.h"
#include "march_support.h"
#include "own_source.h"

namespace nepho {
namespace {

using test::FieldSource;
using test::FixedLevel;
using test::OwnSource;
constexpr double kSide_m = 1000, kWidth_m = 90;
const glm::dvec3 kMiddle_m{kSide_m / 2};

double puff(glm::dvec3 p) {
  const glm::dvec3 d = (p - kMiddle_m) / kWidth_m;
  return 0.02 * std::exp(-0.5 * glm::dot(d, d));
}

double depth(const LevelSet& levels, const Ray& ray) {
  return RayMarch(levels, test::request_of({})).optical_depth(ray);
}

double sum_along(const Ray& ray, double length_m, const OwnSource::Field& field) {
  constexpr int kSteps = 100'000;
  double sum = 0;
  for (int n = 0; n < kSteps; ++n)
    sum += field(ray.origin_m + (n + 0.5) / kSteps * length_m * ray.direction);
  return sum * length_m / kSteps;
}

TEST(OwnField, depth_through_a_puff_is_its_closed_form) {
  const FieldSource bricks(test::box(kSide_m), test::isotropic(2), puff);
  const OwnSource source(bricks, puff);
  const FixedLevel levels({&source}, 2);  // cells of 31 m
  const std::vector<RenderVolume> volumes{test::volume_of(source)};
  const OwnField field(levels, volumes, 1);
  double own = 0, interpolated = 0;
  for (const double miss_m : {0.0, 35.0, 80.0}) {
    const Ray ray{{-200, kMiddle_m.y + miss_m, kMiddle_m.z - 7}, {1, 0, 0}};
    const double exact = 0.02 * std::exp(-0.5 * (miss_m * miss_m + 49) / (kWidth_m * kWidth_m)) *
                         kWidth_m * std::sqrt(2 * std::numbers::pi);
    own = std::max(own, std::abs(depth(field, ray) / exact - 1));
    interpolated = std::max(interpolated, std::abs(depth(levels, ray) / exact - 1));
  }
  test::report_accuracy("reference march", "own field, optical depth, one step a cell", own, 1e-5,
                        "relative");
  EXPECT_LE(own, 1e-5);
  EXPECT_GT(interpolated, 100 * own);  // what the data term is about
}

TEST(OwnField, goes_on_through_the_periods_of_a_box) {
  const auto wave = [](glm::dvec3 p) {
    return 1e-3 * (1.2 + std::sin(2 * std::numbers::pi * p.x / kSide_m));
  };
  const FieldSource bricks(test::box(kSide_m, {.x = true, .y = true}), test::isotropic(1), wave);
  const OwnSource source(bricks, wave);
  const FixedLevel levels({&source}, 1);
  const std::vector<RenderVolume> volumes{test::volume_of(source)};
  const OwnField field(levels, volumes, 2);
  const Ray ray{{100, 200, kSide_m}, glm::normalize(glm::dvec3(-3.3, 0.7, -1))};
  const double exact = sum_along(ray, -kSide_m / ray.direction.z, wave);
  EXPECT_NEAR(depth(field, ray) / exact, 1, 1e-4);
}

TEST(OwnField, is_asked_for_at_the_places_of_a_shell) {
  const Ellipsoid earth = Ellipsoid::sphere(6371000);
  const auto chart = std::make_shared<ShellChart>(earth, 0.0, 8000.0);
  const auto haze = [](glm::dvec3 p) { return 1e-5 * (2 + std::sin(p.x / 3e4 + p.z / 2e4)); };
  const FieldSource bricks(chart, test::isotropic(1), haze);
  const OwnSource source(bricks, haze);
  const FixedLevel levels({&source}, 1);
  const std::vector<RenderVolume> volumes{test::volume_of(source)};
  const OwnField field(levels, volumes, 256);  // cells of 600 km
  const glm::dvec3 down = glm::normalize(glm::dvec3(-1, -0.6, -0.4));
  const glm::dvec3 ground_m = chart->ecef_m({0, {0.3, 0.6, 0}});
  const Ray ray{ground_m - 60000.0 * down, down};
  const auto inside = [&](glm::dvec3 p) {
    const double up = chart->locate(p).q.z;
    return up >= 0 && up <= 1 ? haze(p) : 0;
  };
  EXPECT_NEAR(depth(field, ray) / sum_along(ray, 60000, inside), 1, 2e-3);
}

TEST(OwnField, a_source_without_one_is_refused) {
  const FieldSource source(test::box(kSide_m), test::isotropic(1), puff);
  const FixedLevel levels({&source}, 1);
  const std::vector<RenderVolume> volumes{test::volume_of(source)};
  try {
    const OwnField field(levels, volumes, 1);
    FAIL() << "took bricks for a field";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no field of its own"), std::string::npos);
  }
}

}  // namespace
}  // namespace nepho
