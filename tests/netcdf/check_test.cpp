// What `info` tells of forecasts and how it checks their bricks, on forecasts in closed form.

#include <gtest/gtest.h>

#include "accuracy_report.h"
#include "common/brick_check.h"
#include "common/brick_columns.h"
#include "dressed_source.h"
#include "forecast/bricks/column_facts.h"
#include "made_source.h"

namespace nepho::test {
namespace {

using Columns = forecast::ForecastColumns;

TEST(Check, BricksOfForecastsKeepTheirPromise) {
  for (const char* name : {"mercator", "globe"}) {
    const auto source = made_source(synthetic_forecast(name));
    const BrickCheck check = check_bricks(*source, 0);
    EXPECT_TRUE(check.kept()) << name << " " << check.total_difference << " " << check.column_rms;
    EXPECT_GT(check.columns, 40) << name;
    EXPECT_EQ(check.total_doubt, 0) << name;
    report_accuracy("netcdf", "info --check: total optical depth", std::abs(check.total_difference),
                    BrickCheck::kTotal, "1");
    report_accuracy("netcdf", "info --check: sampled columns, rms", check.column_rms,
                    BrickCheck::kColumns, "1");
  }
}

// A source whose bricks hold this many times what its data hold.
class Scaled final : public BrickSource {
 public:
  Scaled(const BrickSource& plain, float factor) : plain_(plain), factor_(factor) {}
  const VolumeInfo& info() const noexcept override { return plain_.info(); }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return plain_.summary(key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    const Status status = plain_.read(key, time_s, brick);
    for (ChannelView& view : brick) view.scale *= factor_, view.offset *= factor_;
    return status;
  }
  Status data_facts(double time_s, DataFacts& facts) const noexcept override {
    return plain_.data_facts(time_s, facts);
  }
  Status own_column(const glm::dvec3& at, double time_s,
                    OwnColumn& column) const noexcept override {
    return plain_.own_column(at, time_s, column);
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return plain_.last_error(buffer, size);
  }

 private:
  const BrickSource& plain_;
  float factor_;
};

// 1 % too much is seen in both, 0.1 % in neither.
TEST(Check, SeesOnePercent) {
  const auto source = made_source(synthetic_forecast("globe"));
  const BrickCheck one = check_bricks(Scaled(*source, 1.01f), 0);
  EXPECT_NEAR(one.total_difference, 0.01, 1e-3);
  EXPECT_NEAR(one.column_rms, 0.01, 2e-3);
  EXPECT_FALSE(one.total_kept());
  EXPECT_FALSE(one.columns_kept());
  EXPECT_TRUE(check_bricks(Scaled(*source, 1.001f), 0).kept());
}

// Without facts of its own the total is that of sampled columns, with a doubt.
TEST(Check, SamplesTheTotalOfOthers) {
  const auto plain = made_source(synthetic_forecast("globe"));
  class NoFacts final : public BrickSource {
   public:
    explicit NoFacts(const BrickSource& plain) : plain_(plain) {}
    const VolumeInfo& info() const noexcept override { return plain_.info(); }
    Status summary(NodeKey key, double time_s, NodeSummary& s) const noexcept override {
      return plain_.summary(key, time_s, s);
    }
    Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
      return plain_.read(key, time_s, brick);
    }
    Status own_column(const glm::dvec3& at, double time_s, OwnColumn& c) const noexcept override {
      const Status status = plain_.own_column(at, time_s, c);
      c.optical_depth *= 0.9;
      return status;
    }
    std::size_t last_error(char* b, std::size_t n) const noexcept override {
      return plain_.last_error(b, n);
    }

   private:
    const BrickSource& plain_;
  };
  const BrickCheck check = check_bricks(NoFacts(*plain), 0);
  EXPECT_GT(check.total_doubt, 0);
  EXPECT_NEAR(check.total_difference, 1 / 0.9 - 1, 5e-3);
  EXPECT_FALSE(check.total_kept());
}

// Area of an ellipsoid's zone: Snyder (1987), equation 3-12, without its flattening's series.
double zone_m2(double from_deg, double to_deg) {
  const Ellipsoid body = Ellipsoid::wgs84();
  const double a = body.equatorial_m, b = body.polar_m, e = std::sqrt(1 - b * b / (a * a));
  const auto below = [&](double deg) {
    const double s = std::sin(deg * kDegree);
    return b * b / 2 * (s / (1 - e * e * s * s) + std::atanh(e * s) / e);
  };
  return below(to_deg) - below(from_deg);
}

TEST(Facts, CellsHaveTheirAreas) {
  const LatLonGrid grid(36, 18, 0, 10, 90, -10);
  const std::vector<double> areas = forecast::cell_areas_m2(grid);
  double total = 0;
  for (int j = 0; j < 18; ++j) {
    const double wanted = zone_m2(80 - 10 * j, 90 - 10 * j) * 10 * kDegree;
    EXPECT_NEAR(areas[std::size_t(j) * 36] / wanted, 1, 2e-3) << j;
    total += areas[std::size_t(j) * 36] * 36;
  }
  report_accuracy("netcdf", "areas of cells of 10 degrees, in all",
                  std::abs(total / (2 * std::numbers::pi * zone_m2(-90, 90)) - 1), 2e-3, "1");
  EXPECT_NEAR(total / (2 * std::numbers::pi * zone_m2(-90, 90)), 1, 2e-3);
}

// Two cells of known water: one with cloud up to the top of the data, one nearly clear.
TEST(Facts, ColumnsAreAddedUp) {
  const LatLonGrid grid(2, 1, 0, 1, 0, 1);
  Columns c;
  c.nx = 2, c.ny = 1, c.nz = 3;
  c.interface_m = {0, 100, 300, 600, 50, 150, 350, 650};
  c.extinction_per_m = {0, 0.01f, 0.02f, 0, 1e-4f, 0};
  c.liquid_kg_per_m2 = {0.3f, 0.1f};
  c.ice_kg_per_m2 = {0, 0};
  c.precipitation_kg_per_m2 = {0, 1};
  c.variables = {{.name = "clw", .meaning = "cloud water", .unit = "kg kg-1", .values = 6}};
  const DataFacts facts = forecast::column_facts(c, grid, 20);
  EXPECT_EQ(facts.columns, 2u);
  EXPECT_NEAR(facts.optical_depth.max, 8, 1e-6);  // 200 m x 0.01 + 300 m x 0.02
  EXPECT_NEAR(facts.optical_depth.mean, (8 + 0.02) / 2, 1e-5);
  EXPECT_NEAR(facts.cover, 0.5, 1e-9);
  EXPECT_NEAR(facts.liquid_kg_per_m2.mean, 0.2, 1e-6);
  EXPECT_NEAR(facts.liquid_kg_per_m2.max, 0.3, 1e-6);
  EXPECT_NEAR(facts.precipitation_kg_per_m2.mean, 0.5, 1e-6);
  EXPECT_EQ(facts.lowest_base_m, 100);
  EXPECT_EQ(facts.highest_top_m, 600);
  EXPECT_NEAR(facts.mean_base_m, 100, 1e-9);
  EXPECT_EQ(facts.data_bottom_m, 0);
  EXPECT_EQ(facts.data_top_m, 650);
  EXPECT_EQ(facts.cut_share, 1);
  const double area_m2 = zone_m2(0, 1) * kDegree;
  EXPECT_NEAR(facts.area_m2 / (2 * area_m2), 1, 1e-4);
  EXPECT_NEAR(facts.extinction_m2 / (8.02 * area_m2), 1, 3e-4);
  EXPECT_EQ(facts.variables.front().name, "clw");
}

// Bricks tell what the data tell, where these do not: an even layer from 1 to 3 km.
TEST(Facts, BricksAgreeWithTheData) {
  const auto source = made_source(synthetic_forecast("globe"));
  DataFacts data;
  ASSERT_EQ(source->data_facts(0, data), Status::kOk);
  const DataFacts bricks = brick_facts(*source, 0);
  EXPECT_NEAR(bricks.cover, data.cover, 0.1);
  EXPECT_NEAR(bricks.optical_depth.max / data.optical_depth.max, 1, 0.1);
  EXPECT_NEAR(bricks.lowest_base_m, data.lowest_base_m, 1000);
  EXPECT_NEAR(bricks.highest_top_m, data.highest_top_m, 1000);
  EXPECT_NEAR(total_extinction_m2(*source, 0, 1) / total_extinction_m2(*source, 0, 100000), 1,
              1e-3);
}

}  // namespace
}  // namespace nepho::test
