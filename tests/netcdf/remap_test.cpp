// From a model's cells to hat samples: what is kept, where it lies, and that nothing shows where
// faces, longitudes and poles meet.

#include <gtest/gtest.h>

#include <random>

#include "accuracy_report.h"
#include "forecast/grids/cell_size.h"
#include "made_source.h"
#include "remapped.h"

namespace nepho::test {
namespace {

using Part = HatRemap::Part;

class Cases : public testing::TestWithParam<const char*> {};

TEST_P(Cases, TotalOpticalDepthIsTheFiles) {
  const Remapped r(synthetic_forecast(GetParam()));
  const double drift = std::abs(r.total() / file_total(r) - 1);
  report_accuracy("netcdf", "total optical depth, file against finest bricks", drift, 2e-3, "1");
  EXPECT_LE(drift, 2e-3);
  if (!r.remap->has_ice()) return;
  const double ice = std::abs(r.total(Part::kIce) / file_total(r, true) - 1);
  report_accuracy("netcdf", "total ice optical depth, file against finest bricks", ice, 2e-3, "1");
  EXPECT_LE(ice, 2e-3);
}

// Of columns in both modes: what fills the layers keeps their optical depth.
TEST_P(Cases, ColumnsAreTheFieldUnderTheSameKernel) {
  for (const forecast::Layers layers : {forecast::Layers::kSmooth, forecast::Layers::kConstant}) {
    const double rms = column_rms(Remapped(synthetic_forecast(GetParam()), {}, 0, 0, layers));
    report_accuracy("netcdf", "column optical depth against the field under the same hats, rms",
                    rms, 5e-3, "1");
    EXPECT_LE(rms, 5e-3);
  }
}

// Whole hats in all directions, from the source's own point field: the file's steps.
TEST_P(Cases, SamplesAreTheFieldUnderTheSameKernel) {
  const Remapped r(synthetic_forecast(GetParam()), {}, 0, 0, forecast::Layers::kConstant);
  const auto source = made_source(r.forecast);
  const double a = r.chart().body().equatorial_m;
  const Index3& n = r.cells();
  std::vector<Column> list = r.columns_with_cloud();
  std::mt19937 random(11);
  std::ranges::shuffle(list, random);
  double gap = 0, square = 0;
  std::size_t compared = 0;
  for (std::size_t at = 0; at < list.size() && compared < 20; ++at) {
    const auto k = std::uint32_t(1 + random() % (n[2] - 1));
    const double own = r.sample(list[at], k);
    if (own == 0 && compared % 8) continue;
    ++compared;
    double sum = 0, total = 0;
    constexpr int kAcross = 8, kUp = 24;
    for (const Column& name : r.chart().names(list[at], n))
      for (int c = -kUp; c < kUp; ++c)
        for (int b = -kAcross; b < kAcross; ++b)
          for (int d = -kAcross; d < kAcross; ++d) {
            const double u = (d + 0.5) / kAcross, v = (b + 0.5) / kAcross, w = (c + 0.5) / kUp;
            const glm::dvec3 q = {(name.i + u) / n[0], (name.j + v) / n[1], (k + w) / n[2]};
            if (q.x < 0 || q.x > 1 || q.y < 0 || q.y > 1) continue;
            const double x = std::tan(std::numbers::pi / 4 * (2 * q.x - 1)),
                         y = std::tan(std::numbers::pi / 4 * (2 * q.y - 1)),
                         up = a + r.chart().bottom_m() + q.z * r.chart().thickness_m();
            const double weight = (1 - std::abs(u)) * (1 - std::abs(v)) * (1 - std::abs(w)) * up *
                                  up * (1 + x * x) * (1 + y * y) / std::pow(1 + x * x + y * y, 1.5);
            double beta = 0;
            ASSERT_EQ(source->point_extinction_per_m(r.chart().ecef_m({name.root, q}), 0, beta),
                      Status::kOk);
            sum += weight * beta;
            total += weight;
          }
    const double truth = sum / total;
    gap += (own - truth) * (own - truth);
    square += truth * truth;
  }
  const double rms = std::sqrt(gap / square);
  report_accuracy("netcdf", "samples against the field under the same hats, rms", rms, 2e-2, "1");
  EXPECT_GE(compared, 15u);
  EXPECT_LE(rms, 2e-2);
}

INSTANTIATE_TEST_SUITE_P(Synthetic, Cases,
                         testing::Values("mercator", "globe", "rotated", "corner", "fog", "layer"),
                         [](const auto& name) { return std::string(name.param); });

// A field of one value is one value, over edges, corners and poles of the globe.
TEST(Remap, UniformFieldIsUniform) {
  for (const char* name : {"globe", "rotated", "corner"}) {
    auto forecast = synthetic_forecast(name);
    forecast->ice_per_m = nullptr;
    forecast->level_m = [](double t) { return 8000 * t; };
    forecast->extinction_per_m = [](glm::dvec2, double, double) { return 5e-3; };
    const Remapped r(forecast);
    const GridSearch search(forecast->cells);
    const auto k = std::uint32_t((4000 - r.chart().bottom_m()) / r.layout.voxel_height_m);
    double worst = 0;
    std::size_t inside = 0;
    for (const Column& column : r.columns_with_cloud()) {
      // Samples whose whole hat is inside the domain.
      bool whole = true;
      for (int corner = 0; corner < 9 && whole; ++corner) {
        const glm::dvec3 q = {(column.i + 1.05 * (corner % 3 - 1)) / r.cells()[0],
                              (column.j + 1.05 * (corner / 3 - 1)) / r.cells()[1], 0.3};
        const GeodeticPoint p =
            geodetic_point(r.chart().body(), r.chart().ecef_m({column.root, q}));
        whole = search.find({p.latitude_deg, p.longitude_deg}).off_cells == 0;
      }
      if (!whole) continue;
      ++inside;
      worst = std::max(worst, std::abs(r.sample(column, k) / 5e-3 - 1));
    }
    report_accuracy("netcdf", "a uniform field's samples off it", worst, 1e-3, "1");
    EXPECT_GT(inside, 1000u) << name;
    EXPECT_LE(worst, 1e-3) << name;
  }
}

// Turning the field by 180 degrees turns the samples: faces +x and -x change places, and +y and -y;
// on the two at the poles rows and columns run the other way.
TEST(Remap, TurnedFieldGivesTurnedSamples) {
  const Remapped here(synthetic_forecast("globe")), there(synthetic_forecast("globe_mirror"));
  ASSERT_EQ(here.cells(), there.cells());
  const std::uint32_t n = here.cells()[0];
  double worst = 0, most = 0;
  std::size_t compared = 0;
  std::mt19937 random(3);
  for (const Column& column : here.columns_with_cloud()) {
    const Column turned = column.root < 4 ? Column{column.root ^ 1, column.i, column.j}
                                          : Column{column.root, n - column.i, n - column.j};
    const auto k = std::uint32_t(random() % here.cells()[2]);
    const double a = here.sample(column, k), b = there.sample(turned, k);
    worst = std::max(worst, std::abs(a - b));
    most = std::max(most, a);
    compared += a > 0;
  }
  report_accuracy("netcdf", "field turned by 180 deg: samples off, of the largest", worst / most,
                  1e-5, "1");
  EXPECT_GT(compared, 1000u);
  EXPECT_LE(worst, 1e-5 * most);
}

// The slope of a smooth field per metre, across a cube's edge and elsewhere.
TEST(Remap, NoSeamAtEdgesOfTheCube) {
  auto forecast = synthetic_forecast("globe");
  forecast->ice_per_m = nullptr;
  // Smooth as a model's cells allow; the date line and the poles are inside faces.
  forecast->extinction_per_m = [](glm::dvec2 p, double, double) {
    const glm::dvec3 u = forecast::unit_vector(p);
    return 1e-3 * (2 + u.x + 0.7 * u.y - 0.5 * u.z + u.x * u.y);
  };
  const Remapped r(forecast);
  const auto k = std::uint32_t((3000 - r.chart().bottom_m()) / r.layout.voxel_height_m);
  const std::uint32_t n = r.cells()[0];
  const auto slope = [&](Column a, Column b) {
    const double q = double(k) / r.cells()[2];
    const glm::dvec3 at = r.chart().ecef_m({a.root, {double(a.i) / n, double(a.j) / n, q}});
    const glm::dvec3 to = r.chart().ecef_m({b.root, {double(b.i) / n, double(b.j) / n, q}});
    return std::abs(r.sample(a, k) - r.sample(b, k)) / glm::length(at - to);
  };
  double inside = 0, edge = 0;
  for (int root = 0; root < 6; ++root)
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i < n; ++i)
        for (const bool turn : {false, true}) {
          const Column a = turn ? Column{root, j, i} : Column{root, i, j};
          const Column b = turn ? Column{root, j, i + 1} : Column{root, i + 1, j};
          const bool touches = a.i == 0 || a.j == 0 || b.i == n || b.j == n;
          double& most = touches ? edge : inside;
          most = std::max(most, slope(a, b));
        }
  report_accuracy("netcdf", "largest slope at the cube's edges over that inside", edge / inside,
                  1.0, "1");
  EXPECT_GT(inside, 0);
  EXPECT_LE(edge, inside);
}

// One cloudy column of the model: the middle of what becomes of it.
TEST(Remap, OneColumnStaysInItsPlace) {
  for (const char* name : {"mercator", "rotated", "corner", "globe"}) {
    auto forecast = synthetic_forecast(name);
    forecast->ice_per_m = nullptr;
    const int i = forecast->cells->nx() / 3,
              j = name == std::string("globe") ? 1 : forecast->cells->ny() / 2;
    const glm::dvec2 place = forecast->middle(i, j);
    forecast->extinction_per_m = [=](glm::dvec2 p, double z, double) {
      return glm::length(p - place) < 1e-9 && z > 2000 && z < 4000 ? 0.01 : 0.0;
    };
    const Remapped r(forecast);
    glm::dvec3 middle(0.0);
    double sum = 0;
    BrickSamples samples;
    for (const NodeKey key : r.remap->nodes(Part::kTotal)) {
      const HatWeights hats = owned_hats(r.chart(), r.layout.lattice, key);
      r.remap->samples(key, Part::kTotal, samples.data());
      for (std::uint32_t at = 0; at < kBrickVolume; ++at) {
        const double weight = samples[at] * hats.horizontal[at % 81] * hats.vertical[at / 81];
        if (!(weight > 0)) continue;
        middle +=
            weight * sample_ecef_m(r.chart(), r.layout.lattice, key.root(), r.level(),
                                   Lattice::global_sample(key, {at % 9, at / 9 % 9, at / 81}));
        sum += weight;
      }
    }
    ASSERT_GT(sum, 0) << name;
    const GeodeticPoint found = geodetic_point(r.chart().body(), middle / sum);
    const GridSearch search(forecast->cells);
    const glm::dvec2 at = search.find({found.latitude_deg, found.longitude_deg}).at;
    const double off = glm::length(at - glm::dvec2(i + 0.5, j + 0.5));
    report_accuracy("netcdf", "one cloudy column: its middle off the cell's", off, 0.5, "cells");
    EXPECT_LE(off, 0.5) << name;
  }
}

// One cell, one row, one layer; and cells far wider than any corner rule's reach.
TEST(Remap, SmallestAndWidestGrids) {
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(40, 1), glm::ivec2(1, 30)})
    for (const double cell_deg : {0.02, 1.0, 9.0}) {
      if (cell_deg * std::max(size.x, size.y) > 60) continue;
      auto forecast = synthetic_forecast("layer");
      forecast->cells =
          std::make_shared<RotatedGrid>(size.x, size.y, glm::dvec2(-20, 44), 30, cell_deg);
      forecast->nz = 1;
      forecast->level_m = [](double t) { return 800 * t; };
      forecast->extinction_per_m = [](glm::dvec2, double, double) { return 2e-3; };
      const Remapped r(forecast);
      EXPECT_NEAR(r.total() / file_total(r), 1, 2e-3) << size.x << ' ' << size.y << ' ' << cell_deg;
      EXPECT_TRUE(made_source(forecast)->info().surface);
    }
}

TEST(Remap, ClearBelowLosesNoLightThatMatters) {
  auto forecast = synthetic_forecast("mercator");
  const auto cloud = forecast->extinction_per_m;
  forecast->extinction_per_m = [=](glm::dvec2 p, double z, double t) {
    return std::max(cloud(p, z, t), 0.9e-9);
  };
  const Remapped all(forecast), cut(forecast, {}, 1e-9);
  const double lost = 1 - cut.total() / all.total();
  report_accuracy("netcdf", "clear below 1e-9 1/m: optical depth left out", lost, 1e-5, "1");
  EXPECT_GT(lost, 0);
  EXPECT_LE(lost, 1e-5);
  EXPECT_LT(cut.remap->bytes(), all.remap->bytes());
}

TEST(Remap, ResolutionFollowsTheModelAndTheUser) {
  const auto forecast = synthetic_forecast("mercator");
  const forecast::Layout own = choose_layout(*forecast, {});
  EXPECT_LE(own.voxel_width_m, 1.415 * forecast::cell_width_m(*forecast->cells));
  EXPECT_GE(own.voxel_width_m, forecast::cell_width_m(*forecast->cells) / 1.415);
  EXPECT_GE(own.voxel_height_m, 50);
  const forecast::Layout asked = choose_layout(*forecast, {2000.0, 30.0});
  EXPECT_LE(asked.voxel_width_m, 2000);
  EXPECT_LE(asked.voxel_height_m, 30);
  const glm::dvec2 range_m = forecast->height_range_m();
  EXPECT_LT(own.chart->bottom_m(), range_m.x - own.extend_below_m);
  EXPECT_GT(own.chart->bottom_m() + own.chart->thickness_m(), range_m.y);
  EXPECT_THROW(choose_layout(*forecast, {0.5, {}}), Error);
  EXPECT_THROW(choose_layout(*forecast, {{}, 0.01}), Error);
}

}  // namespace
}  // namespace nepho::test
