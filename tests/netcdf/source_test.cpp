// A forecast as a source: channels, times, threads, ground, and what it says of itself.

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <thread>

#include "accuracy_report.h"
#include "forecast/bricks/grid_search.h"
#include "geo/place.h"
#include "made_source.h"

namespace nepho::test {
namespace {

std::uint64_t hash_of(const BrickSource& source, NodeKey key, double time_s, Channel channel) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const double c : read_samples(source, key, time_s, channel))
    hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * 0x100000001b3u;
  return hash;
}

TEST(NetcdfSource, ServesTotalAndIce) {
  const auto source = made_source(synthetic_forecast("corner"));
  ASSERT_EQ(source->info().channels.size(), 2u);
  EXPECT_EQ(source->info().channels[1].channel, Channel::kIceExtinction);
  std::size_t more = 0, ice_somewhere = 0, liquid_somewhere = 0, lies = 0;
  for (const NodeKey key : finest_nodes(*source)) {
    std::array<std::array<std::uint16_t, kBrickVolume>, 2> codes;
    std::array<ChannelView, 2> views;  // in one read, the ice first
    views[0] = {Channel::kIceExtinction, codes[0].data()};
    views[1] = {Channel::kExtinction, codes[1].data()};
    ASSERT_EQ(source->read(key, 0, views), Status::kOk);
    bool any_ice = false;
    for (std::size_t at = 0; at < kBrickVolume; ++at) {
      const double ice = double(decode(codes[0][at], views[0].scale, views[0].offset));
      const double all = double(decode(codes[1][at], views[1].scale, views[1].offset));
      more += ice > all + views[0].max_abs_error + views[1].max_abs_error;
      ice_somewhere += ice > 0;
      liquid_somewhere += all > ice * 1.01;
      any_ice |= ice > 0;
    }
    NodeSummary summary;
    source->summary(key, 0, summary);
    lies += (summary.empty || summary.constant) && any_ice;
  }
  EXPECT_EQ(more, 0u);
  EXPECT_EQ(lies, 0u);
  EXPECT_GT(ice_somewhere, 1000u);
  EXPECT_GT(liquid_somewhere, 1000u);
}

TEST(NetcdfSource, WaterOnlyHasOneChannel) {
  const auto source = made_source(synthetic_forecast("fog"));
  EXPECT_EQ(source->info().channels.size(), 1u);
  EXPECT_THROW(read_samples(*source, NodeKey(0, 0, 0, 0, 0), 0, Channel::kIceExtinction),
               std::runtime_error);
}

// One value in both parts, from the ground to the top: not constant, as its ice is not known
// without a brick.
TEST(NetcdfSource, ConstantHoldsForAllChannels) {
  auto forecast = synthetic_forecast("globe");
  forecast->extinction_per_m = [](glm::dvec2, double, double) { return 1e-3; };
  forecast->ice_per_m = [](glm::dvec2, double, double) { return 5e-4; };
  const auto icy = made_source(forecast);
  forecast->ice_per_m = [](glm::dvec2, double, double) { return 0.0; };
  const auto watery = made_source(forecast);
  NodeSummary summary;
  for (const NodeKey key : finest_nodes(*icy)) {
    icy->summary(key, 0, summary);
    EXPECT_FALSE(summary.constant && summary.max_extinction_per_m > 0);
  }
  EXPECT_EQ(read_samples(*watery, NodeKey(0, 0, 0, 0, 0), 0, Channel::kIceExtinction),
            BrickSamples{});
}

TEST(NetcdfSource, TimesAreBuiltWhenAskedFor) {
  auto forecast = synthetic_forecast("mercator");
  forecast->times = {0, 3600, 7200, 10800};
  const auto source = made_source(forecast);
  const std::vector<NodeKey> nodes = finest_nodes(*source);
  ASSERT_FALSE(nodes.empty());
  const NodeKey key = nodes[nodes.size() / 2];
  std::set<std::uint64_t> hashes;
  for (const double time_s : forecast->times)
    hashes.insert(hash_of(*source, key, time_s, Channel::kExtinction));
  EXPECT_EQ(hashes.size(), 4u);
  // The first again, after it was dropped.
  EXPECT_TRUE(hashes.contains(hash_of(*source, key, 0, Channel::kExtinction)));
  NodeSummary summary;
  EXPECT_EQ(source->summary(key, 1800, summary), Status::kNoSuchTime);
}

// Two sources, four threads, both channels and more times than are kept: the bits of one thread.
TEST(NetcdfSource, FourThreadsReadTheBitsOfOne) {
  auto moving = synthetic_forecast("mercator");
  moving->times = {0, 3600, 7200};
  const std::vector<std::shared_ptr<SyntheticForecast>> forecasts = {moving,
                                                                     synthetic_forecast("corner")};
  struct Work {
    std::size_t source;
    NodeKey key;
    double time_s;
    Channel channel;
  };
  std::vector<Work> work;
  std::vector<std::uint64_t> alone;
  for (std::size_t s = 0; s < forecasts.size(); ++s) {
    const auto source = made_source(forecasts[s]);
    for (const double time_s : forecasts[s]->times)
      for (const NodeKey key : finest_nodes(*source, time_s))
        for (const ChannelInfo& channel : source->info().channels) {
          if (key.k() % 3) continue;
          work.push_back({s, key, time_s, channel.channel});
          alone.push_back(hash_of(*source, key, time_s, channel.channel));
        }
  }
  std::vector<std::unique_ptr<BrickSource>> sources;
  for (const auto& forecast : forecasts) sources.push_back(made_source(forecast));
  std::vector<std::uint64_t> hashes(work.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t at = t; at < work.size(); at += 4)
        hashes[at] =
            hash_of(*sources[work[at].source], work[at].key, work[at].time_s, work[at].channel);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(work.size(), 200u);
  EXPECT_EQ(hashes, alone);
}

TEST(NetcdfSource, ClearForecastIsEmpty) {
  auto forecast = synthetic_forecast("mercator");
  forecast->extinction_per_m = [](glm::dvec2, double, double) { return 0.0; };
  const auto source = made_source(forecast);
  NodeSummary summary;
  for (int root = 0; root < 6; ++root) {
    ASSERT_EQ(source->summary(NodeKey(root, 0, 0, 0, 0), 0, summary), Status::kOk);
    EXPECT_TRUE(summary.empty && summary.constant && summary.children == 0);
  }
}

TEST(NetcdfSource, RefusesUnknownParameters) {
  const auto forecast = synthetic_forecast("fog");
  const auto refused = [&](RequestParameter parameter) {
    EXPECT_THROW(made_source(forecast, {parameter}), Error) << parameter.name;
  };
  refused({"vertical_resolutoin", nullptr, 100, "m"});
  refused({"vertical_resolution_m", nullptr, -5, "m"});
  refused({"horizontal_resolution_m", nullptr, 0, "m"});
  refused({"clear_below_per_m", nullptr, 1, "m-1"});
  refused({"vertical_resolution", nullptr, 100, "m"});  // the host's names end in their SI unit
}

TEST(NetcdfSource, ObeysItsResolutions) {
  const auto forecast = synthetic_forecast("mercator");
  const auto source = made_source(forecast, {{"vertical_resolution_m", nullptr, 120, "m"},
                                             {"horizontal_resolution_m", nullptr, 4000, "m"},
                                             {"clear_below_per_m", nullptr, 1e-5, "m-1"}});
  const VolumeInfo& info = source->info();
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  const auto& shell = dynamic_cast<const ShellChart&>(*info.chart);
  EXPECT_LE(shell.thickness_m() / cells[2], 120);
  EXPECT_GT(shell.thickness_m() / cells[2], 60 * 0.99);
  EXPECT_EQ(cells[0], 4096u);  // 10 019 km of 4 km at most: 2.4 km
}

// The file's own piecewise constant field at random places of random cells.
TEST(NetcdfSource, PointsAreTheFilesOwnCells) {
  for (const char* name : {"mercator", "globe", "rotated", "corner"}) {
    const auto forecast = synthetic_forecast(name);
    const auto source = made_source(forecast);
    const auto columns = forecast->columns(0);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> within(0.02, 0.98);
    std::size_t wrong = 0, cloudy = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      const int i = int(random() % unsigned(columns.nx)), j = int(random() % unsigned(columns.ny)),
                k = int(random() % unsigned(columns.nz));
      // The outer half of a row at a pole lies beyond it.
      const double y = std::string(name) == "globe" && j == 0 ? within(random) / 2 + 0.5
                       : std::string(name) == "globe" && j == columns.ny - 1 ? within(random) / 2
                                                                             : within(random);
      const glm::dvec2 place = forecast->cells->lat_lon_deg(i + within(random), j + y);
      const auto cell = std::size_t(j) * std::size_t(columns.nx) + std::size_t(i);
      const float* h = &columns.interface_m[cell * std::size_t(columns.nz + 1) + std::size_t(k)];
      const glm::dvec3 p =
          ecef_m(Ellipsoid::wgs84(), {place.x, std::remainder(place.y, 360.0),
                                      double(h[0]) + within(random) * double(h[1] - h[0])});
      double beta = -1;
      ASSERT_EQ(source->point_extinction_per_m(p, 0, beta), Status::kOk);
      const double truth =
          double(columns.extinction_per_m[cell * std::size_t(columns.nz) + std::size_t(k)]);
      wrong += beta != truth;
      cloudy += truth > 0;
    }
    EXPECT_EQ(wrong, 0u) << name;
    EXPECT_GT(cloudy, 50u) << name;
  }
}

double map_at(const SurfaceMap& map, const std::vector<float>& values, glm::dvec3 u) {
  glm::dvec2 at = {std::atan2(glm::dot(u, map.axes[1]), glm::dot(u, map.axes[0])),
                   std::asin(glm::dot(u, map.axes[2]))};
  at = (at - map.low_rad) / map.step_rad;
  const int x = int(std::floor(at.x)), y = std::clamp(int(std::floor(at.y)), 0, map.ny - 2);
  double sum = 0;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const int i = map.around ? (x + a + map.nx) % map.nx : std::clamp(x + a, 0, map.nx - 1);
      sum += (a ? at.x - x : 1 - at.x + x) * (b ? at.y - y : 1 - at.y + y) *
             double(values[std::size_t(y + b) * std::size_t(map.nx) + std::size_t(i)]);
    }
  return sum;
}

// A ground that is smooth over a few cells, found again under random places.
TEST(NetcdfSource, GroundLiesWhereTheFileHasIt) {
  for (const char* name : {"mercator", "globe", "rotated"}) {
    auto forecast = synthetic_forecast(name);
    const bool globe = std::string(name) == "globe";
    const double waves = globe ? 2 : 25;
    forecast->ground_m = [=](glm::dvec2 p) {
      const glm::dvec3 u = forecast::unit_vector(p);
      return 1000 + 600 * std::sin(waves * u.x + 1) * std::cos(waves * u.y) + 300 * u.z;
    };
    const auto source = made_source(forecast);
    const auto map = source->info().surface;
    ASSERT_TRUE(map);
    EXPECT_EQ(map->around, globe);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> within(0.03, 0.97);
    double worst_m = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const glm::dvec2 place = forecast->cells->lat_lon_deg(within(random) * forecast->cells->nx(),
                                                            within(random) * forecast->cells->ny());
      const glm::dvec3 p = ecef_m(Ellipsoid::wgs84(), {place.x, std::remainder(place.y, 360.0), 0});
      const glm::dvec3 u =
          glm::normalize(static_cast<const ShellChart&>(*source->info().chart).to_scaled(p));
      worst_m =
          std::max(worst_m, std::abs(map_at(*map, map->height_m, u) - forecast->ground_m(place)));
    }
    report_accuracy("netcdf", "ground of the surface map off a smooth ground of 1200 m", worst_m,
                    12, "m");
    EXPECT_LE(worst_m, 12) << name;
  }
}

// A nest that moves: clouds and ground are where it is at each time.
TEST(NetcdfSource, MovingNestLeavesOneGround) {
  auto forecast = synthetic_forecast("mercator");
  forecast->times = {0, 3600};
  for (const double lon_deg : {-88.0, -80.0})
    forecast->moving.push_back(
        std::make_shared<MercatorGrid>(48, 48, glm::dvec2(24, lon_deg), 0.09));
  forecast->ground_m = [](glm::dvec2 p) { return 100 + 10 * (p.y + 90); };
  forecast->extinction_per_m = [](glm::dvec2, double z, double) { return z > 3000 ? 1e-3 : 0.0; };
  const auto source = made_source(forecast);
  const auto& chart = static_cast<const ShellChart&>(*source->info().chart);
  for (std::size_t time = 0; time < 2; ++time)
    for (std::size_t place = 0; place < 2; ++place) {
      const glm::dvec2 deg = forecast->middle(24, 24, place);
      const glm::dvec3 p = ecef_m(Ellipsoid::wgs84(), {deg.x, deg.y, 5000});
      double beta = -1;
      source->point_extinction_per_m(p, forecast->times[time], beta);
      EXPECT_NEAR(beta, time == place ? 1e-3 : 0, 1e-9);
      const SurfaceMap& map = *source->info().surface;
      const glm::dvec3 u = glm::normalize(chart.to_scaled(p));
      EXPECT_NEAR(map_at(map, map.height_m, u), forecast->ground_m(deg), 1);
    }
}

TEST(NetcdfSource, SaysWhatItIs) {
  auto forecast = synthetic_forecast("mercator");
  forecast->extinction_per_m = [](glm::dvec2, double z, double) { return z > 8000 ? 0.01 : 0.0; };
  const auto source = made_source(forecast);
  const VolumeInfo& info = source->info();
  EXPECT_TRUE(info.on_planet);
  EXPECT_EQ(info.finest, SampleKind::kHat);
  EXPECT_EQ(info.chart->kind(), ChartKind::kShell);
  EXPECT_DOUBLE_EQ(info.phase.effective_radius_m, 10e-6);
  EXPECT_GT(info.source_bytes, 10000u);
  EXPECT_GT(info.channels[0].max_abs_error, 0);
  const auto says = [](const std::vector<std::string>& all, const char* what) {
    return std::ranges::any_of(
        all, [&](const auto& text) { return text.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says(info.assumptions, "synthetic"));
  DataFacts facts;
  ASSERT_EQ(source->data_facts(0, facts), Status::kOk);
  EXPECT_NEAR(facts.data_top_m, 9000, 1);
  EXPECT_EQ(facts.cut_share, 1);
}

}  // namespace
}  // namespace nepho::test
